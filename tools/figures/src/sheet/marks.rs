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

/// Middle of the panel, mm from its lower edge.
const MIDDLE_MM: f64 = 0.5 * PANEL_MM[1];

/// Marks of a brush on a panel: from a touch to full pressure; a wave; on its edge, twice; three dabs; lightly until it
/// is dry.
pub(crate) fn marks(file: &BrushFile) -> Vec<Mark> {
    let width_mm = file.head.width_mm;
    let mut marks = vec![touch(), wave(width_mm)];
    marks.extend(on_edge(file));
    marks.extend(dabs(width_mm));
    marks.extend(dry(width_mm));
    marks
}

fn is_wide(width_mm: f64) -> bool {
    width_mm > 12.0
}

/// From a touch to full pressure.
fn touch() -> Mark {
    let y = MIDDLE_MM;
    let way = vec![[10.0, y - 3.0], [34.0, y + 3.0], [60.0, y]];
    Mark {
        load: Some("Ultramarine Blue=0.75,Titanium White=0.25"),
        gesture: stroke(way, 1.6, 90.0, |t| {
            0.02 + 0.9 * ease(t) * ease((1.0 - t) / 0.04)
        }),
    }
}

fn wave(width_mm: f64) -> Mark {
    let swing = if width_mm > 20.0 { 6.0 } else { 9.0 };
    let point = |i: i32| {
        let t = f64::from(i) / 16.0;
        let turn = maulstick_num::sin(2.0 * std::f64::consts::PI * 2.0 * t);
        [88.0 + 40.0 * t, MIDDLE_MM + swing * turn]
    };
    Mark {
        load: Some("Quinacridone Red=0.8,Titanium White=0.2"),
        gesture: stroke((0..=16).map(point).collect(), 2.2, 60.0, |t| {
            0.08 + 0.36 * swell(t, 0.15)
        }),
    }
}

/// On its edge, lightly and pressed.
fn on_edge(file: &BrushFile) -> impl Iterator<Item = Mark> {
    let width_mm = file.head.width_mm;
    let [left, right] = [-1.0, 1.0].map(|place| file.length_share([place, 0.0]));
    // The long side of a slanted brush trails, held nearly upright.
    let (tilt, twist_deg) = if right > left {
        (6.0, 180.0)
    } else {
        (25.0, 0.0)
    };
    let edge = [150.0 + 0.5 * width_mm, 194.0 - 0.5 * width_mm];
    let rows = [0.1, 0.24].into_iter().enumerate();
    rows.map(move |(row, pressure)| {
        let y = MIDDLE_MM + 9.0 - 18.0 * row as f64;
        Mark {
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
        }
    })
}

/// Three dabs; one of a wide brush.
fn dabs(width_mm: f64) -> impl Iterator<Item = Mark> {
    let (first, apart, dabs) = if is_wide(width_mm) {
        (222.0, width_mm, 1)
    } else {
        (211.0, 10.0, 3)
    };
    (0..dabs).map(move |dab| {
        let at = [first + apart * f64::from(dab), MIDDLE_MM];
        let pressure = 0.35 + 0.2 * f64::from(dab);
        Mark {
            load: (dab == 0).then_some("Yellow Ochre"),
            gesture: Gesture {
                seconds: 0.5,
                hand: Box::new(move |t| Moment {
                    at: [at[0] + 2.0 * t, at[1] + 4.0 - 8.0 * ease(t)],
                    pressure: 0.02 + pressure * swell(t, 0.4),
                    tilt_deg: [8.0, -20.0],
                    twist_deg: 0.0,
                }),
            },
        }
    })
}

/// Lightly until it is dry.
fn dry(width_mm: f64) -> impl Iterator<Item = Mark> {
    let (rows, up) = if is_wide(width_mm) {
        (1, 0.0)
    } else {
        (2, 10.0)
    };
    (0..rows).map(move |row| {
        let y = MIDDLE_MM + (up - 20.0 * f64::from(row));
        Mark {
            load: (row == 0).then_some("Phthalo Green Blue Shade=0.35,Hansa Yellow Opaque=0.65"),
            gesture: stroke(
                vec![[250.0, y], [265.0, y + 2.0], [278.0, y]],
                1.0,
                90.0,
                move |t| 0.02 + (0.28 - 0.14 * f64::from(row)) * swell(t, 0.12),
            ),
        }
    })
}
