//! Traits of a brush, as a paint model needs them: in cells of a surface and in quanta.

use maulstick_brush::BrushFile;
use maulstick_brush::file::sections::Hair;
use maulstick_brush::head::STATIONS;
use maulstick_canvas::quantum::{QUANTA_PER_UNIT, QUANTUM_M, REFERENCE_CELL_M, UNIT_M};
use maulstick_num::exp;

use crate::brush::scale::Scale;
use crate::transfer::Exchanging;

/// Texels along a strip.
pub const TEXELS_PER_STRIP: usize = 16;
/// Strips of a head at most, as of a brush file.
pub const STRIPS_MOST: usize = maulstick_brush::file::check::STRIPS_MOST;

/// Properties of a brush that a paint model needs, in cells of a surface and in quanta.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrushTraits {
    /// Way of a step, cells.
    pub step_cells: f32,
    /// Number of parts of a step in which paint moves, so that none moves more than a cell in one.
    pub parts: u32,
    /// Number of times that the step is doubled, because the machine falls behind.
    pub doublings: u32,
    /// Half the width of a strip, cells.
    pub half_width: f32,
    /// Share of that width which a strip loses up to its point.
    pub taper: f32,
    /// Distance by which the skin draws back where the strips show, cells.
    pub recede: f32,
    /// Half the thickness of a strip, cells: by twice as much its edges are higher than its middle.
    pub half_thickness: f32,
    /// Height of the most unruly strip over the surface while the head is hardly pressed, cells.
    pub lift: f32,
    /// Additional depth that the pressed head reaches into the tooth, cells.
    pub sink: f32,
    /// Quanta of a texel's full film.
    pub film_full: f64,
    /// The most quanta of a texel's film.
    pub film_most: f64,
    /// Quanta inside a texel of a fully loaded brush.
    pub inside_full: f64,
    /// Thickness of a texel's film by its count, units.
    pub film_units_per_quantum: f32,
    /// How far a texel's film hangs below its bristle by its count, cells: its thickness, but for bristles that hardly
    /// press.
    pub film_cells_per_quantum: f32,
    /// Height of wet paint by its count, cells.
    pub cells_per_quantum: f32,
    /// Thickness of paint by its height in cells, units.
    pub units_per_cell: f32,
    /// Side of a cell by that of the reference cell.
    pub cell_per_reference: f32,
    /// True if it floats on its paint in one plane, as a blade does.
    pub floats: bool,
    /// Share of its motion that paint follows.
    pub follows: f32,
    /// Parameters of paint transfer.
    pub exchanging: Exchanging,
    /// Share of a film's deficit that comes from inside in a step.
    pub refill: f64,
    /// Share of the difference between texels that evens out in a step.
    pub creep: f64,
    /// Seepage of paint between the films.
    pub seep: Seep,
}

/// Seepage of paint between the films of neighbouring texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seep {
    /// Share of their difference that evens out between strips, above the part held by the yield stress.
    pub beside: f64,
    /// The same along a strip, where the motion shears it, above the film that clings to it.
    pub along: f64,
    /// Quanta of a texel's film that cling to a strip: they do not flow along it.
    pub clings: f64,
}

impl BrushTraits {
    /// Share of a film's deficit that comes from inside along a reference cell.
    const REFILL: f64 = 0.15;
    /// Share of the difference between texels that evens out along a reference cell.
    const CREEP: f64 = 0.03;
    /// Shares of the difference between films that even out along a reference cell: between strips, and along them.
    const SEEP: [f64; 2] = [0.25, 0.35];
    /// Thickness of the film that clings to a strip, µm.
    const CLINGS_UM: f64 = 250.0;
    /// Difference between the films of two strips that stays, by a full film: so a bristle keeps its streak.
    pub const HOLDS: f64 = 0.3;

