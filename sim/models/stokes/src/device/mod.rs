//! Stokes Paint on the device: the solver of `maulstick-stokes` and its transport in WGSL, stage by stage.
//!
//! Domain, rheology, operator, the hierarchies of multigrid, generalised conjugate residuals and the conjugate
//! gradients that end a step all run on the device; scalar products are summed and used there. A step is always the
//! same list of dispatches, without a read-back. The algorithm is the processor's: its smoother, a Chebyshev polynomial
//! of damped Jacobi steps, is symmetric and independent of the order of places. Sums are of f32 in another order, so
//! velocities agree to rounding and not bit by bit.
//!
//! Counts of paints are whole numbers below 2²⁴, which f32 holds exactly: one cell loses and the other gains the flux
//! through a face. The caller sets the number of [parts](Paints) of a step by the speed of the brush; faster paint
//! moves half a cell in each. The solids' distances and velocities come from the processor.
//!
//! | module | holds |
//! | --- | --- |
//! | `plan` | layout of the fields |
//! | `record` | a step and a call in the layout of the shaders |
//! | `buffers` | the buffers of a window |
//! | `kernels` | the stages, and their pipelines |
//! | `schedule` | the dispatches of a step |
//! | `brush_flow` | the flow around a brush of the paint model `stokes` |
//! | `measure` | steps compared with a copy, for the benchmark |

mod brush_flow;
mod buffers;
mod kernels;
mod measure;
mod plan;
mod record;
mod schedule;

use bytemuck::{bytes_of, cast_slice, pod_collect_to_vec};
use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Effort};
use maulstick_stokes::grid::Grid;
use wgpu::BufferUsages as Usage;

use crate::step::StokesPaint;
pub use brush_flow::GpuBrushFlow;
use buffers::WindowBuffers;
pub use kernels::Fault;
use kernels::Pipelines;
use maulstick_gpu::arena::{Arena, read};
use maulstick_gpu::{Choice, Device, GpuError, OnDevice};
pub use plan::Paints;
use plan::Plan;
use record::{CALL_STRIDE, WindowRecord};
use schedule::{Dispatch, Schedule};

/// Fields of window.wgsl that are uploaded or read.
const FILL: u32 = 0;
const DISTANCE: u32 = 1;
const OF_SOLID: u32 = 2;
const RESISTANCE: u32 = 5;
const X: u32 = 44;
/// Scalars of window.wgsl.
const NORMS: u32 = 80;
const PRESSURE_NORMS: u32 = 704;
/// Greatest number of iterations with recorded norms.
const MOST_STEPS: usize = 38;

/// The paint model with its flow on a device, for the registry.
pub(crate) fn make(gpu: Device, choice: Choice) -> Result<OnDevice, GpuError> {
    let flow = GpuBrushFlow::new(gpu, choice)?;
    Ok(OnDevice {
        model: Box::new(StokesPaint::on(Box::new(flow))),
        traffic: None,
    })
}

/// Velocity and pressure of a window on the device.
#[derive(Debug)]
pub struct GpuFlow {
    gpu: Device,
    tuning: Tuning,
    effort: Effort,
    pipelines: Pipelines,
    plan: Plan,
    dispatches: Vec<Dispatch>,
    /// Bytes that the stages of a step read and write.
    bytes: u64,
    buffers: WindowBuffers,
    back: Arena,
    /// Index of the next order of axes.
    turn: usize,
    /// Share of a cell's excess or deficit of volume that is corrected in a step.
    pub relief: f32,
}

/// Tuning of the stages on a device, without effect on the flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuning {
    /// Number of cells of a level at and below which one workgroup does all levels.
    pub rest: u32,
    /// Paint to be transported.
    pub paints: Paints,
    /// Greatest size of a window, bytes, where the device allows more in one piece.
    pub most_bytes: u64,
    /// A constant of the shaders with another value: the seeded fault of a comparison.
    #[doc(hidden)]
    pub fault: Fault,
}

