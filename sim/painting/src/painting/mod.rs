//! The painting: surfaces, brushes, ledger. It carries out commands in the order in which they are called.

mod accounting;
mod backend;
mod brush_modes;
mod checkpoint;
mod drying;
mod film;
mod layers;
mod lighting;
mod loads;
mod materials;
mod relaxing;
mod still;
mod strokes;
mod underpainting;
mod undo;
mod versions;
mod wells;
mod wetting;

pub use brush_modes::UnderBrush;
pub use checkpoint::{Checkpoint, Restored};
pub use underpainting::{LaidTile, Wetness};
pub use versions::{NOW, Named};

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_appearance::blank_surface::{
    BlankSurface, CLEANER_RGB, WELL_M, WellLook, well_colour,
};
use maulstick_appearance::ground::Ground;
use maulstick_appearance::light::studio_settings;
use maulstick_brush::{BrushFile, Head};
use maulstick_canvas::EditError;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::window::Window;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::path::PathStepper;
use maulstick_optics::{PaintLibrary, Studio};
use maulstick_types::edits::{Edit, Place};
use maulstick_types::scene::{Scene, Surface, WellKind};
use maulstick_types::{Mixture, name_hash};

use crate::apply::{Applied, Apply};
use crate::clock::Clock;
use crate::error::paint_error;
use crate::history::{History, QUOTA};
use crate::ledger::Ledger;
use crate::models::{ModelEntry, Models, model_called};
use crate::setup::PaintingSetup;
use crate::setup::relief_called;
use backend::{BackendFallback, Deferral};

/// A surface: its tiles, the model of their paint, and the ground under them.
#[derive(Debug)]
struct SurfaceState {
    id: u32,
    cell_m: f64,
    model: &'static ModelEntry,
    store: TileStore,
    bare: Arc<BlankSurface>,
    /// Most quanta that a cell ever had: how high strips may touch.
    top: f32,
}

/// Bits of a seed.
const SEEDS: u64 = 0x7fff_ffff;

/// A brush as the painting knows it.
struct PaintingBrush {
    file: BrushFile,
    /// The brush with as many strips as cells can tell apart.
    thinned: BrushFile,
    /// Its head as its file has it.
    tidy: Arc<Head>,
    /// The same with the disorder of its bristles since the newest stroke began.
    head: Arc<Head>,
    load: Arc<BrushLoad>,
    /// The load that was last saved, and its page.
    kept: Option<(Arc<BrushLoad>, Page<BrushLoad>)>,
    /// Epoch of the brush and number of the newest stroke.
    stroke: Option<(u32, u64)>,
    path: Option<(usize, PathStepper)>,
    window: Option<(usize, Window)>,
    /// Loads that its strokes take in turn.
    loads: Vec<Mixture>,
    /// Strokes since its take began.
    strokes: usize,
    /// Seed of the disorder of its bristles.
    seed: u64,
    /// Surface under it at its newest step.
    under: UnderBrush,
    /// Progress of its deferred steps.
    deferral: Deferral,
}

impl PaintingBrush {
    /// Seed of the disorder of its bristles in its next stroke, and of a load before that.
    fn next_seed(&self) -> u64 {
        (self.strokes as u64 + 1).wrapping_mul(0x9e37_79b1) & SEEDS
    }

    /// Thins it to the strips that cells so wide, m, can tell apart.
    fn thin_for(&mut self, cell_m: f64) {
        let thinned = self.file.thinned(cell_m);
        if thinned == self.thinned {
            return;
        }
        let head = Arc::new(Head::of(&thinned));
        let finer = match head.strips() > self.tidy.strips() {
            true => &head,
            false => &self.tidy,
        };
        self.load = Arc::new(self.load.onto(head.strips(), finer));
        (self.kept, self.thinned, self.tidy) = (None, thinned, head);
        self.head = self.disordered();
    }

    /// The head with its bristles disordered by its seed.
    fn disordered(&self) -> Arc<Head> {
        Arc::new(self.tidy.disordered(self.seed))
    }
}

