//! A step and a call in the layout of the shaders.

use bytemuck::{Pod, Zeroable};
use maulstick_stokes::domain::LEAST_FILL;
use maulstick_stokes::flow::Conditions;
use maulstick_stokes::rheology::LARGEST_RELATIVE_VISCOSITY;
use maulstick_stokes::unified::weights;

use super::plan::{Level, MOST_LEVELS, Plan, sides};

/// Size of a call, bytes.
pub(crate) const CALL_BYTES: u64 = size_of::<Call>() as u64;
/// Alignment of uniforms on every device, bytes.
pub(crate) const CALL_STRIDE: u64 = 256;
/// Size of a step, bytes.
pub(crate) const WINDOW_BYTES: u64 = size_of::<WindowRecord>() as u64;

/// `Call` of window.wgsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Call {
    pub(crate) level: u32,
    pub(crate) first: u32,
    pub(crate) source: u32,
    pub(crate) into: u32,
    pub(crate) number: u32,
    pub(crate) groups: u32,
    pub(crate) mode: u32,
    pub(crate) axis: u32,
}

/// `Window` of window.wgsl.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct WindowRecord {
    levels: [Level; MOST_LEVELS],
    low: [u32; 3],
    count: u32,
    high: [u32; 3],
    partials: u32,
    pull: [f32; 3],
    scalars: u32,
    alpha: f32,
    beta: f32,
    tau: f32,
    least_fill: f32,
    relief: f32,
    to_pressure: f32,
    per_cell: f32,
    yields: f32,
    thins: f32,
    per_rate: f32,
    least_rate: f32,
    resists: u32,
    capacity: f32,
    courant: f32,
    paints: u32,
    turn: u32,
    memory: u32,
    padding: [u32; 3],
}

impl WindowRecord {
    /// A step under conditions; `relief` is the corrected share of an excess of volume; `resists` is set with bristles.
    pub(crate) fn new(
        plan: &Plan,
        conditions: &Conditions,
        relief: f32,
        resists: bool,
        turn: usize,
    ) -> Self {
        let Conditions {
            cell_m,
            seconds,
            paint,
            pull,
        } = conditions;
        let mut levels = [Level::default(); MOST_LEVELS];
        levels[..plan.levels.len()].copy_from_slice(&plan.levels);
        let tau = paint.viscosity * seconds / (cell_m * cell_m);
        let [alpha, beta] = weights(tau);
        let [low, high] = sides(&plan.grid);
        let yields = paint.yields / paint.viscosity;
        Self {
            levels,
            low,
            count: plan.levels.len() as u32,
            high,
            partials: plan.partials,
            pull: pull.map(|pull| (pull * seconds) as f32),
            scalars: plan.scalars,
            alpha,
            beta,
            tau: tau as f32,
            least_fill: LEAST_FILL,
            relief: relief * (cell_m / seconds) as f32,
            to_pressure: (cell_m / (f64::from(alpha) * seconds)) as f32,
            per_cell: (1.0 / cell_m) as f32,
            yields: yields as f32,
            thins: (paint.index - 1.0) as f32,
            per_rate: (1.0 / paint.rate) as f32,
            least_rate: (yields / LARGEST_RELATIVE_VISCOSITY) as f32,
            resists: u32::from(resists),
            capacity: plan.paints.capacity as f32,
            courant: (seconds / cell_m) as f32 / plan.paints.parts as f32,
            paints: plan.paints.count as u32,
            turn: turn as u32,
            memory: plan.memory as u32,
            padding: [0; 3],
        }
    }
}
