//! Speed of dAb's stroking algorithms along two kinds of path (Baxter 2004, table 4.2), and of a step of `dab` beside one of
//! `impasto` on fine cells, on the number of threads that is given, one and two in turn if none is; one by its time of the
//! processor, more by the clock: `cargo run --release -p maulstick-dab --example texels_per_s [THREADS [PART OF A NAME]]`.

use std::time::Instant;

use maulstick_brush::{BrushFile, HeadPose};
use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_impasto::Impasto;
use maulstick_model::interface::{PaintModel, StepReport};
use maulstick_model::trial::{PATHS, Trial};
use maulstick_num::fork_join::{threads, with_threads};

/// Cells either way.
const SIDE: u32 = 1024;
/// Rounds, of which the first warms up.
const ROUNDS: usize = 12;

/// A round brush of 10 mm with so many strips.
fn trial(strips: usize, cell_m: f64) -> Trial {
    let mut file = BrushFile::library("round").expect("a brush of the library");
    file.strips.count = strips;
    let file = file.scaled_to(10.0).expect("a size of it");
    Trial::new(file, SIDE, cell_m).expect("a surface")
}

/// Time of the processor that this thread has had, s, as Linux counts it; by the clock elsewhere.
fn processor_time(since: Instant) -> f64 {
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = counted.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64(), |counted| 1e-9 * counted)
}

/// A stroke over wet paint, and the seconds it took, of the processor if it is one thread's.
fn stroke(trial: &mut Trial, model: &mut dyn PaintModel, poses: &[HeadPose]) -> (StepReport, f64) {
    trial.wet();
    let begun = Instant::now();
    let had = processor_time(begun);
    let sum = trial.stroke(model, poses);
    let took = match threads() {
        1 => processor_time(begun) - had,
        _ => begun.elapsed().as_secs_f64(),
    };
    (sum, took)
}

fn texels(only: &str) {
    let mut trial = trial(96, 2.5e-4);
    for (name, stroker) in [
        ("faster", Stroker::Faster),
        ("better", Stroker::Better),
        ("spline", Stroker::Spline),
    ] {
        for path in PATHS {
            let poses = trial.heads(path);
            let name = format!("{name}.{}", path.name);
            if !name.contains(only) {
                continue;
            }
            let mut model = Dab::stroking(stroker);
            let (mut cells, mut texels, mut seconds) = (0, 0, 0.0);
            for round in 0..ROUNDS {
                let before = model.texels();
                let (sum, took) = stroke(&mut trial, &mut model, &poses);
                if round > 0 {
                    cells += sum.footprint_cells;
                    texels += model.texels() - before;
                    seconds += took;
                }
            }
            let [texels, touched] = [texels, cells].map(|count| 1e-6 * count as f64 / seconds);
            println!("texels_per_s.{name}: {texels:.1} million, touched {touched:.1}");
        }
    }
}

/// Time of steps of a rig on cells of .125 mm, µs, in turns.
fn models() {
    let mut trial = trial(384, 1.25e-4);
    let step = f64::from(trial.traits.step_cells);
    let place = |i: usize| [150.0 + step * i as f64, 300.0 + 0.3 * step * i as f64];
    let poses: Vec<HeadPose> = (0..200).map(|i| trial.pose(place(i), 0.0)).collect();
    let mut models: [Box<dyn PaintModel>; 2] = [Box::<Dab>::default(), Box::<Impasto>::default()];
    let (mut took, mut cells) = ([0.0; 2], [0; 2]);
    for round in 0..ROUNDS {
        for (i, model) in models.iter_mut().enumerate() {
            let (sum, seconds) = stroke(&mut trial, model.as_mut(), &poses);
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
