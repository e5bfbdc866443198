//! Body of a paint: the stress at which it yields at rest, and how soon that is back once a brush has sheared it.
//!
//! White oil paints yield at 50 to 500 Pa, the more the less oil they have (Salvant Plisson et al. 2014). We found no
//! published figures of other pigments: a paint file may have its own.

use crate::oil::{USUAL, oil_share};

/// Body of a paint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaintBody {
    /// Yield stress at rest, Pa.
    pub rest_pa: f64,
    /// Time in which 1 − 1/e of it is back, s.
    pub recovers_s: f64,
}

/// Yield stress at rest of a paint with a usual share of oil, Pa, and the part of it that a share of oil takes away by its
/// excess over the usual one.
const USUAL_PA: f64 = 167.0;
const SOFTENS: f64 = 2.0;
/// Time in which paint stiffens again, s.
const RECOVERS_S: f64 = 0.1;

impl PaintBody {
    /// Greatest yield stress, Pa, and the longest recovery, s: those of a putty, and a day.
    pub const MOST: [f64; 2] = [1e5, 86_400.0];
    /// A medium, which does not set.
    pub const FLUID: Self = Self {
        rest_pa: 0.0,
        recovers_s: 0.0,
    };

    /// The body of a paint of which only the pigments are known, by their share of oil.
    #[must_use]
    pub fn of_pigments(colour_index: &str) -> Self {
        Self {
            rest_pa: USUAL_PA * (1.0 - SOFTENS * (oil_share(colour_index) - USUAL)),
            recovers_s: RECOVERS_S,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lean_paint_is_stiffer_than_rich_paint() {
        let rest = ["PB29", "PW6", "PBr7"].map(|index| PaintBody::of_pigments(index).rest_pa);
        assert!(
            rest[0] > 1.2 * rest[1] && rest[1] > 1.2 * rest[2],
            "{rest:?}"
        );
        assert!(
            rest.iter().all(|pa| (100.0..300.0).contains(pa)),
            "{rest:?}"
        );
    }
}
