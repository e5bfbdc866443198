//! Backends of the flow around a brush: the processor, and a device that may have no room for a window or be lost.

use std::fmt;

use maulstick_stokes::flow::{Conditions, Flow};
use maulstick_stokes::grid::Grid;
use maulstick_types::paint::Decision;

use crate::coarse::{Coarse, FlowWindow};

/// Cells of an axis from which down a window is not made coarser.
const FEWEST_CELLS: usize = 4;

/// Why a backend has not found the flow of a window.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FlowError {
    /// It has no room for so many cells.
    #[error("a window needs {} MiB in one piece, and there are at most {}", needs.div_ceil(1 << 20), most >> 20)]
    TooLarge {
        /// Bytes that the window needs.
        needs: u64,
        /// Bytes that there are.
        most: u64,
    },
    /// It is gone for good.
    #[error("{0}")]
    Lost(String),
}

/// A backend of the flow beside the processor.
pub trait FlowBackend: fmt::Debug + Send {
    /// Its name: `gpu` and the adapter's.
    fn name(&self) -> String;

    /// True if it finds the flow of such a window sooner than the processor.
    fn is_faster(&self, window: &FlowWindow<'_>) -> bool;

    /// Velocity on the lower faces of each axis after one step from rest, m/s, on the grid's places.
    ///
    /// # Errors
    /// A [`FlowError`]; nothing is found then.
    fn flow(&mut self, window: &FlowWindow<'_>) -> Result<&[Vec<f32>; 3], FlowError>;
}

/// The flow of the windows of a brush, by whichever backend there is; nothing of it lasts from one to the next.
#[derive(Debug, Default)]
pub struct BrushFlow {
    /// Room of the processor.
    processor: Option<Flow>,
    device: Option<Box<dyn FlowBackend>>,
    fall: Option<String>,
    limit: Option<Decision>,
    is_limited: bool,
}

impl BrushFlow {
    /// Found by a device where that is faster, until it is lost.
    #[must_use]
    pub fn on(device: Box<dyn FlowBackend>) -> Self {
        Self {
            device: Some(device),
            ..Self::default()
        }
    }

    /// Name of the backend, and whether it has no room for some windows.
    #[must_use]
    pub fn backend(&self) -> String {
        match &self.device {
            None => "cpu".to_owned(),
            Some(device) if self.is_limited => format!("{}, flow on coarser cells", device.name()),
            Some(device) => device.name(),
        }
    }

    /// The reason why the device is no longer used, returned once.
    pub fn take_fall(&mut self) -> Option<String> {
        self.fall.take()
    }

    /// That flow is found on coarser cells, and why; returned once.
    pub fn take_limit(&mut self) -> Option<Decision> {
        self.limit.take()
    }

    /// Velocities on the faces of voxels, found on cells of `side` voxels or, where the device has no room for so many, on
    /// cells twice as wide, and so on. `scene` makes the window for a side.
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

/// Velocities on the faces of voxels by a device, and why it refused the window as it was.
///
/// # Errors
/// That the device is lost, or the refusal where it has no room for the coarsest window either.
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
