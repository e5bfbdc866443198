//! What a paint model does.

use crate::load::BrushLoad;
use crate::path::Sweep;
use crate::window::Window;

/// One step of a brush on a surface.
#[derive(Debug)]
pub struct Step<'a> {
    /// The cells.
    pub window: &'a mut Window,
    /// Size of the surface in cells.
    pub cells: [u32; 2],
    /// Side of a cell, m.
    pub cell_m: f64,
    /// The head before and after.
    pub sweep: Sweep<'a>,
    /// What the brush carries.
    pub load: &'a mut BrushLoad,
    /// The head's surface in cells.
    pub head_cells: f64,
}

/// What a step did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepReport {
    /// Cells under the head.
    pub footprint_cells: u64,
}

/// A paint model: how paint moves in one step.
pub trait PaintModel: Send {
    /// Its name in `rig.toml`.
    fn name(&self) -> &'static str;
    /// Moves the paint of one step.
    fn step(&mut self, step: &mut Step<'_>) -> StepReport;
}
