//! Brushes: their heads, loads and paths.

pub(crate) mod handling;
pub(crate) mod loads;
mod snapshot;

use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use maulstick_brush::{BrushFile, Head};
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::window::Window;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::{BrushTraits, TEXELS_PER_STRIP};
use maulstick_model::path::PathStepper;
use maulstick_types::scene::Scene;
use maulstick_types::{Mixture, name_hash};

use handling::UnderBrush;

use super::backend::deferral::Deferral;
use crate::brush_colour::Carried;
use crate::error::BrushError;

/// Distance along a stroke between regroupings of its bristles, m: the rim strays by a fifth of a millimetre in it, all
/// others by less.
const REGROUP_M: f64 = 0.5e-3;
/// Bits of a seed.
const SEEDS: u64 = 0x7fff_ffff;

/// Seed of the disorder of bristles in the painting's stroke with this number, from 1 on, and of a load before it.
pub(crate) fn seed_of(stroke: u64) -> u64 {
    stroke.wrapping_mul(0x9e37_79b1) & SEEDS
}

/// State of a brush in the painting.
pub(crate) struct PaintingBrush {
    pub(crate) name: String,
    pub(crate) file: BrushFile,
    /// The brush with the strips that cells can resolve.
    pub(crate) thinned: BrushFile,
    /// Its head without disorder.
    pub(crate) tidy: Arc<Head>,
    /// The same with the disorder of its bristles since the newest stroke began.
    pub(crate) head: Arc<Head>,
    pub(crate) load: Arc<BrushLoad>,
    /// The load that was last saved, and its page.
    kept: Option<(Arc<BrushLoad>, Page<BrushLoad>)>,
    /// Epoch of the brush and number of the newest stroke.
    pub(crate) stroke: Option<(u32, u64)>,
    /// Index of the surface, and path, while it is in contact.
    pub(crate) path: Option<(usize, PathStepper)>,
    /// Index of a surface, and the tiles of it that the brush works on.
    pub(crate) window: Option<(usize, Window)>,
    /// Loads that its strokes take in turn.
    pub(crate) loads: Vec<Mixture>,
    /// Strokes since its take began.
    pub(crate) strokes: usize,
    /// Seed of the disorder of its bristles.
    pub(crate) seed: u64,
    /// Length of its newest stroke, and that at the last regrouping of its bristles, m.
    pub(crate) way_m: [f64; 2],
    /// Surface under it at its newest step.
    pub(crate) under: UnderBrush,
    /// Progress of its deferred steps.
    pub(crate) deferral: Deferral,
}

impl PaintingBrush {
    /// A clean brush, thinned to the strips that cells of `cell_m` can resolve.
    fn new(name: &str, file: BrushFile, cell_m: f64) -> Self {
        let thinned = file.thinned(cell_m);
        let tidy = Arc::new(Head::of(&thinned));
        Self {
            name: name.to_owned(),
            load: BrushLoad::clean(tidy.strips()).into(),
            kept: None,
            file,
            thinned,
            head: Arc::clone(&tidy),
            tidy,
            stroke: None,
            path: None,
            window: None,
            loads: Vec::new(),
            strokes: 0,
            seed: 0,
            way_m: [0.0; 2],
            under: UnderBrush::default(),
            deferral: Deferral::default(),
        }
    }

    /// Replaces its file; its load is spread again where that has another number of strips.
    fn set_file(&mut self, file: BrushFile, cell_m: f64) {
        let thinned = file.thinned(cell_m);
        let head = Arc::new(Head::of(&thinned));
        if head.strips() != self.head.strips() {
            let film_full = BrushTraits::of(&thinned, cell_m, 1.0).film_full;
            let counts = self.load.counts();
            self.load = BrushLoad::spread(head.strips(), &counts, film_full).into();
        }
        if self.file != file {
            Arc::make_mut(&mut self.load).set.clear();
        }
        (self.file, self.thinned, self.path) = (file, thinned, None);
        self.tidy = head;
        self.head = self.disordered();
    }

    /// Its traits on cells of `cell_m`, without zoom.
    pub(crate) fn traits(&self, cell_m: f64) -> BrushTraits {
        BrushTraits::of(&self.thinned, cell_m, 1.0)
    }

    /// Its load, for pictures.
    pub(crate) fn carried(&self, cell_m: f64) -> Carried {
        let traits = self.traits(cell_m);
        Carried {
            load: Arc::clone(&self.load),
            hair: self.file.head.hair,
            film_m: f64::from(traits.film_cells_per_quantum) * cell_m,
            film_full: traits.film_full,
            full_load: traits.full_load(self.head.strips()),
        }
    }

    /// Disorders its bristles for the painting's stroke with this number.
    pub(crate) fn disorder(&mut self, stroke: u64) {
        self.seed = seed_of(stroke);
        self.way_m = [0.0; 2];
        self.head = self.disordered();
        Arc::make_mut(&mut self.load).disorder(self.seed);
    }

    /// Regroups its bristles if it has moved far enough since they last did; true if they did.
    pub(crate) fn regroup(&mut self) -> bool {
        let [way, last] = &mut self.way_m;
        if *way - *last < REGROUP_M {
            return false;
        }
        *last = *way;
        self.head = self.disordered();
        true
    }

