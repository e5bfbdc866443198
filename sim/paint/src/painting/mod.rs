//! The painting: surfaces, brushes, books. It does what it is told, in the order that it is told.

mod books;
mod loads;
mod strokes;
mod undo;

use std::collections::BTreeMap;

use maulstick_brush::BrushFile;
use maulstick_optics::{PaintError, PaintLibrary, Studio};
use maulstick_types::Mixture;
use maulstick_types::scene::Scene;

use crate::deposit::Deposit;
use crate::head::HeadShape;
use crate::history::History;
use crate::ledger::Ledger;
use crate::load::BrushLoad;
use crate::model::PaintModel;
use crate::path::PathStepper;
use crate::setup::{PaintingSetup, ground_reflectance};
use crate::store::TileStore;
use crate::window::Window;

/// Why something was not done, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}")]
pub struct PaintRefusal {
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub help: String,
}

impl PaintRefusal {
    /// A refusal.
    #[must_use]
    pub fn new(what: String, help: &str) -> Self {
        Self {
            what,
            help: help.to_owned(),
        }
    }

    /// A refusal because of a paint or a mixture.
    #[must_use]
    pub fn paint(error: PaintError) -> Self {
        let help = match &error {
            PaintError::Unknown { .. } => "`maulstick paints` lists them all",
            _ => "write mixtures as \"Cobalt Blue=0.7,Titanium White=0.3\"",
        };
        Self {
            what: error.to_string(),
            help: help.to_owned(),
        }
    }
}

/// A surface: its tiles and what lies under them.
#[derive(Debug)]
struct Sheet {
    id: u32,
    cell_m: f64,
    store: TileStore,
    ground: Vec<f32>,
}

/// A brush as the painting knows it.
struct BrushTrack {
    file: BrushFile,
    shape: HeadShape,
    load: BrushLoad,
    stroke: u64,
    path: Option<(usize, PathStepper)>,
    window: Option<(usize, Window)>,
    loads: Vec<Mixture>,
    next_load: usize,
}

/// A painting.
pub struct Painting {
    scene: Scene,
    library: PaintLibrary,
    studio: Studio,
    sheets: Vec<Sheet>,
    brushes: BTreeMap<String, BrushTrack>,
    model: Box<dyn PaintModel>,
    ledger: Ledger,
    history: History,
    versions: u64,
    steps: u64,
    footprint_cells: u64,
    span_ns: Option<(u64, u64)>,
}

impl Painting {
    /// A new painting.
    ///
    /// # Errors
    /// [`PaintRefusal`] where the setup is wrong.
    pub fn new(setup: &PaintingSetup, library: PaintLibrary) -> Result<Self, PaintRefusal> {
        setup.check(&library)?;
        let scene = setup.scene();
        let studio = Studio::daylight();
        let mut sheets = Vec::new();
        for surface in &scene.surfaces {
            sheets.push(Sheet {
                id: surface.id,
                cell_m: surface.cell_m,
                store: TileStore::new(surface.cells),
                ground: studio.sample(&ground_reflectance(&surface.ground)?),
            });
        }
        Ok(Self {
            scene,
            library,
            studio,
            sheets,
            brushes: BTreeMap::new(),
            model: Box::new(Deposit::default()),
            ledger: Ledger::default(),
            history: History::default(),
            versions: 1,
            steps: 0,
            footprint_cells: 0,
            span_ns: None,
        })
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

    /// The optics of the paints in use.
    #[must_use]
    pub fn studio(&self) -> &Studio {
        &self.studio
    }

    /// Internal reflectance of a surface's ground at the studio's wavelengths.
    #[must_use]
    pub fn ground(&self, surface: u32) -> &[f32] {
        self.sheet(surface).map_or(&[], |sheet| &sheet.ground)
    }

    /// The tiles of a surface.
    #[must_use]
    pub fn store(&self, surface: u32) -> Option<&TileStore> {
        self.sheet(surface).map(|sheet| &sheet.store)
    }

    fn sheet(&self, surface: u32) -> Option<&Sheet> {
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

    /// Introduces a brush, or gives a known one another file; what it carries it keeps. The file
    /// that it has already changes nothing, in the middle of a stroke too.
    pub fn define_brush(&mut self, name: &str, file: BrushFile) {
        if self
            .brushes
            .get(name)
            .is_some_and(|track| track.file == file)
        {
            return;
        }
        let shape = HeadShape::of(&file);
        self.close_windows();
        match self.brushes.get_mut(name) {
            Some(track) => {
                (track.file, track.shape, track.path) = (file, shape, None);
            }
            None => {
                let track = BrushTrack {
                    file,
                    shape,
                    load: BrushLoad::clean(),
                    stroke: 0,
                    path: None,
                    window: None,
                    loads: Vec::new(),
                    next_load: 0,
                };
                self.brushes.insert(name.to_owned(), track);
            }
        }
    }

    /// Whether a brush is known.
    #[must_use]
    pub fn knows_brush(&self, name: &str) -> bool {
        self.brushes.contains_key(name)
    }

    fn brush(&mut self, name: &str) -> Result<&mut BrushTrack, PaintRefusal> {
        let names = self.brushes.keys().cloned().collect::<Vec<_>>().join(", ");
        self.brushes.get_mut(name).ok_or_else(|| {
            PaintRefusal::new(
                format!("there is no brush called '{name}' in this rig"),
                &format!("choose one of: {names}"),
            )
        })
    }

    /// Moves, turns or zooms a surface.
    ///
    /// # Errors
    /// [`PaintRefusal`] for an unknown surface or a bad pose.
    pub fn place(
        &mut self,
        surface: u32,
        pose: &maulstick_types::Pose,
        zoom: f64,
    ) -> Result<(), PaintRefusal> {
        if !pose.is_valid() || !(0.01..=100.0).contains(&zoom) {
            return Err(PaintRefusal::new(
                "the pose or the zoom is out of range".into(),
                "send a finite pose, a unit quaternion and a zoom of .01 to 100",
            ));
        }
        let found = self
            .scene
            .surfaces
            .iter_mut()
            .find(|found| found.id == surface);
        let found = found.ok_or_else(|| {
            PaintRefusal::new(
                format!("there is no surface {surface}"),
                "the canvas is 0, the palette 1",
            )
        })?;
        (found.pose, found.zoom) = (pose.clone(), zoom);
        self.scene.version += 1;
        Ok(())
    }
}

impl std::fmt::Debug for Painting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Painting")
            .field("steps", &self.steps)
            .finish_non_exhaustive()
    }
}
