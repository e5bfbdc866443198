//! The painting: surfaces, brushes, history, accounts and optics, and operations on several of them.

mod accounts;
pub(crate) mod brushes;
mod checkpoint;
pub(crate) mod layers;
mod optics;
mod record;
mod restore;
mod still;
mod strokes;
pub(crate) mod surfaces;
pub(crate) mod undo;

pub use brushes::handling::UnderBrush;
pub use checkpoint::Checkpoint;
pub use restore::Restored;
pub use surfaces::underpainting::{LaidTile, Wetness};
pub use undo::versions::{NOW, Named};

use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_appearance::blank_surface::BlankSurface;
use maulstick_brush::BrushFile;
use maulstick_canvas::EditError;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::page::Pager;
use maulstick_canvas::store::TileStore;
use maulstick_optics::PaintLibrary;
use maulstick_types::scene::Scene;

use crate::brush_colour::Carried;
use crate::clock::Clock;
use crate::history::History;
use crate::setup::PaintingSetup;
use accounts::Accounts;
use brushes::Brushes;
use optics::Optics;
use record::RecordState;
use strokes::backend::Backend;
use surfaces::Surfaces;
use undo::versions::Versions;

/// A painting.
pub struct Painting {
    /// The desk as published. Its surfaces are in the order of `surfaces`.
    pub(crate) scene: Scene,
    pub(crate) optics: Optics,
    pub(crate) surfaces: Surfaces,
    pub(crate) brushes: Brushes,
    pub(crate) backend: Backend,
    pub(crate) accounts: Accounts,
    pub(crate) history: History,
    pub(crate) versions: Versions,
    pub(crate) clock: Clock,
    pub(crate) record: RecordState,
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
        let scene = setup.scene();
        let optics = Optics::of(&scene, library, setup.embedded.clone())?;
        let mut painting = Self {
            surfaces: Surfaces::new(&scene, &optics, pager)?,
            scene,
            optics,
            brushes: Brushes::default(),
            backend: Backend::default(),
            accounts: Accounts::default(),
            history: History::default(),
            versions: Versions::default(),
            clock: Clock::default(),
            record: RecordState::default(),
        };
        if setup.exposure.is_none() {
            painting.expose();
        }
        Ok(painting)
    }

    /// The desk.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The paints to choose from.
    #[must_use]
    pub fn library(&self) -> &PaintLibrary {
        &self.optics.library
    }

    /// Appearance of its paint.
    #[must_use]
    pub fn look(&self) -> &Arc<Appearance> {
        &self.optics.look
    }

    /// The pictures and spectra that its grounds and teeth are made of.
    #[must_use]
    pub fn embedded(&self) -> &Assets {
        &self.optics.assets
    }

    /// Adds a picture for a ground or a tooth, and returns its hash.
    ///
    /// # Errors As [`Assets::add`].
    pub fn embed(&mut self, bytes: Arc<[u8]>) -> Result<String, EditError> {
        self.optics.assets.add(bytes)
    }

    /// A surface without its painting.
    #[must_use]
    pub fn bare(&self, surface: u32) -> Option<&Arc<BlankSurface>> {
        self.surfaces.find(surface).map(|found| &found.bare)
    }

    /// The tiles of a surface.
    #[must_use]
    pub fn store(&self, surface: u32) -> Option<&TileStore> {
        self.surfaces.find(surface).map(|found| &found.store)
    }

    /// Name of a surface's paint model.
    #[must_use]
    pub fn model(&self, surface: u32) -> Option<&'static str> {
        self.surfaces.find(surface).map(|found| found.model.name)
    }

    /// Number of the newest tile version.
    #[must_use]
    pub fn versions(&self) -> u64 {
        self.surfaces.newest_version
    }

    /// Numbers tile versions from `least` on.
    pub fn skip_versions(&mut self, least: u64) {
        self.surfaces.newest_version = self.surfaces.newest_version.max(least);
    }

    /// The pages of the painting.
    #[must_use]
    pub fn pager(&self) -> &Arc<Pager> {
        &self.surfaces.pager
    }

    /// Bytes that its tiles, and those of its history, take in memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.surfaces.pager.counts().resident
    }

    /// Number of steps of the paint model and of cells of its footprints so far.
    #[must_use]
    pub fn work(&self) -> (u64, u64) {
        (self.accounts.steps, self.accounts.footprint_cells)
    }

    /// Length of the steps of the present strokes by the brushes' own, the longest: 1, or more where painting is late.
    #[must_use]
    pub fn longer(&self) -> u32 {
        self.brushes.longer()
    }

    /// Defines a brush, or replaces the file of a known one; its load is kept, and spread again where the number of
    /// strips differs. False where nothing is new.
    pub fn define_brush(&mut self, name: &str, file: BrushFile) -> bool {
        if self.brushes.find(name).is_some_and(|own| own.file == file) {
            return false;
        }
        self.close_windows();
        self.brushes.define(name, file, self.surfaces.cell_m());
        true
    }

    /// The brush with this hash of its name.
    #[must_use]
    pub fn brush_of(&self, source: u32) -> Option<&str> {
        self.brushes
            .by_source(source)
            .map(|brush| brush.name.as_str())
    }

    /// Names of its brushes.
    pub fn brushes(&self) -> impl Iterator<Item = &str> {
        self.brushes.iter().map(|brush| brush.name.as_str())
    }

    /// True if a brush is known.
    #[must_use]
    pub fn knows_brush(&self, name: &str) -> bool {
        self.brushes.find(name).is_some()
    }

    /// The newest stroke of the brush with this hash of its name: epoch and number.
    #[must_use]
    pub fn newest_stroke(&self, source: u32) -> Option<(u32, u64)> {
        self.brushes
            .by_source(source)
            .and_then(|brush| brush.stroke)
    }

    /// True if the newest step of the brush with this hash of its name is open, and so covered by none.
    #[must_use]
    pub fn has_open_step(&self, source: u32) -> bool {
        let brush = self.brush_of(source);
        brush.is_some()
            && self
                .history
                .open()
                .any(|step| step.brush.as_deref() == brush)
    }

    /// Fullness of the brush with this hash of its name, 0 to 1.
    #[must_use]
    pub fn fullness(&self, source: u32) -> f32 {
        let brush = self.brushes.by_source(source);
        brush.map_or(0.0, |brush| {
            brush.load.fullness(&brush.traits(self.surfaces.cell_m()))
        })
    }

    /// Paint under the brush with this hash of its name, at its newest step.
    #[must_use]
    pub fn under_brush(&self, source: u32) -> UnderBrush {
        let brush = self.brushes.by_source(source);
        brush.map_or_else(UnderBrush::default, |brush| brush.under)
    }

    /// Load of each brush, by its name: as far as the steps are settled.
    pub fn carried(&self) -> impl Iterator<Item = (&str, Carried)> {
        let cell_m = self.surfaces.cell_m();
        let brushes = self.brushes.iter();
        brushes.map(move |brush| (brush.name.as_str(), brush.carried(cell_m)))
    }

    /// Drops the loads queued for the next strokes of a brush.
    pub fn forget_loads(&mut self, brush: &str) {
        if let Some(brush) = self.brushes.find_mut(brush) {
            brush.loads.clear();
        }
    }

    /// Forgets positions and times of the brushes: the next states begin new paths.
    pub fn lift_brushes(&mut self) {
        self.close_windows();
        self.accounts.span_ns = None;
        self.brushes.iter_mut().for_each(|brush| brush.path = None);
    }
}

impl std::fmt::Debug for Painting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Painting")
            .field("steps", &self.accounts.steps)
            .finish_non_exhaustive()
    }
}