impl Default for Tuning {
    fn default() -> Self {
        Self {
            rest: 2048,
            paints: Paints::default(),
            most_bytes: u64::MAX,
            fault: None,
        }
    }
}

/// State of a flow after a step, in the layout of `maulstick_stokes::flow::Flow`.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowState {
    /// Velocity on the lower faces of each axis, m/s.
    pub velocity: [Vec<f32>; 3],
    /// Pressure by density in each cell, m²/s².
    pub pressure: Vec<f32>,
    /// Norms of the residual in the last step, the first guess's included.
    pub norms: Vec<f32>,
    /// Norms of the volume deficit, before and after each conjugate gradient.
    pub lacking: Vec<f32>,
}

/// Layout of a window, the dispatches of a step and their bytes.
fn laid_out(
    grid: &Grid,
    effort: Effort,
    tuning: &Tuning,
) -> Result<(Plan, Vec<Dispatch>, u64), GpuError> {
    let plan = Plan::new(grid, effort.steps, tuning.rest, tuning.paints)?;
    plan.check(tuning.most_bytes)?;
    let Schedule {
        dispatches, bytes, ..
    } = Schedule::new(&plan, effort);
    Ok((plan, dispatches, bytes))
}

impl GpuFlow {
    /// Paint at rest in a window, with the iterations of a step in `effort`.
    ///
    /// # Errors
    /// [`GpuError::Window`] where the window is too large for the device; another [`GpuError`] of the device.
    pub fn new(gpu: Device, grid: &Grid, effort: Effort) -> Result<Self, GpuError> {
        Self::tuned(gpu, grid, effort, &Tuning::default())
    }

    /// A flow with a tuning for the device.
    ///
    /// # Errors
    /// As [`GpuFlow::new`].
    pub fn tuned(
        gpu: Device,
        grid: &Grid,
        effort: Effort,
        tuning: &Tuning,
    ) -> Result<Self, GpuError> {
        let effort = Effort {
            steps: effort.steps.min(MOST_STEPS),
            projections: effort.projections.min(MOST_STEPS),
        };
        let limits = gpu.device.limits();
        let tuning = Tuning {
            most_bytes: (tuning.most_bytes)
                .min(limits.max_buffer_size)
                .min(limits.max_storage_buffer_binding_size),
            ..*tuning
        };
        let (plan, dispatches, bytes) = laid_out(grid, effort, &tuning)?;
        let (pipelines, buffers) = gpu.guarded(|| {
            let pipelines = Pipelines::new(&gpu, tuning.fault);
            let buffers = WindowBuffers::new(&gpu, &pipelines, plan.bytes(), dispatches.len());
            buffers.write_calls(&gpu, &dispatches);
            Ok((pipelines, buffers))
        })?;
        Ok(Self {
            tuning,
            effort,
            pipelines,
            plan,
            dispatches,
            bytes,
            buffers,
            back: Arena::new("stokes back", Usage::MAP_READ | Usage::COPY_DST),
            turn: 0,
            relief: 0.25,
            gpu,
        })
    }

