//! Fits of a cell's layers, each starting from the cell before.

use std::sync::Arc;

use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::quantum::QUANTUM_M;

use crate::cell::{CellColour, FilmCell, VolumeCell};
use crate::fit::{Fitter, Found, Wanted, whole};
use crate::masstones::Masstones;
use crate::palette::Palette;
use crate::shown::{Kind, Paints, Shown};

/// Distance, ΔE₀₀, from which a fit is also tried from another start.
const RETRY_DELTA_E: f64 = 1.0;

/// Inputs of a fit, equal for many neighbours.
#[derive(Clone, Debug, Default, PartialEq)]
struct Asked {
    /// Quanta by paint of the palette, and their sum.
    counts: Vec<f32>,
    all: u64,
    /// Target colour, CIELAB.
    colour: [f64; 3],
    /// Reflectances or encoded channels of the ground.
    under: Vec<f64>,
    /// Opacity of the layer, and the least share of the ground that its volume replaces.
    opacity: f64,
    hides: f64,
}

/// Fitted paints of a layer of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fitted<'a> {
    /// Quanta by paint of the palette.
    pub(crate) counts: &'a [u64],
    /// Wet quanta noted over a dry layer that give it the required opacity; 0 if none are needed.
    pub(crate) over: f32,
}

/// What paint is converted to.
#[derive(Debug)]
pub(crate) struct Target<'a> {
    pub(crate) palette: Palette<'a>,
    pub(crate) paints: Paints,
    pub(crate) masstones: Option<Masstones>,
}

/// Fits of cells.
pub(crate) struct CellFit<'a> {
    target: &'a Target<'a>,
    fitter: Fitter,
    /// Fitter with the ground as one more paint.
    blender: Fitter,
    asked: Asked,
    last: Asked,
    own: Vec<f64>,
    start: Vec<f64>,
    found: Found,
    other: Found,
    counts: Vec<u64>,
    over: f32,
}

impl<'a> CellFit<'a> {
    pub(crate) fn new(target: &'a Target<'a>) -> Self {
        let paints = target.palette.slots.len();
        Self {
            target,
            fitter: Fitter::new(paints),
            blender: Fitter::new(paints + 1),
            asked: Asked::default(),
            last: Asked::default(),
            own: Vec::new(),
            start: Vec::new(),
            found: Found::default(),
            other: Found::default(),
            counts: Vec::new(),
            over: 0.0,
        }
    }

    /// Loads the paint of a cell, a plane for each of the palette; returns its quanta.
    pub(crate) fn take(&mut self, planes: &[Option<&Arc<[f32]>>], cell: usize) -> u64 {
        let count = |plane: &Option<&Arc<[f32]>>| plane.map_or(0.0, |plane| plane[cell]);
        let asked = &mut self.asked;
        asked.counts.clear();
        asked.counts.extend(planes.iter().map(count));
        asked.all = asked.counts.iter().map(|count| *count as u64).sum();
        asked.all
    }