    /// The traits of a brush on a surface with cells of `cell_m` at `zoom`.
    #[must_use]
    pub fn of(file: &BrushFile, cell_m: f64, zoom: f64) -> Self {
        let seen = 1e-3 / (cell_m * zoom);
        let rigid = file.head.hair == Hair::Steel;
        let along_m = file.length_m() / TEXELS_PER_STRIP as f64;
        let texel_cells = file.strips.width_mm * 1e-3 * along_m / (cell_m * cell_m);
        let quanta = |um: f64| (um * 1e-6 / QUANTUM_M * texel_cells).min(TEXEL_MOST);
        let steps = cell_m / REFERENCE_CELL_M;
        let step_cells = Scale { cell_m, zoom }.step_cells(rigid || file.surface.is_some());
        let flow = steps * step_cells;
        let share = |of_reference: f64| 1.0 - exp(maulstick_num::ln(1.0 - of_reference) * flow);
        Self {
            step_cells: step_cells as f32,
            parts: step_cells.ceil() as u32,
            doublings: 0,
            half_width: (0.5 * file.strips.width_mm * seen) as f32,
            taper: file.strips.taper as f32,
            recede: file
                .surface
                .as_ref()
                .map_or(0.0, |skin| (skin.recede_mm * seen) as f32),
            half_thickness: (0.5 * file.strips.thickness_mm * seen) as f32,
            lift: (file.strips.lift_mm * seen) as f32,
            sink: (file.strips.sink_mm * seen * (cell_m / PEAK_M).min(PEAK_MOST)) as f32,
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
                Hair::Sable => Exchanging::SOFT,
                Hair::Hog => Exchanging::BRISTLES,
            },
            refill: share(Self::REFILL),
            creep: share(Self::CREEP),
            seep: Seep {
                beside: share(Self::SEEP[0]),
                along: share(Self::SEEP[1]),
                clings: quanta(Self::CLINGS_UM),
            },
        }
    }
}

impl BrushTraits {
    /// Quanta on and inside a fully loaded head with this number of strips.
    #[must_use]
    pub fn full_load(&self, strips: usize) -> f64 {
        (strips * TEXELS_PER_STRIP) as f64 * (self.film_full + self.inside_full)
    }

    /// The traits of a step doubled a number of times.
    #[must_use]
    pub fn doubled(mut self, doublings: u32) -> Self {
        let Seep { beside, along, .. } = &mut self.seep;
        for share in [&mut self.refill, &mut self.creep, beside, along] {
            let rest = (0..doublings).fold(1.0 - *share, |rest, _| rest * rest);
            *share = 1.0 - rest;
        }
        self.step_cells *= (1 << doublings) as f32;
        self.parts = self.step_cells.ceil() as u32;
        self.doublings += doublings;
        self
    }
}

/// Greatest quanta of a full film, and inside a full texel: single bristles take up several times that, counted in 32
/// bits. Brushes of thousands of cells across carry no more.
const TEXEL_MOST: f64 = (1u32 << 29) as f64;
/// Side of a cell on which bristles sink as their file says, m: the height of a larger one is a mean, above which peaks
/// stand that they sink into, up to so many times as deep.
const PEAK_M: f64 = 0.125e-3;
const PEAK_MOST: f64 = 2.0;
/// Greatest film as a multiple of its full thickness.
pub(crate) const FILM_OVER: f64 = 2.0;
/// Greatest film on a blade, which gathers the paint that it scrapes off.
pub(crate) const BLADE_OVER: f64 = 3.0;
/// Share of the motion of bristles that paint follows: it sticks to them about as to the canvas (a half in Baxter 2004,
/// § 6.4.2). Paint in front of a blade goes with it.
pub(crate) const FOLLOWS: f32 = 0.41;
/// [`FOLLOWS`] of a blade.
pub(crate) const BLADE_FOLLOWS: f32 = 1.0;
/// Press from which all of a film is squeezed under its bristles.
const SQUEEZED_AT: f32 = 0.1;
/// Share of the lift that remains where the head is fully pressed: bristles never lie in one plane.
const UNEVEN: f32 = 0.1;

impl BrushTraits {
    /// Height of the most unruly strip over the surface under a press of 0 to 1, cells. A blade floats on its paint,
    /// the less the harder it is pressed.
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

    /// The traits under a press of 0 to 1: the film of bristles that hardly press does not reach into the tooth.
    #[must_use]
    pub fn pressed(mut self, press: f32) -> Self {
        let squeezed = (press / SQUEEZED_AT).clamp(0.0, 1.0);
        self.film_cells_per_quantum *= 1.0 - self.exchanging.holds * (1.0 - squeezed * squeezed);
        self
    }

    /// Half the width of a strip in the segment that ends at a station, cells.
    #[must_use]
    pub fn half_width_before(&self, station: usize) -> f32 {
        let middle = (station as f32 - 0.5) / (STATIONS - 1) as f32;
        self.half_width * (1.0 - self.taper * middle)
    }
}
