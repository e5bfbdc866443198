//! The flow around a brush of the paint model `stokes`, computed on the device window by window.

use maulstick_stokes::domain::LEAST_FILL;
use maulstick_stokes::flow::{Effort, layers_with_paint};
use maulstick_stokes::grid::Grid;

use crate::coarse::FlowWindow;
use crate::flow_backend::{FlowBackend, FlowError};

use maulstick_gpu::device::{Choice, Device, GpuError};

use super::{GpuFlow, Tuning};

/// Number of cells with paint, and air above them, from which a device is used where the processor may be. On one core
/// of a Xeon 32×32×16 cells take 6 to 9 ms, and others in proportion; on an H200 the dispatches take 3 ms for any
/// window up to 64×64×32.
const FEWEST_CELLS: usize = 16_384;

/// The flow of successive windows of any size, in the same memory.
#[derive(Debug)]
pub struct GpuBrushFlow {
    flow: GpuFlow,
    velocity: [Vec<f32>; 3],
    fewest_cells: usize,
    adapter: String,
}

impl GpuBrushFlow {
    /// A backend on a device: for large windows, or for all where the device must be used.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn new(gpu: Device, choice: Choice) -> Result<Self, GpuError> {
        Self::tuned(gpu, choice, &Tuning::default())
    }

    /// A backend with a tuning for the device.
    ///
    /// # Errors
    /// As [`GpuBrushFlow::new`].
    pub fn tuned(gpu: Device, choice: Choice, tuning: &Tuning) -> Result<Self, GpuError> {
        let adapter = gpu.name().to_owned();
        let fewest_cells = match choice {
            Choice::Auto => FEWEST_CELLS,
            Choice::Forced => 0,
        };
        Ok(Self {
            flow: GpuFlow::tuned(gpu, &Grid::walled([1; 3]), Effort::default(), tuning)?,
            velocity: Default::default(),
            fewest_cells,
            adapter,
        })
    }

    fn find(&mut self, window: &FlowWindow<'_>) -> Result<(), GpuError> {
        let FlowWindow {
            grid,
            fill,
            solids,
            conditions,
        } = window;
        self.flow.restart(&solved(window))?;
        self.flow.step(fill, solids, conditions)?;
        let found = self.flow.read_velocity()?;
        let axes = found.chunks_exact(found.len() / 3);
        for (velocity, found) in self.velocity.iter_mut().zip(axes) {
            velocity.clear();
            velocity.extend_from_slice(found);
            velocity.resize(grid.len(), 0.0);
        }
        Ok(())
    }
}

/// The solved layers, equal to the processor's.
fn solved(window: &FlowWindow<'_>) -> Grid {
    layers_with_paint(window.grid, window.fill, LEAST_FILL)
}

impl FlowBackend for GpuBrushFlow {
    fn name(&self) -> String {
        format!("gpu {}", self.adapter)
    }

    fn is_faster(&self, window: &FlowWindow<'_>) -> bool {
        solved(window).cells.iter().product::<usize>() >= self.fewest_cells
    }

    fn flow(&mut self, window: &FlowWindow<'_>) -> Result<&[Vec<f32>; 3], FlowError> {
        match self.find(window) {
            Ok(()) => Ok(&self.velocity),
            Err(GpuError::Window { needs, most, .. }) => Err(FlowError::TooLarge { needs, most }),
            Err(error) => Err(FlowError::Lost(error.to_string())),
        }
    }
}
