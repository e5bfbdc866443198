//! Loads of the brushes: loading, cleaning, the loads of a take.

use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_canvas::quantum::Counts;
use maulstick_model::brush::load::Half;
use maulstick_optics::THINNER;
use maulstick_types::scene::{Scene, Surface, WellKind};
use maulstick_types::{Mixture, mixture::Part};

use super::PaintingBrush;
use crate::ledger::Ledger;
use crate::painting::Painting;
use crate::painting::optics::thinner_slot;
use crate::painting::strokes::deferral::Deferral;

/// Paint to be taken up, by the halves of a head: slots and shares.
type Halves<'a> = [(&'a [(usize, f64)], Half)];

impl PaintingBrush {
    /// Moves its load to the cleaner.
    pub(crate) fn empty(&mut self, ledger: &mut Ledger) {
        self.deferral = Deferral::default();
        let left = Arc::make_mut(&mut self.load).take_all();
        ledger.to_cleaner(&left);
    }

    /// Fills it from the tubes after it is cleaned; the scene says which slot is the thinner's.
    fn fill(
        &mut self,
        parts: &Halves<'_>,
        (scene, cell_m): (&Scene, f64),
        seed: u64,
        ledger: &mut Ledger,
    ) {
        self.empty(ledger);
        let traits = self.traits(cell_m);
        let load = Arc::make_mut(&mut self.load);
        for (slots, half) in parts {
            load.fill(
                &self.tidy,
                &traits,
                slots,
                thinner_slot(scene),
                (*half, seed),
            );
        }
        ledger.from_tube(&load.counts());
    }

    /// Mixture of all paint on it, shares by volume.
    fn mixture(&self, scene: &Scene) -> Result<Mixture, EditError> {
        mixture_of(&self.load.counts(), scene).ok_or(EditError::EmptyBrush(self.name.clone()))
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

impl Painting {
    /// Fills a brush from the tubes, once its deferred steps are settled.
    pub(crate) fn fill(&mut self, brush: usize, parts: &Halves<'_>, seed: u64) {
        self.settle();
        let from = (&self.scene, self.surfaces.cell_m());
        self.brushes[brush].fill(parts, from, seed, &mut self.accounts.ledger);
    }

    /// Mixture of all paint on a brush, shares by volume.
    ///
    /// # Errors [`EditError`] for an unknown or empty brush.
    pub(crate) fn carried_mixture(&mut self, brush: &str) -> Result<Mixture, EditError> {
        self.commit();
        let brush = self.brushes.at(brush)?;
        self.brushes[brush].mixture(&self.scene)
    }

    /// Gives a brush the loads for its next strokes in turn.
    ///
    /// # Errors [`EditError`] for an unknown brush or paint, or one paint more than there are slots.
    pub fn take(&mut self, brush: &str, loads: &[Mixture]) -> Result<(), EditError> {
        let brush = self.brushes.at(brush)?;
        self.optics.all_slots(&mut self.scene, loads)?;
        self.close_windows();
        let cell_m = self.surfaces.cell_m();
        let brush = &mut self.brushes[brush];
        brush.loads = loads.to_vec();
        (brush.strokes, brush.seed) = (0, 0);
        (brush.stroke, brush.path) = (None, None);
        brush.head = brush.disordered();
        brush.thin_for(cell_m);
        Ok(())
    }
}
