//! The interface of paint models: one step of a brush on a surface, and the paint at rest after a stroke.

use maulstick_brush::head::{Head, HeadPose};
use maulstick_canvas::own_plane::OwnPlane;
use maulstick_canvas::quantum::{BySlot, CELL_MAX, Counts, SLOTS};
use maulstick_canvas::window::{Area, Window};
use maulstick_types::paint::Decision;

use crate::brush::load::BrushLoad;
use crate::brush::traits::BrushTraits;
use crate::rheology::Setting;

/// The motion of a head in one step, in cells of the surface.
#[derive(Clone, Copy, Debug)]
pub struct Sweep<'a> {
    /// Pose at the step before that, if the path began earlier.
    pub before: Option<&'a HeadPose>,
    /// Pose at the previous step.
    pub from: &'a HeadPose,
    /// Pose now.
    pub to: &'a HeadPose,
}

/// Transfer between brush and canvas (Baxter 2004, § 6.8).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Transfer {
    /// Paint is transferred both ways and is counted.
    #[default]
    Paint,
    /// The brush's load is constant: a full one never runs out, an empty one never fills.
    Sponge,
    /// The brush deposits a fixed amount of paint along a reference cell and takes nothing up.
    Marker {
        /// Units along a reference cell.
        flow: f32,
    },
    /// The brush takes on the colours that it touches; the canvas is unchanged.
    Sampler,
    /// Lifts the paint that the brush touches, and leaves the brush clean.
    Vacuum,
}

/// Handling of a brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handling {
    /// True if it pushes paint.
    pub push: bool,
    /// Its transfer.
    pub transfer: Transfer,
    /// Wet paint on a cell, quanta, above which the brush adds none.
    pub most: f32,
}

impl Default for Handling {
    fn default() -> Self {
        Self {
            push: true,
            transfer: Transfer::Paint,
            most: CELL_MAX as f32,
        }
    }
}

/// One step of a brush on a surface.
#[derive(Debug)]
pub struct Step<'a> {
    /// The cells.
    pub window: &'a mut Window,
    /// The head.
    pub head: &'a Head,
    /// Motion in this step.
    pub sweep: Sweep<'a>,
    /// The cells of the surface that it may reach, from the first up to but not with the second.
    pub bounds: ([i64; 2], [i64; 2]),
    /// Load of the brush.
    pub load: &'a mut BrushLoad,
    /// Its traits.
    pub traits: BrushTraits,
    /// Handling of the brush.
    pub handling: Handling,
    /// Quanta that stay on a cell however hard it is brushed (Baxter 2004, § 6.4.1, size).
    pub stain: f32,
    /// True if paint that the brush takes up stays on the surface all the same (Baxter 2004, § 6.7).
    pub lasting: bool,
    /// The slot of the thinner, if the painting has one.
    pub thinner: Option<usize>,
}

impl Step<'_> {
    /// True where its paint may come to lie in two sheets: there are several paints, or sheets already.
    #[must_use]
    pub fn may_have_sheets(&self) -> bool {
        let in_use = |slot: &usize| self.window.has(*slot) || self.load.has(*slot);
        self.window.has_sheets() || (0..SLOTS).filter(in_use).count() > 1
    }
}

/// Result of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepReport {
    /// Cells that the head touched.
    pub footprint_cells: u64,
    /// Wet quanta on them before the step.
    pub wet: u64,
    /// Those of them that are thinner.
    pub thinner: u64,
    /// By slot, quanta on canvas and brush that came from nowhere, as the brush's mode has it.
    pub from_nowhere: BySlot<i64>,
    /// By slot, quanta that were lifted off for good.
    pub lifted: BySlot<u64>,
}

impl StepReport {
    /// Adds the results of another step.
    pub fn add(&mut self, other: &Self) {
        self.footprint_cells += other.footprint_cells;
        self.wet += other.wet;
        self.thinner += other.thinner;
        maulstick_canvas::quantum::add(&mut self.lifted, &other.lifted);
        let came = self.from_nowhere.iter_mut().zip(*other.from_nowhere);
        came.for_each(|(sum, came)| *sum += came);
    }
}

/// Paint of a stroke once the brush is lifted.
#[derive(Debug)]
pub struct Rest<'a> {
    /// The cells.
    pub window: &'a mut Window,
    /// The cells of the tiles that the stroke reached.
    pub area: Area,
    /// Side of a cell, m.
    pub cell_m: f64,
    /// As [`Step::stain`].
    pub stain: f32,
    /// As [`Step::thinner`].
    pub thinner: Option<usize>,
    /// How the paint of each slot sets.
    pub settings: BySlot<Setting>,
}

/// Quanta by slot in the planes that a model keeps of its own on one page.
pub type CountOwn = fn(&[OwnPlane]) -> Counts;

/// A paint model: how paint moves in one step.
///
/// Wells, fills, underpaintings, drying, rewetting and scraping are independent of the model: they work on counts of
/// paint by cell and slot. A model's own planes dry with a whole film, and are scraped off cell by cell. The ledger
/// books the model's report: created and removed paint have separate accounts, and the rest must be on brushes and
/// surfaces.
pub trait PaintModel: Send {
    /// Its name in `rig.toml`.
    fn name(&self) -> &'static str;
    /// Moves the paint of one step.
    fn step(&mut self, step: &mut Step<'_>) -> StepReport;
    /// Backend of its steps: `cpu`, or `gpu` and the adapter's name.
    fn backend(&self) -> String {
        "cpu".to_owned()
    }
    /// True if the results of steps stay on another device until they are [settled](Self::settle). Until then window
    /// and load must not be changed elsewhere, and all steps must be of the same two.
    fn defers(&self) -> bool {
        false
    }
    /// [`step`](Self::step) with immediate results in window and load, which must be settled.
    fn step_now(&mut self, step: &mut Step<'_>) -> StepReport {
        self.step(step)
    }
    /// Writes the results of deferred steps into their window and load; returns their totals, beyond their own reports.
    fn settle(&mut self, _window: &mut Window, _load: &mut BrushLoad) -> StepReport {
        StepReport::default()
    }
    /// Number of cells beside a stroke that [`rest`](Self::rest) reads; `None` if paint does not move at rest.
    fn rest_halo(&self) -> Option<usize> {
        None
    }
    /// Moves the paint of a stroke once the brush is lifted; window and load are settled.
    fn rest(&mut self, _rest: &mut Rest<'_>) {}
    /// Counter of the paint in its own planes, for the ledger; `None` if they hold none.
    fn count_own(&self) -> Option<CountOwn> {
        None
    }
    /// The reason why the backend changed, returned once. No paint is lost by it.
    fn take_backend_change(&mut self) -> Option<String> {
        None
    }
    /// A limit of the backend that its steps have met, for the journal; returned once.
    fn take_limit(&mut self) -> Option<Decision> {
        None
    }
}
