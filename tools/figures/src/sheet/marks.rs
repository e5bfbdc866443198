//! The marks of a brush: the strokes that a painter tries in the shop.

use maulstick_brush::BrushFile;

use super::gesture::{Gesture, Moment, along, ease, swell};

/// A mark and the mixture that the brush takes up for it; `None` continues with its load.
pub(crate) struct Mark {
    /// The gesture.
    pub(crate) gesture: Gesture,
    /// The mixture.
    pub(crate) load: Option<&'static str>,
}

/// Size of the panel of a brush's marks, mm.
pub(crate) const PANEL_MM: [f64; 2] = [super::MARKS_MM, 52.0];

/// A stroke along points, with the brush's broad side across the path; `edge` turns it on its edge.
pub(crate) fn stroke(
    points: Vec<[f64; 2]>,
    seconds: f64,
    twist_deg: f64,
    pressure: impl Fn(f64) -> f64 + 'static,
) -> Gesture {
    let lean = {
        let (from, to) = (points[0], points[points.len() - 1]);
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = (way[0] * way[0] + way[1] * way[1]).sqrt().max(1e-9);
        way.map(|v| 25.0 * v / length)
    };
    Gesture {
        seconds,
        hand: Box::new(move |t| Moment {
            at: along(&points, ease(t)),
            pressure: pressure(t),
            tilt_deg: lean,
            twist_deg,
        }),
    }
}

/// Marks of a brush on a panel: from a touch to full pressure; a wave; on its edge, twice; three dabs; lightly until it
/// is dry.
pub(crate) fn marks(file: &BrushFile) -> Vec<Mark> {
    let width_mm = file.head.width_mm;
    let [left, right] = [-1.0, 1.0].map(|place| file.length_share([place, 0.0]));
    // The long side of a slanted brush trails, held nearly upright.
    let (tilt, twist_deg) = if right > left {
        (6.0, 180.0)
    } else {
        (25.0, 0.0)
    };
    let middle = 0.5 * PANEL_MM[1];
    let blue = Some("Ultramarine Blue=0.75,Titanium White=0.25");
    let red = Some("Quinacridone Red=0.8,Titanium White=0.2");
    let ochre = Some("Yellow Ochre");
    let green = Some("Phthalo Green Blue Shade=0.35,Hansa Yellow Opaque=0.65");
    let mut marks = vec![Mark {
        load: blue,
        gesture: stroke(
            vec![[10.0, middle - 3.0], [34.0, middle + 3.0], [60.0, middle]],
            1.6,
            90.0,
            |t| 0.02 + 0.9 * ease(t) * ease((1.0 - t) / 0.04),
        ),
    }];
    let swing = if width_mm > 20.0 { 6.0 } else { 9.0 };
    let wave = |i: i32| {
        let t = f64::from(i) / 16.0;
        let turn = maulstick_num::sin(2.0 * std::f64::consts::PI * 2.0 * t);
        [88.0 + 40.0 * t, middle + swing * turn]
    };
    marks.push(Mark {
        load: red,
        gesture: stroke((0..=16).map(wave).collect(), 2.2, 60.0, |t| {
            0.08 + 0.36 * swell(t, 0.15)
        }),
    });
    let edge = [150.0 + 0.5 * width_mm, 194.0 - 0.5 * width_mm];
    for (row, pressure) in [0.1, 0.24].into_iter().enumerate() {
        let y = middle + 9.0 - 18.0 * row as f64;
        marks.push(Mark {
            load: (row == 0).then_some("Bone Black"),
            gesture: Gesture {
                seconds: 1.0,
                hand: Box::new(move |t| Moment {
                    at: [edge[0] + (edge[1] - edge[0]) * ease(t), y],
                    pressure: 0.02 + pressure * swell(t, 0.2),
                    tilt_deg: [tilt, 0.0],
                    twist_deg,
                }),
            },
        });
    }
    let wide = width_mm > 12.0;
    let (apart, dabs) = if wide { (width_mm, 1) } else { (10.0, 3) };
    for dab in 0..dabs {
        let at = [
            if wide { 222.0 } else { 211.0 } + apart * f64::from(dab),
            middle,
        ];
        let pressure = 0.35 + 0.2 * f64::from(dab);
        marks.push(Mark {
            load: (dab == 0).then_some(()).and(ochre),
            gesture: Gesture {
                seconds: 0.5,
                hand: Box::new(move |t| Moment {
                    at: [at[0] + 2.0 * t, at[1] + 4.0 - 8.0 * ease(t)],
                    pressure: 0.02 + pressure * swell(t, 0.4),
                    tilt_deg: [8.0, -20.0],
                    twist_deg: 0.0,
                }),
            },
        });
    }
    for row in 0..if wide { 1 } else { 2 } {
        let y = middle
            + if wide {
                0.0
            } else {
                10.0 - 20.0 * f64::from(row)
            };
        marks.push(Mark {
            load: (row == 0).then_some(()).and(green),
            gesture: stroke(
                vec![[250.0, y], [265.0, y + 2.0], [278.0, y]],
                1.0,
                90.0,
                move |t| 0.02 + (0.28 - 0.14 * f64::from(row)) * swell(t, 0.12),
            ),
        });
    }
    marks
}
