//! A step as far as a stage, for those who look at what single stages leave.

use std::ops::Range;

use maulstick_model::interface::Step;

use super::kernels::Kernel;
use super::model::Planner;
use super::residence::Residence;
use super::workspace::{Batch, Workspace};
use crate::device::{Device, GpuError};

/// Stages of single steps.
pub struct Probing<P> {
    /// The device with its buffers.
    pub workspace: Workspace,
    kernels: &'static [Kernel],
    planner: P,
}

/// What of a step is on the device.
pub struct Probed {
    on: Residence,
    rows: Range<usize>,
}

impl<P: Planner> Probing<P> {
    /// The stages of a planner on a device.
    ///
    /// # Errors
    /// A [`GpuError`] where the driver does not take the shaders.
    pub fn new(gpu: Device, kernels: &'static [Kernel], planner: P) -> Result<Self, GpuError> {
        Ok(Self {
            workspace: Workspace::new(gpu, kernels)?,
            kernels,
            planner,
        })
    }

    /// Does those stages of a step that come up to the last one called `last`. None where it is not for the device.
    pub fn run(&mut self, step: &Step<'_>, last: &str) -> Result<Option<Probed>, GpuError> {
        let Some(on) = Residence::new(step) else {
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

    /// Writes what the stages did to a step's window and load.
    pub fn write(&mut self, probed: Probed, step: &mut Step<'_>) -> Result<(), GpuError> {
        let width = step.window.width();
        let Probed { on, rows } = probed;
        let (settled, _) = self.workspace.read_back(&on, rows, width)?;
        on.write(&settled, step.window, step.load);
        Ok(())
    }
}
