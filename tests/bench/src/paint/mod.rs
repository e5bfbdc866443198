//! Steps of the paint model alone: presolved states of a brush on wet paint.
//!
//! | module | holds |
//! | --- | --- |
//! | [`advection`] | the advection alone, compared with a copy |
//! | [`stokes`] | the solver of Stokes Paint alone |
//! | [`texels`] | dAb's stroking algorithms alone |

mod advection;
mod stokes;
mod texels;

use std::sync::Arc;
use std::thread::available_parallelism;
use std::time::{Duration, Instant};

use maulstick_brush::BrushFile;
use maulstick_gpu::steps::traffic::Traffic;
use maulstick_gpu::{Choice, Device};
use maulstick_models::model_called;
use maulstick_num::fork_join::with_threads;
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::{Fill, FillPaint, common};
use maulstick_painting::{Painting, PaintingSetup, Sequencer};
use maulstick_rig::UserError;
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::FilmThickness;
use maulstick_types::{Edit, Pose};

use crate::header::header_of;
use crate::report::{Report, quantile, sorted};

const BRUSH: &str = "main";
/// The paints on the canvas and on the brush.
const FILM: &str = "Ultramarine Blue=0.25,Titanium White=0.25,Yellow Ochre=0.25,Pyrrole Red=0.25";
/// Thickness of the film on the canvas, m.
const FILM_M: f64 = 60e-6;
/// Path of a step, cells.
const STEP_CELLS: f64 = 0.7;
/// Share of the square that the footprint covers.
const COVERED: f64 = 0.62;
/// States of a round, and rounds.
const STATES: usize = 200;
const ROUNDS: usize = 7;

/// Sides of a footprint, cells, and numbers of the brush's strips.
const SIZES: [(usize, usize); 2] = [(26, 64), (88, 256)];
/// Side and number of strips of a footprint that justifies several cores.
const WIDE_FOOTPRINT: (usize, usize) = (352, 1024);
/// Threads that are compared with one.
const THREADS: [usize; 3] = [2, 4, 8];

fn fault(error: impl ToString) -> UserError {
    UserError::failure(error.to_string())
}

/// Model and backend of the paint.
#[derive(Clone)]
struct Means {
    model: String,
    gpu: Option<Device>,
}

impl Means {
    /// The same model on the processor.
    fn on_processor(&self) -> Self {
        Self {
            gpu: None,
            ..self.clone()
        }
    }
}

/// States of a brush that goes once round the middle of a canvas of this side, on cells of `cell_m`.
fn circle(file: &BrushFile, size_m: f64, cell_m: f64) -> Vec<BrushState> {
    let radius_m = 0.25 * size_m;
    let turn = STEP_CELLS * cell_m / radius_m;
    let state = |state: usize| {
        let (sine, cosine) = maulstick_num::sin_cos(turn * state as f64);
        let at = [cosine, sine].map(|way| 0.5 * size_m + radius_m * way);
        BrushState {
            device: 1,
            device_epoch: 1,
            device_seq: 0,
            solves: vec![Solve {
                event_ns: 0,
                stroke: 1,
                surface: CANVAS,
                flags: 0,
                pose: Pose {
                    position_m: [at[0], at[1], 0.45 * file.length_m()],
                    orientation: [0.0, 0.0, 0.0, 1.0],
                },
                zoom: 1.0,
                angles_rad: vec![[0.3, 0.3]; file.spines.all_joints()],
                contacts: Vec::new(),
            }],
        }
    };
    (0..STATES).map(state).collect()
}

/// A brush that goes round over wet paint.
struct Round {
    sequencer: Sequencer,
    states: Vec<BrushState>,
    seq: u64,
    /// Traffic of the graphics processor, if one paints.
    traffic: Option<Arc<Traffic>>,
}

