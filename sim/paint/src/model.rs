//! What a paint model does.

use maulstick_brush::BrushFile;
use maulstick_brush::file::sections::Hair;
use maulstick_brush::head::{Head, HeadPose, STATIONS};
use maulstick_num::exp;

use crate::head::Scale;
use crate::load::{BrushLoad, TEXELS_PER_STRIP};
use crate::quantum::{
    CELL_MAX, Counts, QUANTA_PER_UNIT, QUANTUM_M, REFERENCE_CELL_M, SLOTS, UNIT_M,
};
use crate::transfer::Exchanging;
use crate::window::Window;

/// The motion of a head in one step, in cells of the surface.
#[derive(Clone, Copy, Debug)]
pub struct Sweep<'a> {
    /// Where it was at the step before.
    pub from: &'a HeadPose,
    /// Where it is now.
    pub to: &'a HeadPose,
}

/// What a paint model needs to know of a brush, in cells of a surface and in quanta.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrushTraits {
    /// Way of a step, cells.
    pub step_cells: f32,
    /// In so many parts the paint of a step moves, so that none goes farther than a cell in one.
    pub parts: u32,
    /// Half the width of a strip, cells.
    pub half_width: f32,
    /// Share of that width which a strip loses up to its point.
    pub taper: f32,
    /// How far the skin draws back where the strips show, cells.
    pub recede: f32,
    /// Half the thickness of a strip, cells: by twice as much its edges are higher than its middle.
    pub half_thickness: f32,
    /// How far the most unruly strip keeps off the surface while the head is hardly pressed, cells.
    pub lift: f32,
    /// How much deeper the pressed head reaches into the tooth, cells.
    pub sink: f32,
    /// Quanta of a texel's full film.
    pub film_full: f64,
    /// The most quanta of a texel's film.
    pub film_most: f64,
    /// Quanta inside a texel of a fully loaded brush.
    pub inside_full: f64,
    /// Thickness of a texel's film by its count, units.
    pub film_units_per_quantum: f32,
    /// Thickness of a texel's film by its count, cells.
    pub film_cells_per_quantum: f32,
    /// Height of wet paint by its count, cells.
    pub cells_per_quantum: f32,
    /// Thickness of paint by its height in cells, units.
    pub units_per_cell: f32,
    /// Side of a cell by that of the reference cell.
    pub cell_per_reference: f32,
    /// Whether it floats on its paint in one plane, as a blade does.
    pub floats: bool,
    /// Share of its motion that paint follows.
    pub follows: f32,
    /// By what paint goes over.
    pub exchanging: Exchanging,
    /// Share of what a film lacks that comes from inside in [`FLOW_STEPS`](Self::FLOW_STEPS).
    pub refill: f64,
    /// Share of the difference between texels that evens out in as many.
    pub creep: f64,
    /// How films even out in as many.
    pub seep: Seep,
}

/// How paint seeps between the films of texels beside each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seep {
    /// Share of their difference that evens out between strips, beyond what the yield stress holds.
    pub beside: f64,
    /// The same along a strip, where the motion shears it.
    pub along: f64,
}

impl BrushTraits {
    /// Paint flows within each strip once in so many steps: in others at another step, so that strokes show none.
    pub const FLOW_STEPS: u64 = 2;
    /// Share of what a film lacks that comes from inside along a reference cell.
    const REFILL: f64 = 0.15;
    /// Share of the difference between texels that evens out along a reference cell.
    const CREEP: f64 = 0.03;
    /// Shares of the difference between films that even out along a reference cell.
    const SEEP: Seep = Seep {
        beside: 0.4,
        along: 0.35,
    };
    /// Difference between the films of two strips that stays, by a full film: so a bristle keeps its streak.
    pub const HOLDS: f64 = 0.3;

