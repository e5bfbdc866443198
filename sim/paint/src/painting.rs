//! The painting: surfaces, brushes, books. It does what it is told, in the order that it is told.

use std::collections::BTreeMap;

use maulstick_brush::BrushFile;
use maulstick_optics::{PaintError, PaintLibrary, Studio};
use maulstick_types::Mixture;
use maulstick_types::brush::{BrushState, Solve, solve_flags};
use maulstick_types::scene::{CANVAS, PALETTE, PaintSlot, Scene};

use crate::deposit::Deposit;
use crate::head::{HeadShape, Waypoint};
use crate::history::{History, Rest, UndoStep};
use crate::ledger::{Ledger, LedgerReport, Stocks, Tallies, balance};
use crate::load::{BrushLoad, by_slot, head_cells};
use crate::model::{PaintModel, Step};
use crate::path::{PathStepper, Sweep};
use crate::quantum::{SLOTS, add, quantum_m3};
use crate::setup::{PaintingSetup, ground_reflectance};
use crate::store::TileStore;
use crate::tile::Version;
use crate::window::Window;

/// A window reaches this many cells beyond the head, so that it is not opened anew at each step.
const WINDOW_MARGIN: i64 = 32;

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

    /// Introduces a brush, or gives a known one another file; what it carries it keeps.
    pub fn define_brush(&mut self, name: &str, file: BrushFile) {
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

    /// The slots of a mixture's paints; new paints get the next free ones.
    fn slots(&mut self, mixture: &Mixture) -> Result<Vec<(usize, f64)>, PaintRefusal> {
        let mixture = self.library.check(mixture).map_err(PaintRefusal::paint)?;
        for part in &mixture.parts {
            if self.scene.paints.iter().any(|slot| slot.name == part.paint) {
                continue;
            }
            if self.scene.paints.len() == SLOTS {
                return Err(PaintRefusal::new(
                    format!(
                        "'{}' would be paint {} of this painting",
                        part.paint,
                        SLOTS + 1
                    ),
                    "a painting has at most 16 paints: mix it from those in use",
                ));
            }
            let paint = self
                .library
                .find(&part.paint)
                .map_err(PaintRefusal::paint)?;
            let slot = self.studio.add(paint);
            let black = vec![0.0; self.studio.wavelengths()];
            let opaque = |films: &[(usize, f64)]| {
                self.studio
                    .colour(films, &black)
                    .map(|channel| channel as f32)
            };
            // A tint is one part in ten of the strongest white's scattering.
            let masstone = opaque(&[(slot, 0.01)]);
            let white = self.studio.sample(&maulstick_optics::Spectrum::flat(0.9));
            let tint = self
                .studio
                .colour(&[(slot, 1e-5)], &white)
                .map(|channel| channel as f32);
            let file_hash = self.library.hash();
            let name = part.paint.clone();
            self.scene.paints.push(PaintSlot {
                name,
                masstone,
                tint,
                file_hash,
            });
            self.scene.version += 1;
        }
        let find = |name: &str| {
            self.scene
                .paints
                .iter()
                .position(|slot| slot.name == name)
                .ok_or_else(|| PaintRefusal::new(format!("'{name}' has no slot"), "load it first"))
        };
        by_slot(&mixture, find)
    }

    /// Loads a brush afresh.
    ///
    /// # Errors
    /// [`PaintRefusal`] for an unknown brush or paint, or a 17th paint.
    pub fn load(&mut self, brush: &str, mixture: &Mixture) -> Result<(), PaintRefusal> {
        self.brush(brush)?;
        let slots = self.slots(mixture)?;
        self.begin_step(&format!("load {brush}"));
        self.fill(brush, &slots)?;
        self.history.end();
        Ok(())
    }

    fn fill(&mut self, brush: &str, slots: &[(usize, f64)]) -> Result<(), PaintRefusal> {
        let cell_m = self.sheets[0].cell_m;
        let track = self.brush(brush)?;
        let left = track.load.take_all();
        let file = track.file.clone();
        let given = track.load.fill(&file, slots, cell_m);
        self.ledger.to_cleaner(&left);
        self.ledger.from_tube(&given);
        Ok(())
    }

    /// Takes all paint off a brush.
    ///
    /// # Errors
    /// [`PaintRefusal`] for an unknown brush.
    pub fn clean(&mut self, brush: &str) -> Result<(), PaintRefusal> {
        self.brush(brush)?;
        self.begin_step(&format!("clean {brush}"));
        let left = self.brush(brush)?.load.take_all();
        self.ledger.to_cleaner(&left);
        self.history.end();
        Ok(())
    }

    /// Gives a brush the loads that its next strokes take in turn.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn take(&mut self, brush: &str, loads: &[Mixture]) -> Result<(), PaintRefusal> {
        self.brush(brush)?;
        for mixture in loads {
            self.slots(mixture)?;
        }
        self.close_windows();
        let track = self.brush(brush)?;
        track.loads = loads.to_vec();
        track.next_load = 0;
        track.stroke = 0;
        track.path = None;
        Ok(())
    }

    /// Paints what a brush did.
    ///
    /// # Errors
    /// [`PaintRefusal`] for an unknown brush, or a state that does not fit its brush file.
    pub fn state(&mut self, brush: &str, state: &BrushState) -> Result<(), PaintRefusal> {
        for solve in &state.solves {
            self.solve(brush, solve)?;
        }
        Ok(())
    }

    fn solve(&mut self, name: &str, solve: &Solve) -> Result<(), PaintRefusal> {
        let track = self.brush(name)?;
        if !track.shape.fits(solve) || !solve.pose.is_valid() {
            return Err(PaintRefusal::new(
                format!("a state of brush '{name}' does not fit its brush file"),
                "restart the brush node: it runs with another file",
            ));
        }
        let (first, last) = self.span_ns.unwrap_or((solve.event_ns, solve.event_ns));
        self.span_ns = Some((first, last.max(solve.event_ns)));
        let Some(sheet) = self
            .sheets
            .iter()
            .position(|sheet| sheet.id == solve.surface)
        else {
            return Ok(());
        };
        let track = self.brush(name)?;
        if solve.stroke == 0 {
            track.path = None;
            return Ok(());
        }
        if solve.stroke != track.stroke {
            track.stroke = solve.stroke;
            track.path = None;
            self.begin_stroke(name)?;
        }
        let cell_m = self.sheets[sheet].cell_m;
        let track = self.brush(name)?;
        let waypoint = Waypoint::of(solve);
        let restarted = solve.flags & solve_flags::RESTARTED != 0;
        match track
            .path
            .take()
            .filter(|(on, _)| *on == sheet && !restarted)
        {
            None => {
                let path = PathStepper::begin(&track.shape, waypoint, cell_m);
                track.path = Some((sheet, path));
            }
            Some((_, mut path)) => {
                let shape = track.shape.clone();
                path.advance(&shape, waypoint, |sweep| self.step(name, sheet, sweep));
                if let Some(track) = self.brushes.get_mut(name) {
                    track.path = Some((sheet, path));
                }
            }
        }
        Ok(())
    }

    fn begin_stroke(&mut self, name: &str) -> Result<(), PaintRefusal> {
        self.begin_step("stroke");
        let track = self.brush(name)?;
        if track.loads.is_empty() {
            return Ok(());
        }
        let mixture = track.loads[track.next_load % track.loads.len()].clone();
        track.next_load += 1;
        let slots = self.slots(&mixture)?;
        self.fill(name, &slots)
    }

    /// One step of the paint model.
    fn step(&mut self, name: &str, sheet: usize, sweep: Sweep<'_>) {
        self.steps += 1;
        let (from, to) = sweep.to.bounds();
        if !self.reach(name, sheet, from, to) {
            return;
        }
        let Some(track) = self.brushes.get_mut(name) else {
            return;
        };
        let Some((_, window)) = &mut track.window else {
            return;
        };
        let cell_m = self.sheets[sheet].cell_m;
        let report = self.model.step(&mut Step {
            window,
            cells: self.sheets[sheet].store.cells(),
            cell_m,
            sweep,
            load: &mut track.load,
            head_cells: head_cells(&track.file, cell_m),
        });
        self.footprint_cells += report.footprint_cells;
    }

    /// Makes sure that the brush's window holds the cells `from`..`to`; false where they all lie
    /// beside the surface.
    fn reach(&mut self, name: &str, sheet: usize, from: [i64; 2], to: [i64; 2]) -> bool {
        let Some(needed) = self.sheets[sheet].store.around(from, to) else {
            return false;
        };
        let Some(track) = self.brushes.get(name) else {
            return false;
        };
        if let Some((on, window)) = &track.window
            && *on == sheet
            && window.rect().holds(&needed)
        {
            return true;
        }
        let wide = |edge: [i64; 2], by: i64| edge.map(|cell| cell + by);
        let rect = self.sheets[sheet]
            .store
            .around(wide(from, -WINDOW_MARGIN), wide(to, WINDOW_MARGIN))
            .unwrap_or(needed);
        self.close_window(name);
        let window = Window::open(&mut self.sheets[sheet].store, rect).or_else(|| {
            // Another brush holds some of these tiles: its paint is written back first.
            self.close_windows();
            Window::open(&mut self.sheets[sheet].store, rect)
        });
        let opened = window.is_some();
        if let Some(track) = self.brushes.get_mut(name) {
            track.window = window.map(|window| (sheet, window));
        }
        opened
    }

    /// Writes what the windows hold back to the tiles.
    pub fn commit(&mut self) {
        for track in self.brushes.values_mut() {
            if let Some((sheet, window)) = &mut track.window {
                let sheet = &mut self.sheets[*sheet];
                let (id, history) = (sheet.id, &mut self.history);
                window.commit(&mut sheet.store, &mut self.versions, |tile, version| {
                    history.replaced((id, tile), version);
                });
            }
        }
    }

    fn close_window(&mut self, name: &str) {
        self.commit();
        if let Some(track) = self.brushes.get_mut(name)
            && let Some((sheet, window)) = track.window.take()
        {
            window.close(&mut self.sheets[sheet].store);
        }
    }

    fn close_windows(&mut self) {
        self.commit();
        for track in self.brushes.values_mut() {
            if let Some((sheet, window)) = track.window.take() {
                window.close(&mut self.sheets[sheet].store);
            }
        }
    }

    fn rest(&self) -> Rest {
        let loads = self
            .brushes
            .iter()
            .map(|(name, track)| (name.clone(), track.load.clone()));
        Rest {
            loads: loads.collect(),
            ledger: self.ledger.clone(),
        }
    }

    fn begin_step(&mut self, what: &str) {
        self.close_windows();
        let rest = self.rest();
        self.history.begin(what, rest);
    }

    /// Takes the newest step back and says what it was.
    ///
    /// # Errors
    /// [`PaintRefusal`] where there is none.
    pub fn undo(&mut self) -> Result<String, PaintRefusal> {
        self.close_windows();
        let step = self.history.take_undo().ok_or_else(|| {
            PaintRefusal::new("there is nothing to undo".into(), "paint something first")
        })?;
        let what = step.what.clone();
        let swapped = self.swap(step);
        self.history.push_redo(swapped);
        Ok(what)
    }

    /// Does the newest undone step again and says what it was.
    ///
    /// # Errors
    /// [`PaintRefusal`] where there is none.
    pub fn redo(&mut self) -> Result<String, PaintRefusal> {
        self.close_windows();
        let step = self.history.take_redo().ok_or_else(|| {
            PaintRefusal::new(
                "there is nothing to redo".into(),
                "only what was undone and not painted over can be redone",
            )
        })?;
        let what = step.what.clone();
        let swapped = self.swap(step);
        self.history.push_undo(swapped);
        Ok(what)
    }

    /// Exchanges a step's versions and loads with those of now.
    fn swap(&mut self, step: UndoStep) -> UndoStep {
        let rest = self.rest();
        let mut tiles = BTreeMap::new();
        for ((surface, id), version) in step.tiles {
            let Some(sheet) = self.sheets.iter_mut().find(|sheet| sheet.id == surface) else {
                continue;
            };
            self.versions += 1;
            let restored = Version {
                number: self.versions,
                tile: version.tile,
            };
            tiles.insert((surface, id), sheet.store.replace(id, restored));
        }
        for (name, load) in step.rest.loads {
            if let Some(track) = self.brushes.get_mut(&name) {
                track.load = load;
                track.path = None;
            }
        }
        self.ledger = step.rest.ledger;
        UndoStep {
            what: step.what,
            tiles,
            rest,
        }
    }

    /// How many steps can be undone and redone.
    #[must_use]
    pub fn history_depth(&self) -> (usize, usize) {
        self.history.depth()
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

    /// Bytes that the tiles take.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.sheets.iter().map(|sheet| sheet.store.bytes()).sum()
    }

    /// Balances the books.
    pub fn report(&mut self) -> LedgerReport {
        self.commit();
        let mut stocks = Stocks::default();
        for track in self.brushes.values() {
            add(&mut stocks.brush, track.load.counts());
        }
        let mut covered_cells = 0;
        for sheet in &self.sheets {
            match sheet.id {
                CANVAS => {
                    add(&mut stocks.canvas, &sheet.store.counts());
                    covered_cells += covered(&sheet.store);
                }
                PALETTE => add(&mut stocks.palette, &sheet.store.counts()),
                _ => {}
            }
        }
        let names: Vec<String> = self
            .scene
            .paints
            .iter()
            .map(|slot| slot.name.clone())
            .collect();
        let (first, last) = self.span_ns.unwrap_or_default();
        let tallies = Tallies {
            steps: self.steps,
            footprint_cells: self.footprint_cells,
            covered_cells,
            seconds: (last - first) as f64 * 1e-9,
        };
        balance(
            &self.ledger,
            &stocks,
            &names,
            quantum_m3(self.sheets[0].cell_m),
            tallies,
        )
    }
}

/// Cells with paint.
fn covered(store: &TileStore) -> u64 {
    let mut count = 0;
    for tile in store
        .iter()
        .filter_map(|(_, version)| version.tile.as_ref())
    {
        let cells = tile.wet().first().map_or(0, |(_, plane)| plane.len());
        count += (0..cells)
            .filter(|cell| tile.wet().iter().any(|(_, plane)| plane[*cell] > 0.0))
            .count() as u64;
    }
    count
}

impl std::fmt::Debug for Painting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Painting")
            .field("steps", &self.steps)
            .finish_non_exhaustive()
    }
}
