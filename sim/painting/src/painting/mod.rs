//! The painting: its workbench and its clock.

mod accounts;
pub(crate) mod backend;
pub(crate) mod bench;
pub(crate) mod brushes;
mod checkpoint;
pub(crate) mod desk;
mod drying;
pub(crate) mod optics;
pub(crate) mod past;
mod restore;
mod still;
pub(crate) mod surfaces;
mod underpainting;

pub use brushes::handling::UnderBrush;
pub use checkpoint::Checkpoint;
pub use past::versions::{NOW, Named};
pub use restore::Restored;
pub use underpainting::{LaidTile, Wetness};

use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_appearance::shown_surface::ShownSurface;
use maulstick_brush::BrushFile;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::page::Pager;
use maulstick_canvas::store::TileStore;
use maulstick_model::interface::PaintModel;
use maulstick_optics::PaintLibrary;
use maulstick_types::Mixture;
use maulstick_types::brush::{BrushRelief, BrushState, Solve};
use maulstick_types::paint::{Decision, StepName};
use maulstick_types::scene::{Light, Scene};

use bench::Workbench;
use desk::Desk;

use crate::brush_colour::Carried;
use crate::clock::Clock;
use crate::error::EditError;
use crate::history::History;
use crate::ledger::LedgerReport;
use crate::setup::PaintingSetup;

/// A painting.
pub struct Painting {
    pub(crate) bench: Workbench,
    pub(crate) clock: Clock,
}

impl Painting {
    /// A new painting.
    ///
    /// # Errors
    /// [`EditError`] where the setup is wrong.
    pub fn new(setup: &PaintingSetup, library: PaintLibrary) -> Result<Self, EditError> {
        Self::paged(setup, library, Arc::default())
    }