    /// The traits of a brush on a surface with cells of `cell_m` at `zoom`.
    #[must_use]
    pub fn of(file: &BrushFile, cell_m: f64, zoom: f64) -> Self {
        let seen = 1e-3 / (cell_m * zoom);
        let rigid = file.head.hair == Hair::Steel;
        let along_m = file.length_m() / TEXELS_PER_STRIP as f64;
        let texel_cells = file.strips.width_mm * 1e-3 * along_m / (cell_m * cell_m);
        let quanta = |um: f64| um * 1e-6 / QUANTUM_M * texel_cells;
        let steps = cell_m / REFERENCE_CELL_M;
        let step_cells = Scale { cell_m, zoom }.step_cells(rigid || file.surface.is_some());
        let flow = Self::FLOW_STEPS as f64 * steps * step_cells;
        let part =
            |of_reference: f64, flow| 1.0 - exp(maulstick_num::ln(1.0 - of_reference) * flow);
        let share = |of_reference: f64| part(of_reference, flow);
        Self {
            step_cells: step_cells as f32,
            parts: step_cells.ceil() as u32,
            half_width: (0.5 * file.strips.width_mm * seen) as f32,
            taper: file.strips.taper as f32,
            recede: file
                .surface
                .as_ref()
                .map_or(0.0, |skin| (skin.recede_mm * seen) as f32),
            half_thickness: (0.5 * file.strips.thickness_mm * seen) as f32,
            lift: (file.strips.lift_mm * seen) as f32,
            sink: (file.strips.sink_mm * seen * (PEAK_M / cell_m).min(1.0)) as f32,
            film_full: quanta(file.load.film_um),
            film_most: quanta(file.load.film_um) * if rigid { BLADE_OVER } else { FILM_OVER },
            inside_full: quanta(file.load.inside_um),
            film_units_per_quantum: (1.0 / (QUANTA_PER_UNIT * texel_cells)) as f32,
            film_cells_per_quantum: (QUANTUM_M / (texel_cells * cell_m * zoom)) as f32,
            cells_per_quantum: (QUANTUM_M / cell_m) as f32,
            units_per_cell: (cell_m / UNIT_M) as f32,
            cell_per_reference: steps as f32,
            floats: rigid,
            follows: if rigid { BLADE_FOLLOWS } else { FOLLOWS },
            exchanging: match file.head.hair {
                Hair::Steel => Exchanging::BLADE,
                Hair::Badger => Exchanging::BLENDER,
                Hair::Hog | Hair::Sable => Exchanging::BRISTLES,
            },
            refill: share(Self::REFILL),
            creep: share(Self::CREEP),
            seep: Seep {
                // Paint seeps as it diffuses: by the square of the distance, which grows as the root of how many it stands for.
                beside: part(Self::SEEP.beside, flow / file.strips.stands_for),
                along: share(Self::SEEP.along),
            },
        }
    }
}

impl BrushTraits {
    /// Those of a step that is doubled so many times.
    #[must_use]
    pub fn doubled(mut self, doublings: u32) -> Self {
        let Seep { beside, along } = &mut self.seep;
        for share in [&mut self.refill, &mut self.creep, beside, along] {
            let rest = (0..doublings).fold(1.0 - *share, |rest, _| rest * rest);
            *share = 1.0 - rest;
        }
        self.step_cells *= (1 << doublings) as f32;
        self.parts = self.step_cells.ceil() as u32;
        self
    }
}

/// Larger cells than these hold less of the peaks of a tooth, into which bristles sink, m.
const PEAK_M: f64 = 0.125e-3;
/// A film takes up at most this many times its full thickness.
pub const FILM_OVER: f64 = 2.0;
/// As [`FILM_OVER`]: what a blade scrapes off gathers on it.
pub const BLADE_OVER: f64 = 3.0;
/// Share of the motion of bristles that paint follows: it sticks to them about as to the canvas (a half
/// in Baxter 2004, § 6.4.2). What lies before a blade goes with it.
pub const FOLLOWS: f32 = 0.4;
/// As [`FOLLOWS`].
pub const BLADE_FOLLOWS: f32 = 1.0;
/// Share of the lift that is left where the head is fully pressed: bristles never lie in one plane.
const UNEVEN: f32 = 0.1;