/// A painting.
pub struct Painting {
    scene: Scene,
    library: PaintLibrary,
    look: Arc<Appearance>,
    sheets: Vec<SurfaceState>,
    embedded: Assets,
    brushes: BTreeMap<String, PaintingBrush>,
    models: Models,
    /// The brush whose newest steps the model has not settled.
    unsettled: Option<String>,
    fall: BackendFallback,
    ledger: Ledger,
    /// The books as far as their changes are booked for a step.
    accounted: Ledger,
    history: History,
    /// Most bytes of the history.
    quota: u64,
    named: BTreeMap<String, Named>,
    /// Versions that came, changed or went since the last checkpoint.
    named_touched: BTreeSet<String>,
    /// The version from which the painter goes on.
    line: Option<String>,
    pager: Arc<Pager>,
    versions: u64,
    steps: u64,
    footprint_cells: u64,
    span_ns: Option<(u64, u64)>,
    clock: Clock,
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
        let settings = studio_settings(&scene.light)?;
        let studio = Studio::new(&settings, library.paints());
        let mut sheets = Vec::new();
        for surface in &scene.surfaces {
            sheets.push(SurfaceState {
                id: surface.id,
                cell_m: surface.cell_m,
                model: model_called(&surface.model)?,
                store: TileStore::paged(surface.cells, &pager),
                bare: Arc::new(bare(surface, &studio, (&library, &setup.embedded), None)?),
                top: 0.0,
            });
        }
        let mut painting = Self {
            scene,
            library,
            look: Arc::new(Appearance::new(studio)),
            sheets,
            embedded: setup.embedded.clone(),
            brushes: BTreeMap::new(),
            models: Models::default(),
            unsettled: None,
            fall: BackendFallback::default(),
            ledger: Ledger::default(),
            accounted: Ledger::default(),
            history: History::default(),
            quota: QUOTA,
            named: BTreeMap::new(),
            named_touched: BTreeSet::new(),
            line: None,
            pager,
            versions: 1,
            steps: 0,
            footprint_cells: 0,
            span_ns: None,
            clock: Clock::default(),
        };
        painting.note_look();
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
        &self.library
    }

    /// Appearance of its paint.
    #[must_use]
    pub fn look(&self) -> &Arc<Appearance> {
        &self.look
    }

    /// A surface without what was painted on it.
    #[must_use]
    pub fn bare(&self, surface: u32) -> Option<&Arc<BlankSurface>> {
        self.sheet(surface).map(|sheet| &sheet.bare)
    }

    /// The tiles of a surface.
    #[must_use]
    pub fn store(&self, surface: u32) -> Option<&TileStore> {
        self.sheet(surface).map(|sheet| &sheet.store)
    }

    fn sheet(&self, surface: u32) -> Option<&SurfaceState> {
        self.sheets.iter().find(|sheet| sheet.id == surface)
    }

    /// Number of the newest tile version.
    #[must_use]
    pub fn versions(&self) -> u64 {
        self.versions
    }

    /// Steps of the paint model and cells of its footprints so far.
    #[must_use]
    pub fn work(&self) -> (u64, u64) {
        (self.steps, self.footprint_cells)
    }

    /// Length of the steps of the present strokes by the brushes' own, the longest: 1, or more where painting is late.
    #[must_use]
    pub fn longer(&self) -> u32 {
        let paths = self
            .brushes
            .values()
            .filter_map(|track| track.path.as_ref());
        paths.map(|(_, path)| path.longer()).max().unwrap_or(1)
    }

    /// Introduces a brush, or gives a known one another file; what it carries it keeps, spread anew
    /// where the other has another number of strips. False where nothing is new.
    pub fn define_brush(&mut self, name: &str, file: BrushFile) -> bool {
        if self
            .brushes
            .get(name)
            .is_some_and(|track| track.file == file)
        {
            return false;
        }
        let thinned = file.thinned(self.sheets[0].cell_m);
        let head = Arc::new(Head::of(&thinned));
        self.close_windows();
        match self.brushes.get_mut(name) {
            Some(track) => {
                if head.strips() != track.head.strips() {
                    track.load = BrushLoad::spread(head.strips(), &track.load.counts()).into();
                }
                (track.file, track.thinned, track.path) = (file, thinned, None);
                track.tidy = head;
                track.head = track.disordered();
            }
            None => {
                let track = PaintingBrush {
                    load: BrushLoad::clean(head.strips()).into(),
                    kept: None,
                    file,
                    thinned,
                    tidy: Arc::clone(&head),
                    head,
                    stroke: None,
                    path: None,
                    window: None,
                    loads: Vec::new(),
                    strokes: 0,
                    seed: 0,
                    under: UnderBrush::default(),
                    deferral: Deferral::default(),
                };
                self.brushes.insert(name.to_owned(), track);
            }
        }
        true
    }

    /// The brush with this hash of its name.
    #[must_use]
    pub fn brush_of(&self, source: u32) -> Option<&str> {
        let mut names = self.brushes.keys();
        names
            .find(|name| name_hash(name) == source)
            .map(String::as_str)
    }

    /// True if a brush is known.
    #[must_use]
    pub fn knows_brush(&self, name: &str) -> bool {
        self.brushes.contains_key(name)
    }

    /// Fullness of the brush with this hash of its name, 0 to 1.
    #[must_use]
    pub fn fullness(&self, source: u32) -> f32 {
        let mut brushes = self.brushes.iter();
        let found = brushes.find(|(name, _)| name_hash(name) == source);
        found.map_or(0.0, |(_, track)| {
            let traits = BrushTraits::of(&track.thinned, self.sheets[0].cell_m, 1.0);
            track.load.fullness(&traits)
        })
    }

    fn brush(&mut self, name: &str) -> Result<&mut PaintingBrush, EditError> {
        let known = match self.brushes.contains_key(name) {
            true => Vec::new(),
            false => self.brushes.keys().cloned().collect(),
        };
        let brush = self.brushes.get_mut(name);
        brush.ok_or_else(|| EditError::NoBrush {
            name: name.to_owned(),
            known,
        })
    }
}

