//! Softening by a blender: the edge between two wet colours, as applied and softened.

use super::gesture::{Gesture, Moment, ease, swell};
use super::marks::stroke;

/// Size of the panel, mm.
pub const PANEL_MM: [f64; 2] = [250.0, 40.0];

/// Two bands of colour that meet in the middle of the panel, with their mixtures.
pub fn bands() -> Vec<(&'static str, Gesture)> {
    let band = |y: f64| {
        stroke(vec![[12.0, y], [125.0, y], [238.0, y]], 3.0, 90.0, |t| {
            0.04 + 0.4 * swell(t, 0.08)
        })
    };
    vec![
        (
            "Ultramarine Blue=0.36,Titanium White=0.24,Thinner=0.4",
            band(29.0),
        ),
        (
            "Hansa Yellow Opaque=0.36,Titanium White=0.24,Thinner=0.4",
            band(11.0),
        ),
    ]
}

/// Light sweeps across the edge, over the right half.
pub fn sweeps() -> Vec<Gesture> {
    (0..88)
        .map(|i| {
            let x = 134.0 + 9.5 * f64::from(i % 11);
            let up = i % 2 == 0;
            Gesture {
                seconds: 0.5,
                hand: Box::new(move |t| {
                    let way = if up { ease(t) } else { 1.0 - ease(t) };
                    Moment {
                        at: [x, 12.0 + 16.0 * way],
                        pressure: 0.02 + 0.5 * swell(t, 0.25),
                        tilt_deg: [0.0, if up { 18.0 } else { -18.0 }],
                        twist_deg: 0.0,
                    }
                }),
            }
        })
        .collect()
}
