//! Prior of a paint before it is measured: the mean of the measured ones.

use maulstick_num::{exp, ln};
use maulstick_optics::paints::WHITE_S_PER_M;
use maulstick_optics::{PaintError, PaintLibrary};

use crate::wavelength::Unknowns;

const WHITE: &str = "Titanium White";

/// Medians of the measured paints, whites' own for the white.
#[derive(Clone, Debug)]
pub struct Prior {
    library: PaintLibrary,
}

impl Prior {
    /// Those of the paints that come with the optics.
    ///
    /// # Errors
    /// None in practice: they are part of the program.
    pub fn measured() -> Result<Self, PaintError> {
        Ok(Self {
            library: PaintLibrary::measured()?,
        })
    }

    /// K and S of `paints` paints at `nm`, relative to the white's S, and a unit of 1.
    #[must_use]
    pub fn at(&self, nm: f64, paints: usize, white: usize) -> Unknowns {
        let paints_of = |is_white: bool| {
            let all = self.library.paints().iter();
            all.filter(move |paint| (paint.name == WHITE) == is_white)
        };
        let median = |values: Vec<f64>| {
            let mut logs: Vec<f64> = values
                .into_iter()
                .map(|value| ln((value / WHITE_S_PER_M).max(1e-6)))
                .collect();
            logs.sort_by(f64::total_cmp);
            logs.get(logs.len() / 2).map_or(1.0, |middle| exp(*middle))
        };
        let k = median(paints_of(false).map(|paint| paint.k.at(nm)).collect());
        let s = median(paints_of(false).map(|paint| paint.s.at(nm)).collect());
        let mut usual = Unknowns {
            k: vec![k; paints],
            s: vec![s; paints],
            unit: 1.0,
        };
        usual.k[white] = median(paints_of(true).map(|paint| paint.k.at(nm)).collect());
        usual.s[white] = 1.0;
        usual
    }
}