    /// Thins it to the strips that cells of `cell_m` can resolve.
    pub(crate) fn thin_for(&mut self, cell_m: f64) {
        let thinned = self.file.thinned(cell_m);
        if thinned == self.thinned {
            return;
        }
        let head = Arc::new(Head::of(&thinned));
        let finer = if head.strips() > self.tidy.strips() {
            &head
        } else {
            &self.tidy
        };
        self.load = Arc::new(self.load.onto(head.strips(), finer));
        (self.kept, self.thinned, self.tidy) = (None, thinned, head);
        self.head = self.disordered();
    }

    /// The head with its bristles disordered by its seed.
    pub(crate) fn disordered(&self) -> Arc<Head> {
        Arc::new(self.tidy.disordered(self.seed, self.way_m[1]))
    }

    /// The page of its load; a new one where the load has changed since the last.
    fn load_page(&mut self, pager: &Arc<Pager>) -> Page<BrushLoad> {
        let kept = self.kept.as_ref();
        if let Some((_, page)) = kept.filter(|(content, _)| Arc::ptr_eq(content, &self.load)) {
            return page.clone();
        }
        let page = Page::new(pager, Arc::clone(&self.load), kept.map(|(_, page)| page));
        self.kept = Some((Arc::clone(&self.load), page.clone()));
        page
    }

    /// True if it carries the load of a page.
    pub(crate) fn carries(&self, page: &Page<BrushLoad>) -> bool {
        let kept = self.kept.as_ref();
        kept.is_some_and(|(load, kept)| kept.is(page) && Arc::ptr_eq(load, &self.load))
            || self.load.counts() == page.get().counts()
    }

    /// Replaces its load by that of a page, and gives it the bend of that in a scene.
    pub(crate) fn carry(&mut self, page: &Page<BrushLoad>, scene: &mut Scene) {
        let load = page.get();
        if load.set != self.load.set {
            scene.give_set(&self.name, &load.set);
        }
        self.path = None;
        self.deferral = Deferral::default();
        if load.texels() != self.load.texels() {
            let thinned = self.file.thinned_to(load.texels() / TEXELS_PER_STRIP);
            let head = Head::of(&thinned);
            if head.strips() * TEXELS_PER_STRIP != load.texels() {
                self.load = Arc::new(load.onto(self.tidy.strips(), &self.tidy));
                self.kept = None;
                return;
            }
            (self.thinned, self.tidy) = (thinned, Arc::new(head));
            self.head = self.disordered();
        }
        self.load = Arc::clone(&load);
        self.kept = Some((load, page.clone()));
    }
}

/// The brushes of a painting, in the order of their names.
#[derive(Default)]
pub(crate) struct Brushes(Vec<PaintingBrush>);

impl Brushes {
    fn place(&self, name: &str) -> Result<usize, usize> {
        self.0
            .binary_search_by(|brush| brush.name.as_str().cmp(name))
    }

    /// Index of a brush; it holds until another brush is defined.
    pub(crate) fn at(&self, name: &str) -> Result<usize, BrushError> {
        self.place(name).map_err(|_| BrushError::Unknown {
            name: name.to_owned(),
            known: self.iter().map(|brush| brush.name.clone()).collect(),
        })
    }

    /// A brush by its name.
    pub(crate) fn find(&self, name: &str) -> Option<&PaintingBrush> {
        self.place(name).ok().map(|place| &self.0[place])
    }

    /// A brush by its name.
    pub(crate) fn find_mut(&mut self, name: &str) -> Option<&mut PaintingBrush> {
        self.place(name).ok().map(|place| &mut self.0[place])
    }

    /// The brush with this hash of its name.
    pub(crate) fn by_source(&self, source: u32) -> Option<&PaintingBrush> {
        self.iter().find(|brush| name_hash(&brush.name) == source)
    }

    /// Name of a brush, or of none.
    pub(crate) fn name(&self, brush: Option<usize>) -> Option<&str> {
        brush.map(|brush| self.0[brush].name.as_str())
    }

    /// Defines a brush, or replaces the file of a known one.
    pub(crate) fn define(&mut self, name: &str, file: BrushFile, cell_m: f64) {
        match self.place(name) {
            Ok(place) => self.0[place].set_file(file, cell_m),
            Err(place) => self.0.insert(place, PaintingBrush::new(name, file, cell_m)),
        }
    }

    /// The pages of their loads, by name.
    pub(crate) fn load_pages(&mut self, pager: &Arc<Pager>) -> BTreeMap<String, Page<BrushLoad>> {
        let brushes = self.iter_mut();
        brushes
            .map(|brush| (brush.name.clone(), brush.load_page(pager)))
            .collect()
    }

    /// True if any is in contact.
    pub(crate) fn in_contact(&self) -> bool {
        self.iter().any(|brush| brush.path.is_some())
    }

    /// Length of the steps of the present strokes by the brushes' own, the longest.
    pub(crate) fn longer(&self) -> u32 {
        let paths = self.iter().filter_map(|brush| brush.path.as_ref());
        paths.map(|(_, path)| path.longer()).max().unwrap_or(1)
    }
}

impl Deref for Brushes {
    type Target = [PaintingBrush];

    fn deref(&self) -> &[PaintingBrush] {
        &self.0
    }
}

impl DerefMut for Brushes {
    fn deref_mut(&mut self) -> &mut [PaintingBrush] {
        &mut self.0
    }
}
