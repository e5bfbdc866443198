//! dAb's stroking algorithms by themselves (Baxter 2004, table 4.2): canvas texels blended a second along two kinds of
//! path, of which the text says nothing: here a fast straight one and a slow curved one.

use std::time::Instant;

use maulstick_brush::{BrushFile, Head, HeadPose};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::window::Window;
use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_gpu::{Device, GpuModel};
use maulstick_model::brush::head::{Waypoint, low_bounds};
use maulstick_model::brush::load::{BrushLoad, Half};
use maulstick_model::brush::scale::Scale;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Handling, PaintModel, Step, StepReport, Sweep};
use maulstick_rig::UserError;
use maulstick_types::Pose;
use maulstick_types::brush::Solve;

use crate::report::Report;

/// Cells either way.
const SIDE: u32 = 1024;
const SCALE: Scale = Scale {
    cell_m: 2.5e-4,
    zoom: 1.0,
};
/// Width of the brush, mm, and its strips: a footprint about 40 cells wide.
const BRUSH: (f64, usize) = (10.0, 96);
/// Wet paint on the canvas, quanta.
const FILM: f32 = 40_000.0;
/// Rounds, of which the first warms up.
const ROUNDS: usize = 8;

/// A path: its name, the way from state to state in cells, and how much it turns on that way, rad.
const PATHS: [(&str, f64, f64); 2] = [("straight", 20.0, 0.0), ("curved", 3.0, 0.03)];
const STROKERS: [(&str, Stroker); 3] = [
    ("faster", Stroker::Faster),
    ("better", Stroker::Better),
    ("spline", Stroker::Spline),
];

/// The algorithm, on a device if there is one.
fn model(stroker: Stroker, gpu: Option<&Device>) -> Result<Box<dyn PaintModel>, UserError> {
    let Some(gpu) = gpu else {
        return Ok(Box::new(Dab::stroking(stroker)));
    };
    let fault = |error| UserError::failure(format!("the graphics device: {error}"));
    let model = GpuModel::dab_stroking(gpu.clone(), stroker).map_err(fault)?;
    Ok(Box::new(model))
}

/// Measures and reports; of a device with upload and read-back of each stroke.
pub(crate) fn run(report: &mut Report, gpu: Option<&Device>) -> Result<(), UserError> {
    let fault = |error: maulstick_brush::BrushError| UserError::failure(error.to_string());
    let mut file = BrushFile::library("round").map_err(fault)?;
    file.strips.count = BRUSH.1;
    let file = file.scaled_to(BRUSH.0).map_err(fault)?;
    for (stroker, kind) in STROKERS {
        let mut all = Vec::new();
        for (path, way, turn) in PATHS {
            let rates = rates(&file, &mut *model(kind, gpu)?, (way, turn))?;
            all.extend(rates.iter().copied());
            report.median(&format!("texels_per_s.{stroker}.{path}"), "texels/s", rates);
        }
        report.median(&format!("texels_per_s.{stroker}"), "texels/s", all);
    }
    Ok(())
}

/// The heads along a path.
fn heads(file: &BrushFile, head: &Head, (way, turn): (f64, f64)) -> Vec<HeadPose> {
    let (mut at, mut direction) = ([150.0, 300.0], 0.0f64);
    let mut poses = Vec::new();
    while poses.len() < 200 && at[0] > 60.0 && at[0] < f64::from(SIDE) - 60.0 {
        let solve = Solve {
            event_ns: 0,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose {
                position_m: [
                    at[0] * SCALE.cell_m,
                    at[1] * SCALE.cell_m,
                    0.45 * file.length_m(),
                ],
                ..Pose::IDENTITY
            },
            zoom: 1.0,
            angles_rad: vec![[0.3, 0.3]; file.spines.all_joints()],
            contacts: Vec::new(),
        };
        let mut pose = HeadPose::default();
        Waypoint::of(&solve, SCALE, 1.0).pose(head, SCALE, &mut pose);
        poses.push(pose);
        let (sine, cosine) = maulstick_num::sin_cos(direction);
        at = [at[0] + way * cosine, at[1] + way * sine];
        direction += turn;
    }
    poses
}

/// Texels a second of each round.
fn rates(
    file: &BrushFile,
    model: &mut dyn PaintModel,
    path: (f64, f64),
) -> Result<Vec<f64>, UserError> {
    let head = Head::of(file);
    let traits = BrushTraits::of(file, SCALE.cell_m, SCALE.zoom);
    let poses = heads(file, &head, path);
    let mut store = TileStore::new([SIDE; 2]);
    let leased = store
        .around([0; 2], [i64::from(SIDE); 2])
        .and_then(|all| Window::open(&mut store, all, &Relief::flat(SCALE.cell_m)));
    let mut window = leased.ok_or_else(|| UserError::failure("a surface cannot be leased"))?;
    let mut rates = Vec::new();
    for round in 0..ROUNDS {
        window.plane_mut(0).fill(FILM);
        window.plane_mut(1).fill(0.0);
        let mut load = BrushLoad::clean(head.strips());
        load.fill(
            &head,
            &traits,
            &[(1, 1.0)],
            None,
            (Half::Both, round as u64),
        );
        let mut texels = StepReport::default();
        let begun = Instant::now();
        for place in 1..poses.len() {
            let (from, to) = (&poses[place - 1], &poses[place]);
            let Some(bounds) = low_bounds(&head, to, &traits, 8.0) else {
                continue;
            };
            // The way from state to state is longer than a step of a rig.
            let margin = path.0.ceil() as i64;
            let bounds = (
                bounds.0.map(|at| at - margin),
                bounds.1.map(|at| at + margin),
            );
            texels.add(&model.step(&mut Step {
                window: &mut window,
                head: &head,
                sweep: Sweep {
                    before: place.checked_sub(2).map(|before| &poses[before]),
                    from,
                    to,
                },
                bounds,
                load: &mut load,
                traits,
                handling: Handling::default(),
                stain: 0.0,
                lasting: false,
                thinner: None,
            }));
        }
        texels.add(&model.settle(&mut window, &mut load));
        let rate = texels.footprint_cells as f64 / begun.elapsed().as_secs_f64();
        if round > 0 {
            rates.push(rate);
        }
    }
    Ok(rates)
}