impl BrushTraits {
    /// How far the most unruly strip keeps off what it lies on under a press of 0 to 1, cells. A blade floats
    /// on its paint, the less the harder it is pressed.
    #[must_use]
    pub fn loose(&self, press: f32) -> f32 {
        let off = 1.0 - press;
        self.lift
            * if self.floats {
                off * off * off * off
            } else {
                UNEVEN + (1.0 - UNEVEN) * off * off
            }
    }

    /// Half the width of a strip in the segment that ends at a station, cells.
    #[must_use]
    pub fn half_width_before(&self, station: usize) -> f32 {
        let middle = (station as f32 - 0.5) / (STATIONS - 1) as f32;
        self.half_width * (1.0 - self.taper * middle)
    }
}

/// What goes over between brush and canvas (Baxter 2004, § 6.8).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Transfer {
    /// Paint goes both ways and is counted.
    #[default]
    Paint,
    /// The brush stays as it is: a full one never runs out, an empty one never fills.
    Sponge,
    /// The brush lays down so much paint along a reference cell and takes nothing up.
    Marker {
        /// Units.
        flow: f32,
    },
    /// The brush takes on the colours that it touches; the canvas stays as it is.
    Sampler,
    /// What the brush touches is lifted off, and the brush is clean.
    Vacuum,
}

/// How a brush is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handling {
    /// Whether it pushes paint.
    pub push: bool,
    /// What goes over.
    pub transfer: Transfer,
    /// It adds no paint to a cell with more wet paint than this, quanta.
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
    /// What it does in this step.
    pub sweep: Sweep<'a>,
    /// The cells of the surface that it may reach, from the first up to but not with the second.
    pub bounds: ([i64; 2], [i64; 2]),
    /// What the brush carries.
    pub load: &'a mut BrushLoad,
    /// Its traits.
    pub traits: BrushTraits,
    /// How it is used.
    pub handling: Handling,
    /// Quanta that stay on a cell however hard it is brushed (Baxter 2004, § 6.4.1, size).
    pub stain: f32,
    /// Whether paint that the brush takes up stays on the surface all the same (Baxter 2004, § 6.7).
    pub lasting: bool,
    /// The slot of the thinner, if the painting has one.
    pub thinner: Option<usize>,
}

/// What a step did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepReport {
    /// Cells that the head touched.
    pub footprint_cells: u64,
    /// Wet quanta on them before the step.
    pub wet: u64,
    /// Those of them that are thinner.
    pub thinner: u64,
    /// By slot, quanta on canvas and brush that came from nowhere, as the brush's mode has it.
    pub from_nowhere: [i64; SLOTS],
    /// By slot, quanta that were lifted off for good.
    pub lifted: Counts,
}

impl StepReport {
    /// Adds what another step did.
    pub fn add(&mut self, other: &Self) {
        self.footprint_cells += other.footprint_cells;
        self.wet += other.wet;
        self.thinner += other.thinner;
        crate::quantum::add(&mut self.lifted, &other.lifted);
        let came = self.from_nowhere.iter_mut().zip(other.from_nowhere);
        came.for_each(|(sum, came)| *sum += came);
    }
}

/// A paint model: how paint moves in one step.
pub trait PaintModel: Send {
    /// Its name in `rig.toml`.
    fn name(&self) -> &'static str;
    /// Moves the paint of one step.
    fn step(&mut self, step: &mut Step<'_>) -> StepReport;
    /// What computes its steps: `cpu`, or `gpu` and the adapter's name.
    fn backend(&self) -> String {
        "cpu".to_owned()
    }
    /// Whether steps leave what they did elsewhere until they are [settled](Self::settle). Until then
    /// nobody else may change window and load, and all steps are of the same two.
    fn defers(&self) -> bool {
        false
    }
    /// As [`step`](Self::step), but window and load, which must be settled, have what it did at once.
    fn step_now(&mut self, step: &mut Step<'_>) -> StepReport {
        self.step(step)
    }
    /// Writes what deferred steps did into their window and load; what they did in all, besides what
    /// they reported themselves.
    fn settle(&mut self, _window: &mut Window, _load: &mut BrushLoad) -> StepReport {
        StepReport::default()
    }
    /// Why it computes elsewhere than before, once. No paint is lost by it.
    fn take_fall(&mut self) -> Option<String> {
        None
    }
}
