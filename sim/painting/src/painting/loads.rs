//! Loads of the brushes: slots of paints, loading, cleaning, the loads of a take.

use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_canvas::quantum::SLOTS;
use maulstick_model::brush::load::{Half, by_slot};
use maulstick_model::brush::traits::BrushTraits;
use maulstick_types::Mixture;
use maulstick_types::edits::{Clean, Load, Tune};
use maulstick_types::scene::Scene;

use super::Painting;
use super::backend::Deferral;
use super::lighting::paint_slot;
use crate::apply::{Applied, Apply};
use crate::brush_colour::Carried;
use crate::error::paint_error;

impl Apply for Load {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let brush = self.brush.as_str();
        painting.brush(brush)?;
        let mixtures = std::iter::once(&self.mixture).chain(&self.beside);
        let slots = painting.all_slots(&mixtures.cloned().collect::<Vec<_>>())?;
        painting.begin_step(&format!("load {brush}"), Some(brush));
        let parts: Vec<_> = match &slots[..] {
            [both] => vec![(&both[..], Half::Both)],
            halves => halves
                .iter()
                .map(|slots| &slots[..])
                .zip([Half::Left, Half::Right])
                .collect(),
        };
        let seed = painting.brush(brush)?.next_seed();
        painting.fill(brush, &parts, seed)?;
        painting.book(Some(brush));
        painting.end_step(|step| step.brush.as_deref() == Some(brush));
        Ok(Applied::Done)
    }
}

impl Apply for Clean {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let brush = self.brush.as_str();
        painting.brush(brush)?;
        painting.begin_step(&format!("clean {brush}"), Some(brush));
        let track = painting.brush(brush)?;
        track.deferral = Deferral::default();
        let left = Arc::make_mut(&mut track.load).take_all();
        painting.ledger.to_cleaner(&left);
        painting.book(Some(brush));
        painting.end_step(|step| step.brush.as_deref() == Some(brush));
        Ok(Applied::Done)
    }
}

impl Apply for Tune {
    /// Makes a brush stiffer or softer; who solves it hears of it by the scene.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.brush(&self.brush)?;
        let tunings = &mut painting.scene.tunings;
        tunings.retain(|other| other.brush != self.brush.as_str());
        tunings.push(self.clone().into());
        painting.scene.version += 1;
        Ok(Applied::Done)
    }
}

impl Painting {
    /// The slots of several mixtures; where one is refused no paint gets a slot.
    fn all_slots(&mut self, mixtures: &[Mixture]) -> Result<Vec<Vec<(usize, f64)>>, EditError> {
        let known = (self.scene.paints.clone(), Arc::clone(&self.look));
        let slots: Result<_, _> = mixtures.iter().map(|mixture| self.slots(mixture)).collect();
        if Result::is_err(&slots) {
            (self.scene.paints, self.look) = known;
        }
        slots
    }

    /// The slots of a mixture's paints; new paints get the next free ones.
    pub(super) fn slots(&mut self, mixture: &Mixture) -> Result<Vec<(usize, f64)>, EditError> {
        let mixture = self.library.check(mixture).map_err(paint_error)?;
        let known = |scene: &Scene, name: &str| scene.paints.iter().any(|slot| slot.name == name);
        let mut new = Vec::new();
        for part in &mixture.parts {
            if !known(&self.scene, &part.paint) {
                new.push(self.library.find(&part.paint).map_err(paint_error)?);
            }
        }
        // All or none: a refused mixture changes nothing.
        if self.scene.paints.len() + new.len() > SLOTS {
            let first = &new[SLOTS - self.scene.paints.len()];
            return Err(EditError::TooManyPaints(first.name.clone()));
        }
        for paint in new {
            let look = Arc::make_mut(&mut self.look);
            let slot = paint_slot(&mut look.studio, paint, self.library.hash());
            if paint.is_thinner() {
                look.thinner = Some(self.scene.paints.len());
            }
            self.scene.paints.push(slot);
            self.scene.version += 1;
        }
        let find = |name: &str| {
            self.scene
                .paints
                .iter()
                .position(|slot| slot.name == name)
                .ok_or_else(|| EditError::NoSlot(name.to_owned()))
        };
        by_slot(&mixture, find)
    }

    /// Forgets what the strokes of a brush would load.
    pub fn forget_loads(&mut self, brush: &str) {
        if let Some(track) = self.brushes.get_mut(brush) {
            track.loads.clear();
        }
    }

    pub(super) fn fill(
        &mut self,
        brush: &str,
        parts: &[(&[(usize, f64)], Half)],
        seed: u64,
    ) -> Result<(), EditError> {
        let (cell_m, thinner) = (self.sheets[0].cell_m, self.thinner());
        self.settle();
        let track = self.brush(brush)?;
        track.deferral = Deferral::default();
        let load = Arc::make_mut(&mut track.load);
        let left = load.take_all();
        let traits = BrushTraits::of(&track.thinned, cell_m, 1.0);
        for (slots, half) in parts {
            load.fill(&track.tidy, &traits, slots, thinner, (*half, seed));
        }
        let given = load.counts();
        self.ledger.to_cleaner(&left);
        self.ledger.from_tube(&given);
        Ok(())
    }

    /// Gives a brush the loads that its next strokes take in turn.
    ///
    /// # Errors
    /// [`EditError`] for an unknown brush or paint, or a 17th paint.
    pub fn take(&mut self, brush: &str, loads: &[Mixture]) -> Result<(), EditError> {
        self.brush(brush)?;
        self.all_slots(loads)?;
        self.close_windows();
        let cell_m = self.sheets[0].cell_m;
        let track = self.brush(brush)?;
        track.loads = loads.to_vec();
        (track.strokes, track.seed) = (0, 0);
        track.stroke = None;
        track.path = None;
        track.head = track.disordered();
        track.thin_for(cell_m);
        Ok(())
    }

    /// Load of each brush, by its name: as far as the steps are settled.
    pub fn carried(&self) -> impl Iterator<Item = (&str, Carried)> {
        let cell_m = self.sheets[0].cell_m;
        self.brushes.iter().map(move |(name, track)| {
            let traits = BrushTraits::of(&track.thinned, cell_m, 1.0);
            let carried = Carried {
                load: Arc::clone(&track.load),
                hair: track.file.head.hair,
                film_m: f64::from(traits.film_cells_per_quantum) * cell_m,
                film_full: traits.film_full,
            };
            (name.as_str(), carried)
        })
    }
}
