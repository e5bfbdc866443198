//! Loads of the brushes: loading, cleaning, the loads of a take.

use std::sync::Arc;

use maulstick_canvas::quantum::Counts;
use maulstick_model::brush::load::Half;
use maulstick_optics::THINNER;
use maulstick_types::scene::{Scene, Surface, WellKind};
use maulstick_types::{Mixture, mixture::Part};

use super::PaintingBrush;
use crate::error::BrushError;
use crate::ledger::Ledger;
use crate::painting::backend::deferral::Deferral;
use crate::painting::desk::Desk;
use crate::painting::optics::thinner_slot;

/// Paint to be taken up, by the halves of a head: slots and shares.
type Halves<'a> = [(&'a [(usize, f64)], Half)];

impl PaintingBrush {
    /// Moves its load to the cleaner.
    pub(crate) fn empty(&mut self, ledger: &mut Ledger) {
        self.deferral = Deferral::default();
        let left = Arc::make_mut(&mut self.load).take_all();
        ledger.to_cleaner(&left);
    }

    /// Takes the bend out of it.
    pub(crate) fn reshape(&mut self, scene: &mut Scene) {
        Arc::make_mut(&mut self.load).set.clear();
        scene.give_set(&self.name, &[]);
    }

    /// Fills it from the tubes after it is cleaned; its deferred steps are settled.
    pub(crate) fn fill(&mut self, parts: &Halves<'_>, desk: &Desk, seed: u64, ledger: &mut Ledger) {
        self.empty(ledger);
        let traits = self.traits(desk.surfaces.cell_m());
        let load = Arc::make_mut(&mut self.load);
        for (slots, half) in parts {
            load.fill(
                &self.tidy,
                &traits,
                slots,
                thinner_slot(&desk.scene),
                (*half, seed),
            );
        }
        ledger.from_tube(&load.counts());
    }

    /// Gives it the loads that its next strokes take in turn.
    pub(crate) fn begin_take(&mut self, loads: &[Mixture], cell_m: f64) {
        self.loads = loads.to_vec();
        self.strokes = 0;
        (self.stroke, self.path) = (None, None);
        self.thin_for(cell_m);
    }

    /// Mixture of all paint on it, shares by volume.
    pub(crate) fn mixture(&self, scene: &Scene) -> Result<Mixture, BrushError> {
        mixture_of(&self.load.counts(), scene).ok_or(BrushError::Empty(self.name.clone()))
    }
}

/// The paints of mixtures, each once, without their shares.
pub(crate) fn named(mixtures: &[Mixture]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for part in mixtures.iter().flat_map(|mixture| &mixture.parts) {
        if !names.contains(&part.paint) {
            names.push(part.paint.clone());
        }
    }
    names
}

/// Mixture of the well at a place, m, as filled.
pub(crate) fn well_at(surface: &Surface, at_m: [f64; 2]) -> Option<Mixture> {
    let mut wells = surface.wells.iter();
    let well = wells.find(|well| {
        let [x, y] = [0, 1].map(|i| at_m[i] - well.center_m[i]);
        x * x + y * y < well.radius_m * well.radius_m
    })?;
    match &well.kind {
        WellKind::Paint { mixture } => Some(mixture.clone()),
        WellKind::Medium => Some(Mixture::pure(THINNER)),
        WellKind::Cleaner => None,
    }
}

/// Mixture of counted paint, shares by volume; `None` without paint.
pub(crate) fn mixture_of(counts: &Counts, scene: &Scene) -> Option<Mixture> {
    let total: u64 = counts.iter().sum();
    let counted = scene.paints.iter().zip(counts);
    let parts = counted
        .filter(|(_, count)| **count > 0)
        .map(|(slot, count)| Part {
            paint: slot.name.clone(),
            share: *count as f64 / total as f64,
        });
    (total > 0).then(|| Mixture {
        parts: parts.collect(),
    })
}
