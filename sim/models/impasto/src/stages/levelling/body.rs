//! Body of the paints of a window: what they yield at, cell by cell, and how thinner changes it.

use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::window::{Area, Window};
use maulstick_model::rheology::{Setting, yield_left};
use maulstick_num::exp_f32;
use maulstick_num::select::larger;

use super::{HALO, Levelling};

/// Rheology of a paint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Yield stress, Pa.
    pub yield_pa: f64,
    /// Viscosity beyond it, Pa·s.
    pub viscosity_pa_s: f64,
}

impl Body {
    /// Usual paint from the tube, at rest.
    pub const TUBE: Self = Self {
        yield_pa: Setting::TUBE.rest_pa,
        viscosity_pa_s: 20.0,
    };
}

/// Paints of a window: the slot of the thinner, and the yield stress of each slot by that of the round's body.
#[derive(Clone, Copy, Debug)]
pub struct Paints {
    /// The slot of the thinner, if there is one.
    pub thinner: Option<usize>,
    /// Yield stresses by slot.
    pub yields: [f32; SLOTS],
}

impl From<Option<usize>> for Paints {
    /// Paints that all have the round's body.
    fn from(thinner: Option<usize>) -> Self {
        let yields = [1.0; SLOTS];
        Self { thinner, yields }
    }
}

/// Yield stress and fluidity of paint of which `thinner` is a share of 0 to 1, by those of the paint alone.
#[must_use]
#[inline(always)]
pub fn thinned(thinner: f32) -> [f32; 2] {
    [yield_left(thinner), 1.0 / exp_f32(-THINS * thinner)]
}

/// ln of the fluidity of thinner alone relative to paint.
const THINS: f32 = 7.0;

impl Levelling {
    /// Yield stress and fluidity by cell: the mean of its paints' by volume, thinned by its thinner.
    pub(super) fn soften(&mut self, window: &Window, area: &Area, to_cells: f32, paints: &Paints) {
        let pigmented = || {
            window
                .planes()
                .filter(|(slot, _)| Some(*slot) != paints.thinner)
        };
        let mut yields = pigmented().map(|(slot, _)| paints.yields[slot]);
        let first = yields.next().unwrap_or(1.0);
        let is_one_body = yields.all(|yields| yields == first);
        for (plane, value) in self.body.iter_mut().zip([first, 1.0]) {
            plane.clear();
            plane.resize(self.wet.len(), value);
        }
        let thin = paints.thinner.and_then(|slot| window.plane(slot));
        if is_one_body && thin.is_none() {
            return;
        }
        for (row, cells) in area.rows(window.width()).enumerate() {
            let start = (row + HALO) * self.width + HALO;
            for (x, cell) in cells.enumerate() {
                let at = start + x;
                if self.wet[at] <= 0.0 {
                    continue;
                }
                if !is_one_body {
                    let parts = pigmented().map(|(slot, plane)| [plane[cell], paints.yields[slot]]);
                    let sums = parts.fold([0.0; 2], |[all, sum], [count, own]| {
                        [all + count, sum + count * own]
                    });
                    self.body[0][at] = sums[1] / larger(sums[0], 1.0);
                }
                let count = thin.map_or(0.0, |thin| thin[cell]);
                if count > 0.0 {
                    let [yields, fluid] = thinned(count * to_cells / self.wet[at]);
                    self.body[0][at] *= yields;
                    self.body[1][at] = fluid;
                }
            }
        }
    }
}