    /// Restarts at rest, without paint to transport, in a window of another grid; memory grows as needed.
    ///
    /// # Errors
    /// [`GpuError::Window`] where the window does not fit: the flow is then unchanged. Another [`GpuError`] of
    /// the device.
    pub fn restart(&mut self, grid: &Grid) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        if self.plan.grid != *grid {
            let (plan, dispatches, bytes) = laid_out(grid, self.effort, &self.tuning)?;
            if !self.buffers.holds(plan.bytes(), dispatches.len()) {
                self.grow(&plan, dispatches.len())?;
            }
            (self.plan, self.dispatches, self.bytes) = (plan, dispatches, bytes);
            gpu.guarded(|| {
                self.buffers.write_calls(&gpu, &self.dispatches);
                Ok(())
            })?;
        }
        self.turn = 0;
        gpu.guarded(|| {
            // No stage writes the values beyond walls, which must be 0.
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.clear_buffer(&self.buffers.fields, 0, Some(self.plan.bytes()));
            gpu.queue.submit([encoder.finish()]);
            Ok(())
        })
    }

    /// Allocates memory for a window, and for somewhat larger ones. If that fails, windows of that size are refused
    /// from then on.
    fn grow(&mut self, plan: &Plan, dispatches: usize) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        let wanted = plan.bytes().max(self.buffers.fields.size());
        // A binding has a whole number of vectors.
        let wanted = wanted.next_power_of_two().min(self.tuning.most_bytes) / 4 * 4;
        let dispatches = dispatches.next_power_of_two();
        match gpu.guarded(|| {
            Ok(WindowBuffers::new(
                &gpu,
                &self.pipelines,
                wanted,
                dispatches,
            ))
        }) {
            Ok(buffers) => self.buffers = buffers,
            Err(GpuError::Memory) => {
                self.tuning.most_bytes = self.buffers.fields.size().min(plan.bytes() - 1);
                plan.check(self.tuning.most_bytes)?;
            }
            Err(error) => return Err(error),
        }
        Ok(())
    }

    /// Memory of a window of a grid on a device, bytes, for the iterations of a step in `effort`.
    ///
    /// # Errors
    /// [`GpuError::Window`] where no device's indices suffice.
    pub fn window_bytes(grid: &Grid, effort: Effort) -> Result<u64, GpuError> {
        Plan::new(grid, effort.steps.min(MOST_STEPS), 0, Paints::default()).map(|plan| plan.bytes())
    }

    /// Dispatches of a step in a window of a grid, and bytes of its stages: each field that a stage reads or writes
    /// once. A device's caches reduce them.
    ///
    /// # Errors
    /// [`GpuError::Window`] where no device's indices suffice.
    pub fn traffic(grid: &Grid, effort: Effort, tuning: &Tuning) -> Result<[u64; 2], GpuError> {
        let plan = Plan::new(
            grid,
            effort.steps.min(MOST_STEPS),
            tuning.rest,
            tuning.paints,
        )?;
        let schedule = Schedule::new(&plan, effort);
        Ok([schedule.dispatches.len() as u64, schedule.bytes])
    }

    /// Writes a velocity and a pressure.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn write(&self, velocity: &[Vec<f32>; 3], pressure: &[f32]) -> Result<(), GpuError> {
        let [u, v, w] = velocity;
        self.gpu.guarded(|| {
            for (number, field) in [u, v, w, pressure].into_iter().enumerate() {
                self.upload(X + number as u32, field);
            }
            Ok(())
        })
    }

    fn upload(&self, number: u32, field: &[f32]) {
        let grid = &self.plan.grid;
        let offset = 4 * u64::from(self.plan.field(number));
        if (0..3).any(|axis| grid.is_periodic(axis)) {
            let mut wrapped = field[..grid.len()].to_vec();
            grid.wrap(&mut wrapped);
            self.gpu
                .queue
                .write_buffer(&self.buffers.fields, offset, cast_slice(&wrapped));
        } else {
            let field = &field[..grid.len()];
            self.gpu
                .queue
                .write_buffer(&self.buffers.fields, offset, cast_slice(field));
        }
    }

    /// One step with cells filled to a fraction, between solids, under conditions, like `Flow::step` of the processor.
    /// Fields are the grid's; it does not wait.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn step(
        &mut self,
        fill: &[f32],
        solids: &Solids,
        conditions: &Conditions,
    ) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        gpu.guarded(|| {
            self.upload(FILL, fill);
            self.upload(DISTANCE, &solids.distance);
            for axis in 0..3 {
                self.upload(OF_SOLID + axis as u32, &solids.velocity[axis]);
                if let Some(resistance) = &solids.resistance {
                    self.upload(RESISTANCE + axis as u32, &resistance[axis]);
                }
            }
            self.submit(conditions, solids.resistance.is_some());
            Ok(())
        })
    }

    /// One step of the state on the device.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn step_again(&mut self, conditions: &Conditions) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        gpu.guarded(|| {
            self.submit(conditions, false);
            Ok(())
        })
    }

    /// Writes paint: quanta of each by cell.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn write_paints(&self, paints: &[Vec<u32>]) -> Result<(), GpuError> {
        self.gpu.guarded(|| {
            for (number, counts) in paints.iter().take(self.plan.paints.count).enumerate() {
                let counts: Vec<f32> = counts.iter().map(|count| *count as f32).collect();
                self.upload(self.plan.paint(number), &counts);
            }
            Ok(())
        })
    }

    /// Waits for the device, and reads the quanta of each paint by cell. Values beyond periodic sides are those of the
    /// opposite cells.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn read_paints(&mut self) -> Result<Vec<Vec<u32>>, GpuError> {
        let len = self.plan.grid.len();
        let count = self.plan.paints.count;
        let from = 4 * u64::from(self.plan.field(self.plan.paint(0)));
        let words = self.read_words(&[(from, 4 * (len * count) as u64)])?;
        let counts = words.chunks(len).take(count);
        Ok(counts
            .map(|counts| counts.iter().map(|count| *count as u32).collect())
            .collect())
    }

    fn submit(&mut self, conditions: &Conditions, resists: bool) {
        let record = WindowRecord::new(&self.plan, conditions, self.relief, resists, self.turn + 1);
        self.turn = (self.turn + self.plan.paints.parts) % 6;
        self.gpu
            .queue
            .write_buffer(&self.buffers.records, 0, bytes_of(&record));
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let mut last = None;
        for (number, dispatch) in self.dispatches.iter().enumerate() {
            if last != Some(dispatch.stage) {
                pass.set_pipeline(self.pipelines.of(dispatch.stage));
                last = Some(dispatch.stage);
            }
            pass.set_bind_group(
                0,
                &self.buffers.bound,
                &[(number as u64 * CALL_STRIDE) as u32],
            );
            let [x, y, z] = dispatch.groups;
            pass.dispatch_workgroups(x, y, z);
        }
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Waits for the device, and reads the state of the flow.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn read(&mut self) -> Result<FlowState, GpuError> {
        let len = self.plan.grid.len();
        let offset = |word: u32| 4 * u64::from(word);
        let scalar = |number: u32| offset(self.plan.scalars + number);
        let norms = |iterations: usize| 4 * (iterations as u64 + 1);
        let Effort { steps, projections } = self.effort;
        let ranges = [
            (offset(self.plan.field(X)), 16 * len as u64),
            (scalar(NORMS), norms(steps)),
            (scalar(PRESSURE_NORMS), norms(projections)),
        ];
        let words = self.read_words(&ranges)?;
        let (fields, norms) = words.split_at(4 * len);
        let (norms, lacking) = norms.split_at(steps + 1);
        let mut fields = fields.chunks(len).map(<[f32]>::to_vec);
        let mut next = || fields.next().unwrap_or_default();
        Ok(FlowState {
            velocity: [next(), next(), next()],
            pressure: next(),
            norms: norms.to_vec(),
            lacking: lacking.to_vec(),
        })
    }

    /// Waits for the device, and reads the velocity alone, axis after axis, on the grid's places.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn read_velocity(&mut self) -> Result<Vec<f32>, GpuError> {
        let bytes = 4 * self.plan.grid.len() as u64;
        let from = 4 * u64::from(self.plan.field(X));
        self.read_words(&[(from, 3 * bytes)])
    }

    /// Reads concatenated parts of the fields: offset and number of bytes.
    fn read_words(&mut self, ranges: &[(u64, u64)]) -> Result<Vec<f32>, GpuError> {
        let Self {
            gpu, back, buffers, ..
        } = self;
        gpu.guarded(|| {
            let bytes = ranges.iter().map(|(_, bytes)| bytes).sum();
            let back = back.of(gpu, bytes);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut at = 0;
            for (from, bytes) in ranges {
                encoder.copy_buffer_to_buffer(&buffers.fields, *from, back, at, *bytes);
                at += bytes;
            }
            gpu.queue.submit([encoder.finish()]);
            read(gpu, back, bytes, pod_collect_to_vec::<u8, f32>)
        })
    }

    /// Waits until the device has finished all steps.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.gpu.wait()
    }
}
