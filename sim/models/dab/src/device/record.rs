//! A blend in the layout of the shaders.

use bytemuck::{Pod, Zeroable};
use maulstick_canvas::quantum::QUANTA_PER_UNIT;
use maulstick_model::interface::{Step, Transfer};

use crate::dither::Dither;
use crate::reservoir::Refill;
use crate::transfer::Limits;

use maulstick_gpu::steps::record::{Grid, RECORD_WORDS};

/// Scale of a share in the upper half of a fixed-point number, and in both halves.
const PARTS: [f64; 2] = [4_294_967_296.0, 18_446_744_073_709_551_616.0];

/// `Blend` of blend.wgsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct BlendRecord {
    low: [i32; 2],
    high: [i32; 2],
    shift: [i32; 2],
    corner: [i32; 2],
    /// Path of a cell of the head, reference cells: a factor on the motion of its strip, and a summand.
    pub(crate) by_even: [f32; 2],
    large: f32,
    share: [u32; 2],
    ends: u32,
    most: f32,
    stain: f32,
    exchanges: f32,
    flow: f32,
    lasting: u32,
    threshold: u32,
    across: [u32; 2],
    up: [u32; 2],
    across_each: f32,
    deep: f32,
    full: [f32; 2],
    rate: f32,
    refills: u32,
    thresholds: [u32; 2],
    /// Number of cells of the grid of the step's first drawing.
    pub(crate) first_drawn: u32,
    room: [u32; 31],
}

const _: () = assert!(size_of::<BlendRecord>() == 4 * RECORD_WORDS);

/// The upper and the lower half.
fn halves(parts: u64) -> [u32; 2] {
    [(parts >> 32) as u32, parts as u32]
}

impl BlendRecord {
    /// Common parameters of the blends of a step on a grid: the step's number since the brush's load, and the number of
    /// cells of its whole path.
    pub(crate) fn new(step: &Step<'_>, grid: &Grid, (number, cells): (u64, f32)) -> Self {
        let canvas = step.window.area(step.bounds.0, step.bounds.1);
        let origin = step.window.origin();
        let bounds = [0, 1].map(|i| step.bounds.0[i] - origin[i]);
        let on_grid = |cell: usize, i: usize| (cell as i64 - grid.from[i]) as i32;
        let large = 1.0 / (QUANTA_PER_UNIT * f64::from(step.traits.film_units_per_quantum));
        let share = (PARTS[1] / large.max(1.0)) as u64;
        let [across, up] = Dither::increases().map(halves);
        let limits = Limits::of(step);
        let refill = Refill::of(&step.traits, cells);
        let dither = Dither::new(step.load.seed(), crate::first_blend(number));
        Self {
            low: [0, 1].map(|i| on_grid(canvas.from[i], i)),
            high: [0, 1].map(|i| on_grid(canvas.from[i] + canvas.size[i], i)),
            corner: [0, 1].map(|i| (grid.from[i] - bounds[i]) as i32),
            large: large as f32,
            share: halves(share),
            most: limits.most,
            stain: limits.stain,
            exchanges: limits.exchanges,
            flow: limits.flow,
            lasting: u32::from(limits.lasting),
            across,
            up,
            across_each: Dither::ACROSS,
            deep: refill.deep as f32,
            full: refill.full.map(|quanta| quanta as f32),
            rate: refill.rate as f32,
            refills: u32::from(step.handling.transfer != Transfer::Sponge),
            thresholds: [0, 1].map(|row| dither.parts_at([0, row])),
            ..Self::default()
        }
    }

    /// The blend of a drawing at one of `count` places; `threshold` is that of the first cell of the step's bounds.
    pub(crate) fn at(
        mut self,
        (place, count): (usize, usize),
        shift: [i64; 2],
        threshold: u32,
    ) -> Self {
        self.shift = shift.map(|cells| cells as i32);
        self.ends = u32::from(place == 0) + 2 * u32::from(place + 1 == count);
        self.threshold = threshold;
        self
    }
}
