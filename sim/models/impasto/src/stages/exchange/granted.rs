//! What the touching texels grant.

use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::BrushTraits;

/// Greatest share of a film used up at once: reduced so that rounding never takes more than there is.
const SAFE_SHARE: f32 = 1.0 - 1.0 / 1_048_576.0;

/// Paint that each touching texel gives and takes.
#[derive(Clone, Debug, Default)]
pub(super) struct Granted {
    /// Quanta demanded from the texel, and offered to it; later the grant per quantum in its film.
    pub asked: Vec<[f32; 2]>,
    /// Share of the offers that the texel takes.
    pub taken: Vec<f32>,
    /// Quanta in its film.
    pub film: Vec<f32>,
}

impl Granted {
    /// Scales the demands on each texel, and the offers to it, to its stock and capacity.
    pub(super) fn grant(
        &mut self,
        texels: &[u32],
        load: &BrushLoad,
        traits: &BrushTraits,
        sponge: bool,
    ) {
        let most = traits.film_most as f32;
        self.taken.clear();
        self.film.clear();
        for (texel, [drawn, offered]) in texels.iter().zip(&mut self.asked) {
            let film = load.film(*texel as usize) as f32;
            let granted = if *drawn > film && !sponge {
                SAFE_SHARE * film / *drawn
            } else {
                1.0
            };
            let room = (most - film + *drawn * granted).max(0.0);
            let taken = if *offered > room && !sponge {
                room / *offered
            } else {
                1.0
            };
            // By quantum of all paints in the film, from which each paint's share follows.
            *drawn = if film > 0.0 { granted / film } else { 0.0 };
            self.taken.push(taken);
            self.film.push(film);
        }
    }
}