impl Painting {
    /// Applies an edit.
    ///
    /// # Errors
    /// [`EditError`] says why it is refused; then the painting is as it was.
    pub fn apply(&mut self, edit: impl Into<Edit>) -> Result<Applied, EditError> {
        edit.into().apply(self)
    }
}

impl Apply for Place {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let zoom = self.zoom.get();
        Place::new(self.surface, self.pose.clone(), zoom)?;
        painting.surface(self.surface)?;
        let mut surfaces = painting.scene.surfaces.iter_mut();
        if let Some(found) = surfaces.find(|found| found.id == self.surface) {
            (found.pose, found.zoom) = (self.pose.clone(), zoom);
        }
        painting.scene.version += 1;
        Ok(Applied::Done)
    }
}

/// A surface before anything is painted on it; `relief` is that of before, if it is known.
fn bare(
    surface: &Surface,
    studio: &Studio,
    (library, embedded): (&PaintLibrary, &Assets),
    relief: Option<Arc<Relief>>,
) -> Result<BlankSurface, EditError> {
    let ground = Ground::called(&surface.ground, surface.cells, studio, embedded)?;
    let relief = match relief {
        Some(relief) => relief,
        None => {
            let (name, seed) = (&surface.tooth, surface.tooth_seed);
            Arc::new(relief_called(name, seed, surface.cell_m, embedded)?)
        }
    };
    let mut wells = Vec::new();
    for well in &surface.wells {
        let center = well.center_m.map(|m| m / surface.cell_m);
        let radius = well.radius_m / surface.cell_m;
        let WellKind::Paint { mixture } = &well.kind else {
            wells.push(WellLook {
                center,
                radius,
                rgb: CLEANER_RGB,
                height_m: 0.0,
            });
            continue;
        };
        let mixture = library.check(mixture).map_err(paint_error)?;
        let mut mixed = studio.clone();
        let mut shares = Vec::new();
        for part in &mixture.parts {
            let paint = library.find(&part.paint).map_err(paint_error)?;
            shares.push((mixed.add(paint), part.share));
        }
        wells.push(WellLook {
            center,
            radius,
            rgb: well_colour(&mixed, &shares, ground.mean()),
            height_m: WELL_M as f32,
        });
    }
    Ok(BlankSurface {
        ground,
        relief,
        wells,
        shown: model_called(&surface.model)?.shown,
    })
}

impl std::fmt::Debug for Painting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Painting")
            .field("steps", &self.steps)
            .finish_non_exhaustive()
    }
}
