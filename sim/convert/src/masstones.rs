//! Starting mixtures of a fit without a near neighbour: all pairs and triples of the paints, opaque.

use maulstick_num::exp;
use maulstick_optics::colour::{apply, delta_e_2000_near};

use crate::cell::{CellColour as _, FilmCell};
use crate::palette::Palette;

/// Logarithms of the ratios of two paints: a hundredth of a phthalo equals half of an ochre.
const RATIOS: [f64; 7] = [-5.5, -3.5, -1.8, 0.0, 1.8, 3.5, 5.5];
/// Logarithms of the ratios of the second and third of three paints.
const COARSE: [f64; 3] = [-3.0, 0.0, 3.0];
/// Greatest number of paints with listed triples.
const MOST_IN_TRIPLES: usize = 16;
/// Thickness of an opaque film, m.
const OPAQUE_M: f64 = 0.01;

/// Mixtures and their colours.
#[derive(Debug, Default)]
pub(crate) struct Masstones {
    /// CIELAB, and the offset of the mixture's shares among the parts.
    colours: Vec<([f64; 3], usize)>,
    /// Paints and their shares, mixture by mixture.
    parts: Vec<(usize, f64)>,
}

impl Masstones {
    /// The mixtures of these paints.
    pub(crate) fn new(palette: &Palette<'_>) -> Self {
        let paints = palette.slots.len();
        let under = vec![0.0; palette.weights.len()];
        let film = FilmCell {
            palette,
            under: &under,
            thickness_m: OPAQUE_M,
        };
        let mut table = Self::default();
        let (mut shares, mut slopes) = (vec![0.0; paints], vec![[0.0; 3]; paints]);
        let mut add = |parts: &[(usize, f64)]| {
            let sum: f64 = parts.iter().map(|part| part.1).sum();
            shares.fill(0.0);
            let begin = table.parts.len();
            for (paint, part) in parts {
                shares[*paint] = part / sum;
                table.parts.push((*paint, part / sum));
            }
            let lab = film.lab(&shares, &mut slopes);
            table.colours.push((lab, begin));
        };
        for a in 0..paints {
            add(&[(a, 1.0)]);
            for b in 0..a {
                for ratio in RATIOS {
                    add(&[(a, 1.0), (b, exp(ratio))]);
                }
                for c in (0..b).filter(|_| paints <= MOST_IN_TRIPLES) {
                    for one in COARSE {
                        for other in COARSE {
                            add(&[(a, 1.0), (b, exp(one)), (c, exp(other))]);
                        }
                    }
                }
            }
        }
        table
    }

    /// Shares of the mixture nearest to a colour, CIELAB.
    pub(crate) fn nearest(&self, colour: [f64; 3], shares: &mut [f64]) {
        let metric = delta_e_2000_near(colour);
        let mut best = (0, f64::INFINITY);
        for (place, (lab, _)) in self.colours.iter().enumerate() {
            let [l, c, h] = apply(&metric, [0, 1, 2].map(|i| lab[i] - colour[i]));
            let off = l * l + c * c + h * h;
            if off < best.1 {
                best = (place, off);
            }
        }
        shares.fill(0.0);
        let begin = |place: usize| self.colours.get(place).map(|colour| colour.1);
        let Some(first) = begin(best.0) else {
            return;
        };
        let end = begin(best.0 + 1).unwrap_or(self.parts.len());
        for (paint, share) in &self.parts[first..end] {
            shares[*paint] = *share;
        }
    }
}