impl Round {
    fn new(width_mm: f64, strips: usize, side: usize, means: &Means) -> Result<Self, UserError> {
        let mut file = BrushFile::library("round").map_err(fault)?;
        file.strips.count = strips;
        let file = file.scaled_to(width_mm).map_err(fault)?;
        let cells = (6 * side).max(256) as u32;
        let setup = PaintingSetup {
            cells: [cells, cells],
            model: means.model.clone(),
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().map_err(fault)?;
        let mut painting = Painting::new(&setup, library).map_err(fault)?;
        let mut traffic = None;
        if let Some(gpu) = &means.gpu {
            let Some(make) = model_called(&means.model).map_err(fault)?.make_on else {
                let what = format!("no GPU computes the paint model '{}'", means.model);
                return Err(UserError::usage(what));
            };
            let made = make(gpu.clone(), Choice::Forced).map_err(fault)?;
            traffic = made.traffic;
            painting.set_model(made.model);
        }
        let mut sequencer = Sequencer::new(painting);
        sequencer
            .define_brush(BRUSH, file.clone())
            .expect("a brush");
        let mixture = || FILM.parse().map_err(fault);
        let load = common::load(BRUSH, mixture()?, None)?;
        let fill = Fill {
            paint: FillPaint::Mixture {
                mixture: mixture()?,
            },
            thickness: FilmThickness::new(FILM_M)?,
            surface: CANVAS,
        };
        for edit in [Edit::from(load), fill.into()] {
            sequencer.edit(edit).map_err(fault)?;
        }
        let size_m = f64::from(cells) * setup.cell_m;
        Ok(Self {
            states: circle(&file, size_m, setup.cell_m),
            sequencer,
            seq: 0,
            traffic,
        })
    }

    /// Paints the states; steps and footprint cells of them, and the time they took.
    fn paint(&mut self) -> Result<([u64; 2], Duration), UserError> {
        let before = self.sequencer.painting().work();
        let begun = Instant::now();
        for state in &self.states {
            let header = header_of(BRUSH, self.seq);
            self.seq += 1;
            self.sequencer
                .state(BRUSH, &header, state)
                .1
                .map_err(fault)?;
        }
        // A device's work is complete once it is read.
        if self.traffic.is_some() {
            self.sequencer.painting_mut().commit();
        }
        let took = begun.elapsed();
        self.sequencer.drain_journal();
        let after = self.sequencer.painting().work();
        Ok(([after.0 - before.0, after.1 - before.1], took))
    }
}

/// A brush whose footprint covers the requested share of the square.
fn fitted(side: usize, strips: usize, means: &Means) -> Result<Round, UserError> {
    Round::new(fitted_mm(side, strips, means)?, strips, side, means)
}

/// Width of that brush, mm.
fn fitted_mm(side: usize, strips: usize, means: &Means) -> Result<f64, UserError> {
    let wanted = COVERED * (side * side) as f64;
    let mut width_mm = 0.25 * side as f64;
    for _ in 0..6 {
        let ([steps, cells], _) =
            Round::new(width_mm, strips, side, &means.on_processor())?.paint()?;
        let covered = cells as f64 / steps.max(1) as f64;
        if (0.97..1.06).contains(&(covered / wanted)) {
            break;
        }
        width_mm = (width_mm * (wanted / covered.max(1.0)).sqrt()).clamp(0.5, 250.0);
    }
    Ok(width_mm)
}

/// Measures and reports.
pub(crate) fn run(report: &mut Report, backend: &str, model: &str) -> Result<(), UserError> {
    let gpu = match backend {
        "gpu" => Some(Device::open(Choice::Forced).map_err(fault)?),
        _ => None,
    };
    if let Some(gpu) = &gpu {
        report.on(gpu.name());
    }
    let means = Means {
        model: model.to_owned(),
        gpu,
    };
    let cores = available_parallelism().map_or(1, usize::from);
    // Its steps cost as much as the solver's; the wide footprints of the others would take an hour.
    if model == "stokes" {
        if means.gpu.is_some() {
            return with_threads(cores.min(2), || beside_processor(report, &means));
        }
        stokes::run(report);
        return Ok(());
    }
    with_threads(cores.min(2), || rounds(report, &means))?;
    if means.gpu.is_none() {
        cells(report, &means)?;
        speed_up(report, cores, &means)?;
    }
    match model {
        "impasto" => advection::run(report, means.gpu),
        "dab" => with_threads(cores.min(2), || texels::run(report, means.gpu.as_ref())),
        _ => Ok(()),
    }
}

/// Both sizes on a device, beside the processor.
fn beside_processor(report: &mut Report, means: &Means) -> Result<(), UserError> {
    for (side, strips) in SIZES {
        let width_mm = fitted_mm(side, strips, means)?;
        let [mut device, mut processor] = [
            Round::new(width_mm, strips, side, means)?,
            Round::new(width_mm, strips, side, &means.on_processor())?,
        ];
        device.paint()?;
        processor.paint()?;
        let rate = |round: &mut Round| -> Result<f64, UserError> {
            let ([steps, _], took) = round.paint()?;
            Ok(steps as f64 / took.as_secs_f64())
        };
        let mut pairs = Vec::new();
        for _ in 0..ROUNDS {
            pairs.push((rate(&mut device)?, rate(&mut processor)?));
        }
        let name = format!("steps_per_s.{side}");
        report.paired(&name, "steps/s", "on the processor", &pairs);
    }
    Ok(())
}

/// Cells in contact that a core paints, beside the copy of as many.
fn cells(report: &mut Report, means: &Means) -> Result<(), UserError> {
    let (side, strips) = SIZES[1];
    let mut round = fitted(side, strips, means)?;
    round.paint()?;
    let mut pairs = Vec::new();
    for _ in 0..ROUNDS {
        let ([steps, cells], took) = round.paint()?;
        let copied = (side * side) as f64 * steps as f64;
        let rate = |cells: f64, took: Duration| cells / took.as_secs_f64();
        pairs.push((rate(cells as f64, took), rate(copied, copy(side, steps))));
    }
    report.paired("cells_per_s", "cells/s", "a copy of cells", &pairs);
    Ok(())
}

/// Speed-up by several cores with a wide brush, as far as there are that many.
fn speed_up(report: &mut Report, cores: usize, means: &Means) -> Result<(), UserError> {
    let (side, strips) = WIDE_FOOTPRINT;
    let mut round = fitted(side, strips, means)?;
    round.paint()?;
    for threads in THREADS {
        let name = format!("steps_per_s.{side}.{threads}");
        if cores < threads {
            report.unmeasured(&name, format!("{cores} cores: not measured"));
            continue;
        }
        let mut pairs = Vec::new();
        for _ in 0..ROUNDS {
            let ([steps, _], alone) = round.paint()?;
            let ([again, _], shared) = with_threads(threads, || round.paint())?;
            let rate = |steps: u64, took: Duration| steps as f64 / took.as_secs_f64();
            pairs.push((rate(again, shared), rate(steps, alone)));
        }
        report.paired(&name, "steps/s", "on one core", &pairs);
    }
    Ok(())
}

fn rounds(report: &mut Report, means: &Means) -> Result<(), UserError> {
    for (side, strips) in SIZES {
        let mut round = fitted(side, strips, means)?;
        round.paint()?;
        let (mut pairs, mut covered) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            let ([steps, cells], took) = round.paint()?;
            let copied = copy(side, steps);
            let rate = |took: Duration| steps as f64 / took.as_secs_f64();
            pairs.push((rate(took), rate(copied)));
            covered.push(cells as f64 / steps.max(1) as f64);
        }
        let name = format!("steps_per_s.{side}");
        report.paired(&name, "steps/s", "a copy of its cells", &pairs);
        let name = format!("footprint_cells.{side}");
        report.row(&name, quantile(&sorted(covered), 0.5), "cells");
        if let Some(traffic) = &round.traffic {
            let [steps, dispatches, bytes] = traffic.counts().map(|count| count as f64);
            let (each, moved) = (dispatches / steps.max(1.0), bytes / steps.max(1.0));
            report.row(&format!("dispatches_a_step.{side}"), each, "");
            report.row(&format!("bytes_a_step.{side}"), moved, "bytes");
        }
    }
    Ok(())
}

/// Time to copy the cells of `steps` steps: height and four paints, read and written.
fn copy(side: usize, steps: u64) -> Duration {
    let from = vec![1.0f32; side * side * 5];
    let mut to = vec![0.0f32; from.len()];
    let begun = Instant::now();
    for _ in 0..steps {
        to.copy_from_slice(std::hint::black_box(&from));
        std::hint::black_box(&mut to);
    }
    begun.elapsed().max(Duration::from_nanos(1))
}
