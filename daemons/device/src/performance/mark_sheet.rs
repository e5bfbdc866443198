//! A sheet of marks that shows the effects of brush and paint side by side.

use std::f64::consts::TAU;

use maulstick_num::{cos, sin};

use crate::strokes::{Pressure, Stroke, Strokes};

/// Loads of the brush for the sheet, in turn.
pub const LOADS: [&str; 4] = [
    "Ultramarine Blue",
    "Cadmium Orange",
    "Hansa Yellow Opaque",
    "Quinacridone Magenta=0.3,Titanium White=0.7",
];

/// Draws the marks, in the order of their colours in [`LOADS`].
pub(crate) fn marks(strokes: &mut Strokes) {
    pressure(strokes);
    crossings(strokes);
    running_out(strokes);
    commas(strokes);
    stirring(strokes);
}

/// From a touch to full pressure.
fn pressure(strokes: &mut Strokes) {
    for row in 0..4 {
        let y = 0.108 - 0.017 * f64::from(row);
        strokes.push(Stroke {
            points: vec![[-0.115, y], [-0.07, y + 0.003], [-0.015, y]],
            pressure: 0.25 + 0.25 * f64::from(row),
            course: Pressure::Grow,
            seconds: 1.6,
        });
    }
}

/// Wet strokes across each other.
fn crossings(strokes: &mut Strokes) {
    for i in 0..4 {
        let x = 0.030 + 0.021 * f64::from(i);
        strokes.stroke(vec![[x, 0.112], [x, 0.045]], 0.5, 1.2);
    }
    for i in 0..4 {
        let y = 0.100 - 0.014 * f64::from(i);
        strokes.stroke(vec![[0.018, y], [0.112, y - 0.002]], 0.5, 1.4);
    }
}

/// One load until the brush is dry, over the tooth of the canvas.
fn running_out(strokes: &mut Strokes) {
    for (row, pressure) in [0.30, 0.45, 0.60, 0.8].into_iter().enumerate() {
        let y = 0.018 - 0.030 * row as f64;
        let wave = |i: i32| {
            let t = f64::from(i) / 64.0;
            [-0.115 + 0.108 * t, y + 0.011 * sin(TAU * 8.0 * t)]
        };
        strokes.stroke((0..=64).map(wave).collect(), pressure, 6.0);
    }
}

/// Short marks, pressed and lifted.
fn commas(strokes: &mut Strokes) {
    for i in 0..8 {
        let x = 0.020 + 0.0125 * f64::from(i);
        let lean = strokes.about(0.004, 0.002);
        let pressure = 0.35 + 0.08 * f64::from(i);
        strokes.stroke(
            vec![[x, 0.022], [x + lean, 0.010], [x + 0.2 * lean, -0.006]],
            pressure.min(0.85),
            0.5,
        );
    }
}

/// Two colours side by side, stirred with a third brushful.
fn stirring(strokes: &mut Strokes) {
    strokes.stroke(vec![[0.030, -0.035], [0.105, -0.033]], 0.7, 1.4);
    strokes.stroke(vec![[0.030, -0.056], [0.105, -0.054]], 0.7, 1.4);
    strokes.stroke(vec![[0.030, -0.077], [0.105, -0.075]], 0.7, 1.4);
    let spiral = |i: i32| {
        let t = f64::from(i) / 48.0;
        let radius = 0.026 * (1.0 - 0.6 * t);
        [
            0.066 + 1.2 * radius * cos(TAU * 4.0 * t),
            -0.055 + radius * sin(TAU * 4.0 * t),
        ]
    };
    strokes.stroke((0..=48).map(spiral).collect(), 0.55, 5.0);
}