    /// A new painting whose paint is in these pages.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn paged(
        setup: &PaintingSetup,
        library: PaintLibrary,
        pager: Arc<Pager>,
    ) -> Result<Self, EditError> {
        setup.check(&library)?;
        let mut desk = Desk::new(setup.scene(), library, setup.embedded.clone(), pager)?;
        if setup.exposure.is_none() {
            desk.expose();
        }
        Ok(Self {
            bench: Workbench::new(desk),
            clock: Clock::default(),
        })
    }

    /// The desk.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.bench.desk.scene
    }

    /// The paints to choose from.
    #[must_use]
    pub fn library(&self) -> &PaintLibrary {
        &self.bench.desk.optics.library
    }

    /// Appearance of its paint.
    #[must_use]
    pub fn look(&self) -> &Arc<Appearance> {
        &self.bench.desk.optics.look
    }

    /// The pictures and spectra that its grounds and teeth are made of.
    #[must_use]
    pub fn embedded(&self) -> &Assets {
        &self.bench.desk.optics.assets
    }

    /// Adds a picture for a ground or a tooth, and returns its hash.
    ///
    /// # Errors
    /// As [`Assets::add`].
    pub fn embed(&mut self, bytes: Arc<[u8]>) -> Result<String, EditError> {
        Ok(self.bench.desk.optics.assets.add(bytes)?)
    }

    /// A surface without its painting.
    #[must_use]
    pub fn bare(&self, surface: u32) -> Option<&Arc<ShownSurface>> {
        self.bench
            .desk
            .surfaces
            .find(surface)
            .map(|found| &found.bare)
    }

    /// The tiles of a surface.
    #[must_use]
    pub fn store(&self, surface: u32) -> Option<&TileStore> {
        self.bench
            .desk
            .surfaces
            .find(surface)
            .map(|found| &found.store)
    }

    /// Name of a surface's paint model.
    #[must_use]
    pub fn model(&self, surface: u32) -> Option<&'static str> {
        self.bench
            .desk
            .surfaces
            .find(surface)
            .map(|found| found.model.name)
    }

    /// Number of the newest tile version.
    #[must_use]
    pub fn versions(&self) -> u64 {
        self.bench.desk.surfaces.newest_version
    }

    /// Numbers tile versions from `least` on.
    pub fn skip_versions(&mut self, least: u64) {
        self.bench.desk.surfaces.newest_version =
            self.bench.desk.surfaces.newest_version.max(least);
    }

    /// The pages of the painting.
    #[must_use]
    pub fn pager(&self) -> &Arc<Pager> {
        &self.bench.desk.surfaces.pager
    }

    /// Bytes that its tiles, and those of its history, take in memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.bench.desk.surfaces.pager.counts().resident
    }

    /// Number of steps of the paint model and of cells of its footprints so far.
    #[must_use]
    pub fn work(&self) -> (u64, u64) {
        (
            self.bench.accounts.work.steps,
            self.bench.accounts.work.footprint_cells,
        )
    }

    /// Length of the steps of the present strokes by the brushes' own, the longest: 1, or more where painting is late.
    #[must_use]
    pub fn longer(&self) -> u32 {
        self.bench.brushes.longer()
    }

    /// Defines a brush, or replaces the file of a known one; its load is kept, and spread again where the number of
    /// strips differs. False where nothing is new.
    pub fn define_brush(&mut self, name: &str, file: BrushFile) -> bool {
        if self
            .bench
            .brushes
            .find(name)
            .is_some_and(|own| own.file == file)
        {
            return false;
        }
        self.bench.close_windows();
        self.bench
            .brushes
            .define(name, file, self.bench.desk.surfaces.cell_m());
        true
    }

    /// The brush with this hash of its name.
    #[must_use]
    pub fn brush_of(&self, source: u32) -> Option<&str> {
        self.bench
            .brushes
            .by_source(source)
            .map(|brush| brush.name.as_str())
    }

    /// Names of its brushes.
    pub fn brushes(&self) -> impl Iterator<Item = &str> {
        self.bench.brushes.iter().map(|brush| brush.name.as_str())
    }

    /// True if a brush is known.
    #[must_use]
    pub fn knows_brush(&self, name: &str) -> bool {
        self.bench.brushes.find(name).is_some()
    }

    /// The newest stroke of the brush with this hash of its name: epoch and number.
    #[must_use]
    pub fn newest_stroke(&self, source: u32) -> Option<(u32, u64)> {
        self.bench.brushes.by_source(source)?.stroke
    }

    /// True if the newest step of the brush with this hash of its name is open, and so covered by none.
    #[must_use]
    pub fn has_open_step(&self, source: u32) -> bool {
        let brush = self.brush_of(source);
        let mut open = self.history().open();
        brush.is_some() && open.any(|step| step.brush.as_deref() == brush)
    }

    /// Fullness of the brush with this hash of its name, 0 to 1.
    #[must_use]
    pub fn fullness(&self, source: u32) -> f32 {
        let brush = self.bench.brushes.by_source(source);
        brush.map_or(0.0, |brush| {
            brush
                .load
                .fullness(&brush.traits(self.bench.desk.surfaces.cell_m()))
        })
    }

    /// Paint under the brush with this hash of its name, at its newest step.
    #[must_use]
    pub fn under_brush(&self, source: u32) -> UnderBrush {
        let brush = self.bench.brushes.by_source(source);
        brush.map_or_else(UnderBrush::default, |brush| brush.under)
    }

    /// Load of each brush, by its name: as far as the steps are settled.
    pub fn carried(&self) -> impl Iterator<Item = (&str, Carried)> {
        let cell_m = self.bench.desk.surfaces.cell_m();
        let brushes = self.bench.brushes.iter();
        brushes.map(move |brush| (brush.name.as_str(), brush.carried(cell_m)))
    }

    /// Drops the loads queued for the next strokes of a brush.
    pub fn forget_loads(&mut self, brush: &str) {
        if let Some(brush) = self.bench.brushes.find_mut(brush) {
            brush.loads.clear();
        }
    }

    /// Forgets positions and times of the brushes: the next states begin new paths.
    pub fn lift_brushes(&mut self) {
        self.bench.close_windows();
        self.bench.accounts.work.span_ns = None;
        self.bench
            .brushes
            .iter_mut()
            .for_each(|brush| brush.path = None);
    }

    /// Paints what a brush did in its epoch: strokes are numbered from 1 in each.
    ///
    /// # Errors
    /// [`EditError`] for an unknown brush, or a state that does not fit its brush file.
    pub fn state(&mut self, brush: &str, epoch: u32, state: &BrushState) -> Result<(), EditError> {
        self.bench.state(brush, epoch, state)
    }

    /// Gives a brush the loads that its next strokes take in turn.
    ///
    /// # Errors
    /// [`EditError`] for an unknown brush or paint, or one paint more than there are slots.
    pub fn take(&mut self, brush: &str, loads: &[Mixture]) -> Result<(), EditError> {
        let brush = self.bench.brushes.at(brush)?;
        self.bench.desk.all_slots(loads)?;
        self.bench.close_windows();
        let cell_m = self.bench.desk.surfaces.cell_m();
        self.bench.brushes[brush].begin_take(loads, cell_m);
        Ok(())
    }

    /// Changes the light, without choosing the exposure anew.
    ///
    /// # Errors
    /// [`EditError`] for an invalid light.
    pub fn relight(&mut self, light: &Light) -> Result<(), EditError> {
        self.bench.desk.relight(light)
    }

    /// Writes what the windows hold back to the tiles.
    pub fn commit(&mut self) {
        self.bench.commit();
    }

    /// Balances the books.
    pub fn report(&mut self) -> LedgerReport {
        self.commit();
        let Workbench {
            desk,
            brushes,
            backend,
            accounts,
            ..
        } = &mut self.bench;
        accounts.report(brushes, desk, backend)
    }

    /// Relief below a brush as it was solved; none for a brush far from the surface, or one that is not known.
    #[must_use]
    pub fn relief_below(&self, brush: &str, solve: &Solve) -> Option<BrushRelief> {
        let brush = self.bench.brushes.find(brush)?;
        self.bench.desk.relief_below(brush.file.length_m(), solve)
    }

    /// Has the steps of surfaces with a model of this name computed by this one from now on.
    pub fn set_model(&mut self, model: Box<dyn PaintModel>) {
        self.bench.close_windows();
        self.bench.backend.models.replace(model);
    }

    /// Backend of the steps on its canvas: `cpu`, or `gpu` and the adapter's name.
    #[must_use]
    pub fn backend(&self) -> String {
        let canvas = &self.bench.desk.surfaces[0];
        self.bench.backend.models.backend(canvas.model)
    }

    /// The reason why its backend changed, returned once, after the stroke in which it changed.
    pub fn take_backend_change(&mut self) -> Option<String> {
        self.bench.backend.take_backend_change()
    }

    /// A limit that its backend has met, returned once, after the stroke in which it did.
    pub fn take_limit(&mut self) -> Option<Decision> {
        self.bench.backend.take_limit()
    }

    /// A sixtieth of a second goes by.
    pub fn tick(&mut self) {
        for (surface, round) in self.clock.tick(self.bench.brushes.in_contact()) {
            let mut dryings = self.clock.dryings.iter();
            let Some(place) = dryings.position(|it| it.surface == surface) else {
                continue;
            };
            if self.clock.dryings[place].go_on(round, &mut self.bench) {
                self.clock.dryings.remove(place);
                if !self.is_drying() {
                    self.bench.end_own_step();
                }
            }
        }
    }

    /// True while time is to advance: something dries.
    #[must_use]
    pub fn is_drying(&self) -> bool {
        !self.clock.dryings.is_empty()
    }

    /// The dryings that go on, and the ticks so far.
    #[must_use]
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// Notes that a brush did something: whether it is in contact says whether paint may dry.
    pub(crate) fn note_contact(&mut self, brush: &str) {
        let brush = self.bench.brushes.find(brush);
        if brush.is_some_and(|own| own.path.is_some()) {
            self.clock.quiet = 0;
        }
    }

    /// Undoes the newest step, of a brush or of all, and returns its name.
    ///
    /// # Errors
    /// [`EditError`] if there is no step, or something was painted over it since: then nothing has changed.
    pub fn undo(&mut self, brush: Option<&str>) -> Result<StepName, EditError> {
        self.bench.undo(&mut self.clock, brush)
    }

    /// Takes back all steps of a brush that came after the one with this number.
    ///
    /// # Errors
    /// As [`undo`](Self::undo).
    pub fn undo_to(&mut self, brush: &str, step: u64) -> Result<(), EditError> {
        self.bench.undo_to(&mut self.clock, brush, step)
    }

    /// Does the newest undone step again, of a brush or of all, and says what it was.
    ///
    /// # Errors
    /// As [`undo`](Self::undo).
    pub fn redo(&mut self, brush: Option<&str>) -> Result<StepName, EditError> {
        self.bench.redo(&mut self.clock, brush)
    }

    /// Undoes or redoes steps until the one of this number is the newest that is done, 0 for none, and returns its
    /// name.
    ///
    /// # Errors
    /// [`EditError`] for an unknown step, and where something was painted over one on the way: then nothing has changed.
    pub fn go_to(&mut self, step: u64) -> Result<StepName, EditError> {
        self.bench.go_to(&mut self.clock, step)
    }

    /// The newest step that is done; steps that end later have higher numbers.
    pub fn newest_step(&mut self) -> u64 {
        self.bench.newest_step()
    }

    /// The steps of the past.
    #[must_use]
    pub fn history(&self) -> &History {
        &self.bench.past.history
    }

    /// Numbers of steps that can be undone and redone.
    #[must_use]
    pub fn history_depth(&self) -> (usize, usize) {
        self.history().depth()
    }

    /// Steps up to this one and later ones are never merged with each other.
    pub fn part_history(&mut self, step: u64) {
        self.bench.past.history.part_at(step);
    }

    /// Forgets all steps: nothing of before can be undone.
    pub fn forget_history(&mut self) {
        self.bench.end_step(|_| true);
        self.bench.past.history.forget();
        self.break_record();
    }

    /// Merges the oldest steps until all pages take so many bytes in memory, or only the newest steps are apart: for a
    /// painting whose new pages no document holds.
    pub fn merge_history(&mut self, resident: usize) {
        while self.bytes() > resident && self.bench.past.history.merge_oldest() {}
    }

    /// Limit of the history, bytes; beyond that its oldest steps are merged.
    pub fn set_quota(&mut self, bytes: u64) {
        let Workbench { desk, past, .. } = &mut self.bench;
        past.history.quota = bytes;
        past.keep_to_quota(&desk.surfaces);
    }

    /// Keeps the painting as a version.
    ///
    /// # Errors
    /// [`EditError`] where there is a version of that name.
    pub fn keep(&mut self, name: &str) -> Result<(), EditError> {
        self.bench.keep(name)
    }

    /// The versions, by name.
    pub fn named(&self) -> impl Iterator<Item = &Named> {
        self.bench.past.versions.iter()
    }

    /// The version from which the painter goes on.
    #[must_use]
    pub fn line(&self) -> Option<&str> {
        self.bench.past.versions.line.as_deref()
    }
}

impl std::fmt::Debug for Painting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Painting")
            .field("steps", &self.bench.accounts.work.steps)
            .finish_non_exhaustive()
    }
}
