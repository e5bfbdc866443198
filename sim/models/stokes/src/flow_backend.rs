//! Backends of the flow around a brush: the processor, and a device that may lack memory for a window or be lost.

use std::fmt;

use maulstick_stokes::flow::{Conditions, Flow};
use maulstick_stokes::grid::Grid;
use maulstick_types::paint::Decision;

use crate::coarse::{Coarse, FlowWindow};

/// Number of cells along an axis at or below which a window is not coarsened.
const FEWEST_CELLS: usize = 4;

/// Why a backend has not found the flow of a window.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FlowError {
    /// The window needs more memory than there is.
    #[error("a window needs {} MiB in one piece, and there are at most {}", needs.div_ceil(1 << 20), most >> 20)]
    TooLarge {
        /// Bytes needed.
        needs: u64,
        /// Bytes available.
        most: u64,
    },
    /// The backend is lost.
    #[error("{0}")]
    Lost(String),
}

/// A backend of the flow other than the processor.
pub trait FlowBackend: fmt::Debug + Send {
    /// Name for the log: `gpu` and the adapter's.
    fn name(&self) -> String;

    /// True if it is faster than the processor for such a window.
    fn is_faster(&self, window: &FlowWindow<'_>) -> bool;

    /// Velocity on the lower faces of each axis after one step from rest, m/s, in the grid's layout.
    ///
    /// # Errors
    /// A [`FlowError`], without a result.
    fn flow(&mut self, window: &FlowWindow<'_>) -> Result<&[Vec<f32>; 3], FlowError>;
}

/// The flow of a brush's windows, by any backend; no state lasts from one to the next.
#[derive(Debug, Default)]
pub struct BrushFlow {
    /// Buffers of the processor.
    processor: Option<Flow>,
    device: Option<Box<dyn FlowBackend>>,
    fall: Option<String>,
    limit: Option<Decision>,
    is_limited: bool,
}

impl BrushFlow {
    /// Flow on a device where that is faster, until it is lost.
    #[must_use]
    pub fn on(device: Box<dyn FlowBackend>) -> Self {
        Self {
            device: Some(device),
            ..Self::default()
        }
    }

    /// Name of the backend, and the note that some windows do not fit.
    #[must_use]
    pub fn backend(&self) -> String {
        match &self.device {
            None => "cpu".to_owned(),
            Some(device) if self.is_limited => format!("{}, flow on coarser cells", device.name()),
            Some(device) => device.name(),
        }
    }

    /// Returns the reason of the switch from the device to the processor, once.
    pub fn take_backend_change(&mut self) -> Option<String> {
        self.fall.take()
    }

    /// Returns the decision to use coarser cells, with its reason, once.
    pub fn take_limit(&mut self) -> Option<Decision> {
        self.limit.take()
    }

    /// Velocities on the faces of voxels, on cells of `side` voxels or, where the device lacks memory, on cells twice
    /// as wide, and so on. `scene` makes the window for a side.
    pub fn find(
        &mut self,
        fine: &Grid,
        side: usize,
        scene: impl Fn(usize) -> (Coarse, Conditions),
    ) -> [Vec<f32>; 3] {
        let (coarse, conditions) = scene(side);
        if let Some(device) = &mut self.device
            && device.is_faster(&coarse.window(&conditions))
        {
            match solve(device.as_mut(), fine, (&coarse, &conditions), &scene) {
                Ok((velocity, refusal)) => {
                    if let Some(refusal) = refusal {
                        self.limit(&coarse, &conditions, &refusal);
                    }
                    return velocity;
                }
                Err(error) => {
                    self.fall = Some(format!("the graphics device failed: {error}"));
                    self.device = None;
                }
            }
        }
        let FlowWindow {
            grid, fill, solids, ..
        } = coarse.window(&conditions);
        let flow = self.processor.get_or_insert_with(|| Flow::new(grid));
        flow.restart(grid);
        flow.step(fill, solids, &conditions);
        coarse.refine(&flow.velocity, fine)
    }

    fn limit(&mut self, coarse: &Coarse, conditions: &Conditions, refusal: &FlowError) {
        if std::mem::replace(&mut self.is_limited, true) {
            return;
        }
        let [width, height, depth] = coarse.grid.cells;
        let cell_mm = (1e5 * conditions.cell_m).round() / 100.0;
        let why = format!("{refusal} ({width}x{height}x{depth} cells of {cell_mm} mm)");
        self.limit = Some(Decision::CoarserFlow { why });
    }
}

/// Velocities on the faces of voxels by a device, and its reason for refusing the original window.
///
/// # Errors
/// The device is lost, or the coarsest window does not fit either.
fn solve(
    device: &mut dyn FlowBackend,
    fine: &Grid,
    (coarse, conditions): (&Coarse, &Conditions),
    scene: &impl Fn(usize) -> (Coarse, Conditions),
) -> Result<([Vec<f32>; 3], Option<FlowError>), FlowError> {
    let refusal = match device.flow(&coarse.window(conditions)) {
        Ok(velocity) => return Ok((coarse.refine(velocity, fine), None)),
        Err(refusal @ FlowError::TooLarge { .. }) => refusal,
        Err(lost) => return Err(lost),
    };
    let (mut side, mut cells) = (coarse.side, coarse.grid.cells);
    while cells.iter().any(|cells| *cells > FEWEST_CELLS) {
        side *= 2;
        let (coarse, conditions) = scene(side);
        cells = coarse.grid.cells;
        match device.flow(&coarse.window(&conditions)) {
            Ok(velocity) => return Ok((coarse.refine(velocity, fine), Some(refusal))),
            Err(FlowError::TooLarge { .. }) => {}
            Err(lost) => return Err(lost),
        }
    }
    Err(refusal)
}
