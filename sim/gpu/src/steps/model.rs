//! A paint model that defers its steps to the device, and continues on the processor once that is lost.

use std::ops::Range;
use std::sync::Arc;

use maulstick_canvas::window::Window;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::interface::{CountOwn, PaintModel, Rest, Step, StepReport, Transfer};

use super::device_layout::DeviceLayout;
use super::kept::KeptSteps;
use super::kernels::Kernel;
use super::traffic::Traffic;
use super::workspace::{Batch, Workspace};
use crate::device::{Device, GpuError};

/// Number of unsettled steps after which they are settled.
const MOST_KEPT: usize = 256;

/// Planner of a model's steps as stages.
pub trait Planner: Send {
    /// True if its paint may lie in two sheets.
    fn has_sheets(&self) -> bool {
        false
    }

    /// Adds a step to a batch, with its number since the brush's load. Returns the rows of the window that it may
    /// change; `None` where the processor must do the step.
    fn plan(
        &self,
        step: &Step<'_>,
        on: &DeviceLayout,
        number: u64,
        batch: &mut Batch,
    ) -> Option<Range<usize>>;
}

/// State that is on the device.
struct Session {
    on: DeviceLayout,
    kept: KeptSteps,
    batch: Batch,
    uploaded: bool,
    /// Rows of the window that may have changed.
    rows: Range<usize>,
    /// True if paint may have been created without being counted.
    uncounted: bool,
    /// True if paint may have gone over the border of the surface.
    overhangs: bool,
}

/// A paint model on the device, and on the processor once that is lost.
pub struct GpuModel {
    workspace: Option<Workspace>,
    planner: Box<dyn Planner>,
    session: Option<Session>,
    /// The same model on the processor.
    cpu: Box<dyn PaintModel>,
    adapter: String,
    fall: Option<String>,
}

impl GpuModel {
    /// A model of these stages on a device.
    ///
    /// # Errors
    /// A [`GpuError`] where the driver rejects the shaders.
    pub fn new(
        gpu: Device,
        kernels: &'static [Kernel],
        planner: Box<dyn Planner>,
        cpu: Box<dyn PaintModel>,
    ) -> Result<Self, GpuError> {
        let adapter = gpu.name().to_owned();
        Ok(Self {
            workspace: Some(Workspace::new(gpu, kernels)?),
            planner,
            session: None,
            cpu,
            adapter,
            fall: None,
        })
    }

    /// The adapter's name.
    #[must_use]
    pub fn adapter(&self) -> &str {
        &self.adapter
    }

    /// Traffic of its steps, counted while the device lasts.
    #[must_use]
    pub fn traffic(&self) -> Arc<Traffic> {
        let workspace = self.workspace.as_ref();
        workspace.map_or_else(Arc::default, |workspace| Arc::clone(&workspace.traffic))
    }

    /// Submits all steps so far and waits for them; they remain unsettled.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn wait(&mut self, window: &Window, load: &BrushLoad) -> Result<(), GpuError> {
        let (Some(workspace), Some(session)) = (&mut self.workspace, &mut self.session) else {
            return Ok(());
        };
        Self::flush(workspace, session, window, load)?;
        workspace.gpu.wait()
    }

    fn flush(
        workspace: &mut Workspace,
        session: &mut Session,
        window: &Window,
        load: &BrushLoad,
    ) -> Result<(), GpuError> {
        if session.batch.steps == 0 {
            return Ok(());
        }
        if !session.uploaded {
            workspace.upload(&session.on, (window, load), &session.kept.head)?;
            session.uploaded = true;
        }
        workspace.submit(&session.on, &session.batch)?;
        session.batch = Batch::default();
        Ok(())
    }

    /// Switches to the processor, which repeats the unsettled steps.
    fn fall(&mut self, error: &GpuError, window: &mut Window, load: &mut BrushLoad) -> StepReport {
        self.workspace = None;
        self.fall = Some(format!("the graphics device failed: {error}"));
        let session = self.session.take();
        session.map_or_else(StepReport::default, |session| {
            session.kept.replay(self.cpu.as_mut(), window, load)
        })
    }

    /// Settles all earlier steps, then does a step on the processor.
    fn settle_and_step(&mut self, step: &mut Step<'_>) -> StepReport {
        let mut report = self.settle(step.window, step.load);
        report.add(&self.cpu.step(step));
        report
    }
}