    /// The paints that give the colour `wanted` over the ground `under`.
    pub(crate) fn fitted(
        &mut self,
        wanted: &Shown,
        under: &Shown,
        kind: &Kind,
        cell: usize,
    ) -> Fitted<'_> {
        let asked = &mut self.asked;
        asked.colour = wanted.lab(&self.target.palette, cell);
        asked.under.clear();
        asked.opacity = kind.opacity().into();
        match under {
            Shown::Films(planes) => {
                let values = planes.iter().skip(cell).step_by(TILE_CELLS);
                asked.under.extend(values.map(|r| f64::from(*r)));
            }
            Shown::Volumes(rgb) => {
                let values = rgb.iter().map(|plane| f64::from(plane[cell]));
                asked.under.extend(values);
                if let Paints::Volumes(volumes) = &self.target.paints {
                    asked.hides = kind.hides(volumes.of, cell, asked.all as f32).into();
                }
            }
        }
        if self.asked != self.last || self.counts.is_empty() {
            self.fit(kind);
            std::mem::swap(&mut self.asked, &mut self.last);
        }
        Fitted {
            counts: &self.counts,
            over: self.over,
        }
    }

    fn fit(&mut self, kind: &Kind) {
        let asked = std::mem::take(&mut self.asked);
        let share = |count: &f32| f64::from(*count) / asked.all as f64;
        self.own.clear();
        self.own.extend(asked.counts.iter().map(share));
        let palette = &self.target.palette;
        self.over = 0.0;
        match &self.target.paints {
            Paints::Films => {
                let film = FilmCell {
                    palette,
                    under: &asked.under,
                    thickness_m: asked.all as f64 * QUANTUM_M * asked.opacity,
                };
                self.shares(&film, asked.colour);
            }
            Paints::Volumes(volumes) => {
                let under = [0, 1, 2].map(|channel| asked.under[channel]);
                let most = match kind {
                    Kind::Wet => asked.hides,
                    Kind::Dry { .. } => asked.opacity.min(1.0),
                };
                let hides = if asked.hides < most {
                    self.blended(&asked, (&volumes.encoded, under), most)
                } else {
                    asked.hides
                };
                let volume = VolumeCell {
                    palette,
                    encoded: &volumes.encoded,
                    under,
                    hides,
                };
                self.shares(&volume, asked.colour);
                if hides > asked.hides {
                    let part = (hides / asked.opacity).min(1.0);
                    let stays = f64::from(volumes.of.opaque) - asked.all as f64 / part;
                    self.over = stays.max(0.0) as f32;
                }
            }
        }
        whole(&self.found.shares, asked.all, &mut self.counts);
        self.asked = asked;
    }

    /// Opacity of a dry layer, between that of its volume and `most`, with the ground as one of its paints.
    fn blended(
        &mut self,
        asked: &Asked,
        (paints, under): (&[[f64; 3]], [f64; 3]),
        most: f64,
    ) -> f64 {
        let palette = &self.target.palette;
        let encoded: Vec<[f64; 3]> = paints.iter().copied().chain([under]).collect();
        let volume = VolumeCell {
            palette,
            encoded: &encoded,
            under,
            hides: 1.0,
        };
        let own = self.own.iter().map(|share| share * asked.hides);
        let own: Vec<f64> = own.chain([1.0 - asked.hides]).collect();
        let wanted = Wanted {
            colour: asked.colour,
            own: &own,
        };
        self.blender.descend(&volume, wanted, &own, &mut self.other);
        let left = self.other.shares.last().copied().unwrap_or(0.0);
        (1.0 - left).clamp(asked.hides, most)
    }

    /// Fits shares, starting from those of the cell before and from the own ones; where both are far, from a table.
    fn shares(&mut self, colour: &impl CellColour, wanted: [f64; 3]) {
        let wanted = Wanted {
            colour: wanted,
            own: &self.own,
        };
        let has_last = !self.found.shares.is_empty();
        if has_last {
            self.start.clone_from(&self.found.shares);
            self.fitter
                .descend(colour, wanted, &self.start, &mut self.found);
            if self.found.delta_e <= RETRY_DELTA_E {
                return;
            }
        }
        self.fitter
            .descend(colour, wanted, &self.own, &mut self.other);
        if !has_last || self.other.energy < self.found.energy {
            std::mem::swap(&mut self.found, &mut self.other);
        }
        if self.found.delta_e > RETRY_DELTA_E
            && let Some(masstones) = &self.target.masstones
        {
            self.start.resize(self.own.len(), 0.0);
            masstones.nearest(wanted.colour, &mut self.start);
            self.fitter
                .descend(colour, wanted, &self.start, &mut self.other);
            if self.other.energy < self.found.energy {
                std::mem::swap(&mut self.found, &mut self.other);
            }
        }
    }
}
