//! IMPaSTo on the device: the stages of the paint model `impasto`, in WGSL.
//!
//! Window and load are on the device from the first step on until they are settled; nothing is read
//! back between. Counts stay whole: all that is asked of one donor is summed in integers, truncated,
//! and moved from one side to the other. Steps that nobody has read back are kept, and done again by
//! the processor where the device is lost.
//!
//! | module | holds |
//! | --- | --- |
//! | `kernels` | the stages in their order, and their pipelines |
//! | `record` | a step as the shaders take it |
//! | `residence` | a window and a load while they are on the device |
//! | [`Traffic`] | what steps move, counted |
//! | `workspace` | the buffers; upload, steps, read-back |
//! | [`measure`] | the advection beside a copy, for the benchmark |
//! | [`probe`] | what single stages leave, for tests |
//! | `kept` | steps that are on the device alone |

mod kept;
mod kernels;
pub mod measure;
pub mod probe;
mod record;
mod residence;
mod traffic;
mod workspace;

use std::sync::Arc;

use maulstick_canvas::window::Window;
use maulstick_impasto::Impasto;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::interface::{PaintModel, Rest, Step, StepReport, Transfer};

use crate::device::{Device, GpuError};
use kept::KeptSteps;
use record::StepRecord;
use residence::Residence;
pub use traffic::Traffic;
use workspace::{BATCH, Batch, Workspace};

/// Unsettled steps after which they are settled at the latest.
const MOST_KEPT: usize = 256;
/// Most bytes of the poses of a batch.
const POSES_BYTES: usize = 16 << 20;

/// What is on the device.
struct Session {
    on: Residence,
    kept: KeptSteps,
    batch: Batch,
    uploaded: bool,
    /// Rows of the window that may have changed.
    rows: Option<(usize, usize)>,
    /// Whether paint may have come from nowhere.
    uncounted: bool,
}

/// The paint model `impasto` on the device; on the processor once that is lost.
pub struct GpuImpasto {
    workspace: Option<Workspace>,
    session: Option<Session>,
    cpu: Impasto,
    name: String,
    fall: Option<String>,
}

impl GpuImpasto {
    /// The model on a device.
    ///
    /// # Errors
    /// A [`GpuError`] where the driver does not take the shaders.
    pub fn new(gpu: Device) -> Result<Self, GpuError> {
        let name = gpu.name().to_owned();
        Ok(Self {
            workspace: Some(Workspace::new(gpu)?),
            session: None,
            cpu: Impasto::default(),
            name,
            fall: None,
        })
    }

    /// The adapter's name.
    #[must_use]
    pub fn adapter(&self) -> &str {
        &self.name
    }

    /// What its steps move, counted for as long as the device lasts.
    #[must_use]
    pub fn traffic(&self) -> Arc<Traffic> {
        let workspace = self.workspace.as_ref();
        workspace.map_or_else(Arc::default, |workspace| Arc::clone(&workspace.traffic))
    }

    /// Gives the device what it has not heard of yet.
    fn flush(
        workspace: &mut Workspace,
        session: &mut Session,
        window: &Window,
        load: &BrushLoad,
    ) -> Result<(), GpuError> {
        if session.batch.records.is_empty() {
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

    /// The processor goes on: with what the device had not given back.
    fn fall(&mut self, error: &GpuError, window: &mut Window, load: &mut BrushLoad) -> StepReport {
        self.workspace = None;
        self.fall = Some(format!("the graphics device failed: {error}"));
        let session = self.session.take();
        session.map_or_else(StepReport::default, |session| {
            session.kept.replay(&mut self.cpu, window, load)
        })
    }
}

impl PaintModel for GpuImpasto {
    fn name(&self) -> &'static str {
        "impasto"
    }

    fn backend(&self) -> String {
        match self.workspace {
            Some(_) => format!("gpu {}", self.name),
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
            let mut report = self.settle(step.window, step.load);
            report.add(&self.cpu.step(step));
            return report;
        }
        let Some(workspace) = &mut self.workspace else {
            return self.cpu.step(step);
        };
        if self.session.is_none() {
            self.session = Residence::new(step).map(|on| Session {
                on,
                kept: KeptSteps::of(step.head.clone()),
                batch: Batch::default(),
                uploaded: false,
                rows: None,
                uncounted: false,
            });
        }
        let Some(session) = &mut self.session else {
            // Too large for the device: the processor has the room.
            return self.cpu.step(step);
        };
        let batch = &mut session.batch;
        let number = batch.records.len();
        let Some(record) = StepRecord::new(step, &session.on, number, &mut batch.poses) else {
            return StepReport::default();
        };
        batch.records.push(record);
        session.kept.keep(step);
        session.uncounted |= step.lasting || step.handling.transfer == Transfer::Sponge;
        let rows = record.rows();
        let (first, last) = session.rows.unwrap_or((rows.start, rows.end));
        session.rows = Some((first.min(rows.start), last.max(rows.end)));
        let full = batch.records.len() == BATCH || 4 * batch.poses.len() > POSES_BYTES;
        if session.kept.len() >= MOST_KEPT {
            return self.settle(step.window, step.load);
        }
        if full && let Err(error) = Self::flush(workspace, session, step.window, step.load) {
            return self.fall(&error, step.window, step.load);
        }
        StepReport::default()
    }

    fn settle(&mut self, window: &mut Window, load: &mut BrushLoad) -> StepReport {
        let (Some(workspace), Some(session)) = (&mut self.workspace, &mut self.session) else {
            return StepReport::default();
        };
        let Some((first, last)) = session.rows else {
            self.session = None;
            return StepReport::default();
        };
        let read = Self::flush(workspace, session, window, load)
            .and_then(|()| workspace.read_back(&session.on, first..last, window.width()));
        match read {
            Ok((settled, mut report)) => {
                if session.uncounted {
                    report.from_nowhere = session.on.gained(&settled, window, load).into();
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

    fn take_fall(&mut self) -> Option<String> {
        self.fall.take()
    }
}
