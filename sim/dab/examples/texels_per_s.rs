//! Speed of dAb's stroking algorithms along two kinds of path (Baxter 2004, table 4.2), and of a step of `dab` beside one of
//! `impasto` on fine cells, on the number of threads that is given, one and two in turn if none is; one by its time of the
//! processor, more by the clock: `cargo run --release -p maulstick-dab --example texels_per_s [THREADS [PART OF A NAME]]`.

mod scene;

use maulstick_brush::HeadPose;
use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_impasto::Impasto;
use maulstick_model::interface::{PaintModel, StepReport};
use maulstick_num::fork_join::with_threads;

use crate::scene::Bench;

/// Cells either way.
const SIDE: u32 = 1024;
/// Wet paint on the canvas, quanta.
const FILM: f32 = 40_000.0;
/// Rounds, of which the first warms up.
const ROUNDS: usize = 12;

/// Heads along a path: cells from one to the next, and by how much it turns on that way, rad.
fn heads(bench: &Bench, (way, turn): (f64, f64)) -> Vec<HeadPose> {
    let (mut at, mut direction) = ([150.0, 300.0], 0.0f64);
    let mut poses = Vec::new();
    while poses.len() < 200 && at[0] > 60.0 && at[0] < f64::from(SIDE) - 120.0 {
        poses.push(bench.pose(at, 0.0));
        let (sine, cosine) = maulstick_num::sin_cos(direction);
        at = [at[0] + way * cosine, at[1] + way * sine];
        direction += turn;
    }
    poses
}

/// A stroke over wet paint.
fn stroke(
    bench: &mut Bench,
    model: &mut dyn PaintModel,
    poses: &[HeadPose],
    margin: i64,
) -> (StepReport, f64) {
    bench.window.plane_mut(0).fill(FILM);
    bench.window.plane_mut(1).fill(0.0);
    bench.stroke(model, poses, margin)
}

fn texels(only: &str) {
    let mut bench = Bench::new("round", 96, (SIDE, 2.5e-4));
    for (name, stroker) in [
        ("faster", Stroker::Faster),
        ("better", Stroker::Better),
        ("spline", Stroker::Spline),
    ] {
        for (path, way) in [
            ("straight", (20.0, 0.0)),
            ("oblique", (20.0, 1e-9)),
            ("curved", (3.0, 0.03)),
        ] {
            let mut poses = heads(&bench, way);
            if path == "oblique" {
                let place = |i: usize| [150.0 + 18.5 * i as f64, 300.0 + 7.6 * i as f64];
                poses = (0..40).map(|i| bench.pose(place(i), 0.0)).collect();
            }
            if !format!("{name}.{path}").contains(only) {
                continue;
            }
            let mut model = Dab::stroking(stroker);
            let (mut cells, mut texels, mut seconds) = (0, 0, 0.0);
            for round in 0..ROUNDS {
                let before = model.texels();
                let (sum, took) = stroke(&mut bench, &mut model, &poses, way.0.ceil() as i64);
                if round > 0 {
                    cells += sum.footprint_cells;
                    texels += model.texels() - before;
                    seconds += took;
                }
            }
            let [texels, touched] = [texels, cells].map(|count: u64| 1e-6 * count as f64 / seconds);
            println!("texels_per_s.{name}.{path}: {texels:.1} million, touched {touched:.1}");
        }
    }
}

/// Time of steps of a rig on cells of .125 mm, µs, in turns.
fn models() {
    let mut bench = Bench::new("round", 384, (SIDE, 1.25e-4));
    let step = f64::from(bench.traits.step_cells);
    let poses = heads(&bench, (step, 0.01));
    let mut models: [Box<dyn PaintModel>; 2] = [Box::<Dab>::default(), Box::<Impasto>::default()];
    let (mut took, mut cells) = ([0.0; 2], [0; 2]);
    for round in 0..ROUNDS {
        for (i, model) in models.iter_mut().enumerate() {
            let (sum, seconds) = stroke(&mut bench, model.as_mut(), &poses, 2);
            if round > 0 {
                took[i] += seconds;
                cells[i] += sum.footprint_cells;
            }
        }
    }
    let steps = (ROUNDS - 1) * (poses.len() - 1);
    let [dab, impasto] = took.map(|took| 1e6 * took / steps as f64);
    let cells = cells.map(|cells| cells / steps as u64);
    println!(
        "a step of {step} cells of .125 mm: dab {dab:.0} µs, impasto {impasto:.0} µs, ratio {:.2}; cells {cells:?}",
        dab / impasto
    );
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let threads = arguments.next().and_then(|count| count.parse().ok());
    let only = arguments.next().unwrap_or_default();
    for count in threads.map_or(vec![1, 2], |count| vec![count]) {
        println!("{count} threads");
        with_threads(count, || {
            texels(&only);
            if "models".contains(&only) {
                models();
            }
        });
    }
}
