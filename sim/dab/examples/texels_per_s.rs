//! Speed of dAb's stroking algorithms along two kinds of path (Baxter 2004, table 4.2), and of a step of `dab` beside one of
//! `impasto` on fine cells, on the number of threads that is given, one and two in turn if none is; one by its time of the
//! processor, more by the clock: `cargo run --release -p maulstick-dab --example texels_per_s [THREADS [PART OF A NAME]]`.

#[path = "scene/paths.rs"]
mod paths;
mod scene;

use maulstick_brush::HeadPose;
use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_impasto::Impasto;
use maulstick_model::interface::{PaintModel, StepReport};
use maulstick_num::fork_join::with_threads;

use crate::paths::{PATHS, Path, SIDE, wet};
use crate::scene::Bench;

/// Rounds, of which the first warms up.
const ROUNDS: usize = 12;

/// A stroke over wet paint.
fn stroke(
    bench: &mut Bench,
    model: &mut dyn PaintModel,
    poses: &[HeadPose],
    margin: i64,
) -> (StepReport, f64) {
    wet(bench);
    bench.stroke(model, poses, margin)
}

fn texels(only: &str) {
    let mut bench = Bench::new("round", 96, (SIDE, 2.5e-4));
    for (name, stroker) in [
        ("faster", Stroker::Faster),
        ("better", Stroker::Better),
        ("spline", Stroker::Spline),
    ] {
        for path in PATHS {
            let poses = path.heads(&bench);
            let name = format!("{name}.{}", path.name);
            if !name.contains(only) {
                continue;
            }
            let mut model = Dab::stroking(stroker);
            let (mut cells, mut seconds) = (0, 0.0);
            for round in 0..ROUNDS {
                let (sum, took) = stroke(&mut bench, &mut model, &poses, path.margin());
                if round > 0 {
                    cells += sum.footprint_cells;
                    seconds += took;
                }
            }
            println!(
                "texels_per_s.{name}: {:.1} million",
                1e-6 * cells as f64 / seconds
            );
        }
    }
}

/// Time of steps of a rig on cells of .125 mm, µs, in turns.
fn models() {
    let mut bench = Bench::new("round", 384, (SIDE, 1.25e-4));
    let step = f64::from(bench.traits.step_cells);
    let poses = Path::slow(step).heads(&bench);
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
