//! Six marks of one-stroke painting (Baxter 2004, § 3.6) from a double-loaded brush: petal, leaf,
//! shell, comma, chisel line, C-stroke.
//!
//! The brush carries a colour on either half of its width; it stands on its chisel edge, is pressed,
//! turned and lifted.

use std::f64::consts::PI;

use maulstick_num::{cos, sin};

use maulstick_brush::BrushFile;

use super::gesture::{Gesture, Moment, ease, swell};

/// Size of the panel of the six marks, mm.
pub(crate) const PANEL_MM: [f64; 2] = [super::MARKS_MM, 52.0];

/// Length of the corner bristles, by the longest, below which a brush cannot turn on a corner.
const ROUND_CORNERS: f64 = 0.9;

/// The marks of a brush in order, each in a sixth of the panel. One with round corners cannot turn on them: its petal is
/// pressed and pulled to a point, and five of these are its shell.
pub(crate) fn marks(file: &BrushFile) -> [Gesture; 6] {
    let width_mm = file.head.width_mm;
    let is_round = file.length_share([1.0, 0.0]) < ROUND_CORNERS;
    let place = |i: usize| {
        let across = PANEL_MM[0] / 6.0;
        [across * (i as f64 + 0.5), 0.5 * PANEL_MM[1]]
    };
    let (first, third) = if is_round {
        (pulled_petals(place(0), 1), pulled_petals(place(2), 5))
    } else {
        (petal(place(0), width_mm), shell(place(2), width_mm))
    };
    [
        first,
        leaf(place(1)),
        third,
        comma(place(3)),
        chisel_line(place(4)),
        c_stroke(place(5)),
    ]
}

/// Petals around a point, each pressed outside, pulled inward and lifted to its point.
fn pulled_petals(middle: [f64; 2], petals: u32) -> Gesture {
    let base = [middle[0], middle[1] - 12.0];
    Gesture {
        seconds: 1.2 * f64::from(petals),
        hand: Box::new(move |t| {
            let along = t * f64::from(petals);
            let petal = along.floor().min(f64::from(petals - 1));
            let way = along - petal;
            let turn = 90.0 + 38.0 * (0.5 * f64::from(petals - 1) - petal);
            Moment {
                at: polar(base, 21.0 - 17.0 * ease(way), turn),
                pressure: 0.26 * ease(way / 0.35) * ease((1.0 - way) / 0.6),
                tilt_deg: [0.0; 2],
                twist_deg: turn - 90.0,
            }
        }),
    }
}

fn polar(middle: [f64; 2], radius: f64, degrees: f64) -> [f64; 2] {
    let angle = degrees * PI / 180.0;
    [
        middle[0] + radius * cos(angle),
        middle[1] + radius * sin(angle),
    ]
}

/// Pivots on the inner corner, pressed: the outer one draws the rim.
fn petal(middle: [f64; 2], width_mm: f64) -> Gesture {
    let base = [middle[0], middle[1] - 5.0];
    Gesture {
        seconds: 2.2,
        hand: Box::new(move |t| {
            let turn = 160.0 - 140.0 * ease(t);
            Moment {
                at: polar(base, 0.62 * width_mm, turn),
                pressure: 0.03 + 0.34 * swell(t, 0.25),
                tilt_deg: [0.0; 2],
                twist_deg: turn,
            }
        }),
    }
}

/// Stands on the chisel edge, is pressed to the leaf's width, and turned and lifted to its point.
fn leaf(middle: [f64; 2]) -> Gesture {
    Gesture {
        seconds: 1.8,
        hand: Box::new(move |t| {
            let way = ease(t);
            Moment {
                at: [
                    middle[0] - 12.0 + 26.0 * way,
                    middle[1] - 8.0 + 16.0 * way + 4.0 * sin(PI * way),
                ],
                pressure: 0.03 + 0.55 * swell(t, 0.45) * (1.0 - 0.4 * t),
                tilt_deg: [12.0, 6.0],
                twist_deg: 120.0 - 90.0 * ease((t - 0.35) / 0.65),
            }
        }),
    }
}

/// A petal with the outer corner wiggled out and in: a rim of scallops.
fn shell(middle: [f64; 2], width_mm: f64) -> Gesture {
    let base = [middle[0], middle[1] - 5.0];
    Gesture {
        seconds: 4.0,
        hand: Box::new(move |t| {
            let turn = 165.0 - 150.0 * t;
            let wiggle = 2.6 * sin(2.0 * PI * 5.0 * t);
            Moment {
                at: polar(base, 0.6 * width_mm + 2.0 + wiggle, turn),
                pressure: 0.06 + 0.36 * swell(t, 0.12),
                tilt_deg: [0.0; 2],
                twist_deg: turn,
            }
        }),
    }
}

/// Pressed down at once, drawn around and lifted to nothing.
fn comma(middle: [f64; 2]) -> Gesture {
    Gesture {
        seconds: 1.1,
        hand: Box::new(move |t| {
            let turn = 120.0 + 115.0 * ease(t);
            Moment {
                at: polar([middle[0] + 8.0, middle[1] + 1.0], 14.0, turn),
                pressure: 0.03 + 0.6 * ease(t / 0.12) * ease((1.0 - t) / 0.85),
                tilt_deg: [-6.0, -16.0],
                twist_deg: 20.0 + 20.0 * t,
            }
        }),
    }
}

/// On the chisel edge along its own width.
fn chisel_line(middle: [f64; 2]) -> Gesture {
    Gesture {
        seconds: 1.2,
        hand: Box::new(move |t| Moment {
            at: [
                middle[0] - 14.0 + 28.0 * ease(t),
                middle[1] - 10.0 + 20.0 * ease(t),
            ],
            pressure: 0.02 + 0.035 * swell(t, 0.2),
            tilt_deg: [4.0, 3.0],
            twist_deg: 35.5,
        }),
    }
}

/// A chisel line that swells around the back of a C and thins again, the brush never turned.
fn c_stroke(middle: [f64; 2]) -> Gesture {
    Gesture {
        seconds: 1.8,
        hand: Box::new(move |t| {
            let turn = 60.0 + 240.0 * ease(t);
            Moment {
                at: polar(middle, 12.0, turn),
                pressure: 0.03 + 0.4 * swell(t, 0.5),
                tilt_deg: [0.0, -10.0],
                twist_deg: 0.0,
            }
        }),
    }
}
