//! A step up to a stage, for inspection of single stages.

use std::ops::Range;

use maulstick_model::interface::Step;

use super::device_layout::DeviceLayout;
use super::kernels::Kernel;
use super::model::Planner;
use super::workspace::{Batch, Workspace};
use crate::device::{Device, GpuError};

/// Stages of single steps.
pub struct Probing<P> {
    /// The device with its buffers.
    pub workspace: Workspace,
    kernels: &'static [Kernel],
    planner: P,
}

/// State of a step on the device.
pub struct Probed {
    on: DeviceLayout,
    rows: Range<usize>,
}

impl<P: Planner> Probing<P> {
    /// The stages of a planner on a device.
    ///
    /// # Errors
    /// A [`GpuError`] where the driver rejects the shaders.
    pub fn new(gpu: Device, kernels: &'static [Kernel], planner: P) -> Result<Self, GpuError> {
        Ok(Self {
            workspace: Workspace::new(gpu, kernels)?,
            kernels,
            planner,
        })
    }

    /// Runs the stages of a step up to the last one called `last`; `None` where the device cannot do the step.
    pub fn run(&mut self, step: &Step<'_>, last: &str) -> Result<Option<Probed>, GpuError> {
        let Some(on) = DeviceLayout::new(step, self.planner.has_sheets()) else {
            return Ok(None);
        };
        let mut batch = Batch::default();
        let planned = self.planner.plan(step, &on, step.load.steps(), &mut batch);
        let Some(rows) = planned else {
            return Ok(None);
        };
        batch.end_after(self.kernels, last);
        self.workspace
            .upload(&on, (step.window, step.load), step.head)?;
        self.workspace.submit(&on, &batch)?;
        Ok(Some(Probed { on, rows }))
    }

    /// Writes the result of the stages to a step's window and load.
    pub fn write(&mut self, probed: Probed, step: &mut Step<'_>) -> Result<(), GpuError> {
        let width = step.window.width();
        let Probed { on, rows } = probed;
        let (settled, _) = self.workspace.read_back(&on, rows, width)?;
        on.write(&settled, step.window, step.load);
        Ok(())
    }
}