impl PaintModel for GpuModel {
    fn name(&self) -> &'static str {
        self.cpu.name()
    }

    fn backend(&self) -> String {
        match self.workspace {
            Some(_) => format!("gpu {}", self.adapter),
            None => "cpu".to_owned(),
        }
    }

    fn defers(&self) -> bool {
        self.workspace.is_some()
    }

    fn step_now(&mut self, step: &mut Step<'_>) -> StepReport {
        self.cpu.step(step)
    }

    fn step(&mut self, step: &mut Step<'_>) -> StepReport {
        if matches!(step.handling.transfer, Transfer::Sampler | Transfer::Vacuum) {
            return self.settle_and_step(step);
        }
        let Some(workspace) = &mut self.workspace else {
            return self.cpu.step(step);
        };
        if self.session.is_none() {
            let sheets = self.planner.has_sheets();
            self.session = DeviceLayout::new(step, sheets).map(|on| Session {
                on,
                kept: KeptSteps::of(step.head.clone()),
                batch: Batch::default(),
                uploaded: false,
                rows: 0..0,
                uncounted: false,
                overhangs: false,
            });
        }
        let Some(session) = &mut self.session else {
            // Too large for the device; the processor has the memory.
            return self.cpu.step(step);
        };
        let number = session.on.steps() + session.kept.len() as u64;
        let planned = self
            .planner
            .plan(step, &session.on, number, &mut session.batch);
        let Some(rows) = planned else {
            return self.settle_and_step(step);
        };
        session.kept.keep(step);
        session.uncounted |= step.lasting || step.handling.transfer == Transfer::Sponge;
        let borders = step.window.borders();
        session.overhangs |= step.handling.push && borders.as_flattened().contains(&true);
        session.rows = if session.rows.is_empty() {
            rows
        } else {
            session.rows.start.min(rows.start)..session.rows.end.max(rows.end)
        };
        if session.kept.len() >= MOST_KEPT {
            return self.settle(step.window, step.load);
        }
        if session.batch.is_full()
            && let Err(error) = Self::flush(workspace, session, step.window, step.load)
        {
            return self.fall(&error, step.window, step.load);
        }
        StepReport::default()
    }

    fn settle(&mut self, window: &mut Window, load: &mut BrushLoad) -> StepReport {
        let (Some(workspace), Some(session)) = (&mut self.workspace, &mut self.session) else {
            return StepReport::default();
        };
        if session.kept.len() == 0 {
            self.session = None;
            return StepReport::default();
        }
        let rows = session.rows.clone();
        let read = Self::flush(workspace, session, window, load)
            .and_then(|()| workspace.read_back(&session.on, rows, window.width()));
        match read {
            Ok((settled, mut report)) => {
                if session.uncounted {
                    report.from_nowhere = session.on.gained(&settled, window, load).into();
                } else if session.overhangs {
                    let gained = session.on.gained(&settled, window, load);
                    report.lifted = gained.map(|gained| gained.min(0).unsigned_abs()).into();
                }
                session.on.write(&settled, window, load);
                self.session = None;
                report
            }
            Err(error) => self.fall(&error, window, load),
        }
    }

    fn rest_halo(&self) -> Option<usize> {
        self.cpu.rest_halo()
    }

    fn rest(&mut self, rest: &mut Rest<'_>) {
        self.cpu.rest(rest);
    }

    fn count_own(&self) -> Option<CountOwn> {
        self.cpu.count_own()
    }

    fn take_backend_change(&mut self) -> Option<String> {
        self.fall.take()
    }
}
