//! Films of a brush on its raster (Baxter 2004, § 4.5.1): each texel's film is distributed over its cells, and their
//! contents after the blends become its film again.

use std::ops::Range;

use maulstick_canvas::quantum::{QUANTA_PER_UNIT, SLOTS};
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::{BrushTraits, TEXELS_PER_STRIP};
use maulstick_model::footprint::drawn::Drawn;
use maulstick_num::fork_join::each;

/// Film of one paint on the raster.
#[derive(Debug, Default)]
pub(crate) struct Film {
    pub(crate) slot: usize,
    /// Quanta by cell; 0 without a texel.
    pub(crate) plane: Vec<f32>,
    /// Quanta lent by each texel to each of its cells; a last 0 for the cells without one.
    lent: Vec<f32>,
    /// Quanta returned to each texel.
    back: Vec<i64>,
}

/// The paints of a brush on its raster.
#[derive(Debug, Default)]
pub(crate) struct Films {
    films: Vec<Film>,
    used: usize,
    /// Number of cells of each texel.
    cells: Vec<u32>,
    /// Share of a texel's film on each of its cells.
    shares: Vec<f64>,
}

/// The cells of the raster that are covered, row after row.
fn rows(drawn: &Drawn) -> impl Iterator<Item = Range<usize>> + use<> {
    let ([left, low], [right, high]) = drawn.reach;
    let stride = drawn.stride;
    (low..high).map(move |y| y * stride + left..y * stride + right)
}

impl Film {
    fn lend(&mut self, drawn: &Drawn, film: Option<&[u32]>, cells: &[u32], shares: &[f64]) {
        self.plane.clear();
        self.plane.resize(drawn.texel.len(), 0.0);
        self.lent.clear();
        self.lent.resize(cells.len() + 1, 0.0);
        let Some(film) = film else { return };
        let texels = film.iter().zip(cells.iter().zip(shares));
        for (lent, (held, (cells, share))) in self.lent.iter_mut().zip(texels) {
            if *cells > 0 {
                *lent = (f64::from(*held) * share) as u32 as f32;
            }
        }
        for row in rows(drawn) {
            for (quanta, texel) in self.plane[row.clone()].iter_mut().zip(&drawn.texel[row]) {
                *quanta = self.lent[cells.len().min(*texel as usize)];
            }
        }
    }

    /// Sums the cells of each texel.
    fn gather(&mut self, drawn: &Drawn) {
        self.back.clear();
        self.back.resize(self.lent.len(), 0);
        for row in rows(drawn) {
            for (quanta, texel) in self.plane[row.clone()].iter().zip(&drawn.texel[row]) {
                if let Some(back) = self.back.get_mut(*texel as usize) {
                    *back += i64::from(*quanta as i32);
                }
            }
        }
    }
}

impl Films {
    /// Films in use, by slot.
    pub(crate) fn in_use(&mut self) -> &mut [Film] {
        &mut self.films[..self.used]
    }

    /// Quanta of a paint on each cell of the raster.
    pub(crate) fn of(&self, slot: usize) -> Option<&[f32]> {
        let mut films = self.films[..self.used].iter();
        let film = films.find(|film| film.slot == slot);
        film.map(|film| &film.plane[..])
    }

    /// The strips with a cell; a strip may occur more than once.
    pub(crate) fn strips(&self) -> impl Iterator<Item = usize> + '_ {
        let texels = self.cells.iter().enumerate();
        let texels = texels.filter(|(_, cells)| **cells > 0);
        texels.map(|(texel, _)| texel / TEXELS_PER_STRIP)
    }

    /// Distributes the films of these paints over the cells of a head.
    pub(crate) fn lend(
        &mut self,
        drawn: &Drawn,
        load: &BrushLoad,
        traits: &BrushTraits,
        slots: &[usize],
    ) {
        self.cells.clear();
        self.cells.resize(load.texels(), 0);
        for row in rows(drawn) {
            for texel in &drawn.texel[row] {
                if let Some(cells) = self.cells.get_mut(*texel as usize) {
                    *cells += 1;
                }
            }
        }
        // Number of cells with the volume of a texel's film.
        let large = 1.0 / (QUANTA_PER_UNIT * f64::from(traits.film_units_per_quantum));
        let share = |cells: &u32| 1.0 / large.max(f64::from(*cells));
        self.shares.clear();
        self.shares.extend(self.cells.iter().map(share));
        self.used = slots.len();
        let films = self.films.len().max(slots.len());
        self.films.resize_with(films, Film::default);
        for (film, slot) in self.films.iter_mut().zip(slots) {
            film.slot = *slot;
        }
        let (cells, shares) = (&self.cells, &self.shares);
        each(&mut self.films[..self.used], |film| {
            film.lend(drawn, load.film_of(film.slot), cells, shares);
        });
    }

    /// Returns the cells' quanta to their texels. By slot, the gain of the brush.
    pub(crate) fn give_back(&mut self, drawn: &Drawn, load: &mut BrushLoad) -> [i64; SLOTS] {
        let mut gained = [0; SLOTS];
        let films = &mut self.films[..self.used];
        each(films, |film| film.gather(drawn));
        for film in films {
            let texels = film.lent.iter().zip(&film.back).zip(&self.cells);
            for (texel, ((lent, back), cells)) in texels.enumerate() {
                let change = back - *lent as i64 * i64::from(*cells);
                if change != 0 {
                    load.change_film(film.slot, texel, change as i32);
                    gained[film.slot] += change;
                }
            }
        }
        gained
    }
}
