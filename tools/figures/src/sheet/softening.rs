//! Softening by a blender: the edge between two wet colours, as applied and softened.

use super::gesture::{Gesture, Moment, ease, swell};
use super::marks::stroke;

/// Size of the panel, mm.
pub(crate) const PANEL_MM: [f64; 2] = [super::MARKS_MM, 40.0];

/// Two bands of colour that meet in the middle of the panel, each painted there and back, with their mixtures.
pub(crate) fn bands() -> Vec<(&'static str, Gesture)> {
    let band = |y: f64, [from, to]: [f64; 2]| {
        let way = vec![[from, y], [0.5 * (from + to), y], [to, y]];
        stroke(way, 3.5, 90.0, |t| 0.04 + 0.4 * swell(t, 0.08))
    };
    let blue = "Ultramarine Blue=0.36,Titanium White=0.24,Thinner=0.4";
    let yellow = "Hansa Yellow Opaque=0.36,Titanium White=0.24,Thinner=0.4";
    let way = |x: f64| [x, PANEL_MM[0] - x];
    [(blue, 29.0), (yellow, 11.0)]
        .into_iter()
        .flat_map(|(mixture, y)| [12.0, PANEL_MM[0] - 12.0].map(|x| (mixture, band(y, way(x)))))
        .collect()
}

/// Light sweeps across the edge, up and down in turn, anywhere over the right half.
pub(crate) fn sweeps() -> Vec<Gesture> {
    // Multiples of 1/φ (golden ratio) and of 1/ρ, 1/ρ² (plastic number, ρ³ = ρ + 1) are even and never in step.
    let share = |i: u32, ratio: f64| (f64::from(i) * ratio).fract();
    (0..120)
        .map(|i| {
            let x = 150.0 + 118.0 * share(i, 0.618_033_988_7);
            let aside = 6.0 * (share(i, 0.754_877_666_2) - 0.5);
            let reach = 6.0 + 5.0 * share(i, 0.569_840_290_9);
            let up = if i % 2 == 0 { 1.0 } else { -1.0 };
            Gesture {
                seconds: 0.5,
                hand: Box::new(move |t| {
                    let way = 2.0 * ease(t) - 1.0;
                    Moment {
                        at: [x + aside * way, 20.0 + up * reach * way],
                        pressure: 0.02 + 0.42 * swell(t, 0.4),
                        tilt_deg: [0.0, 18.0 * up],
                        twist_deg: 0.0,
                    }
                }),
            }
        })
        .collect()
}
