//! Speed of dAb's stroking algorithms along two kinds of path (Baxter 2004, table 4.2), and of a step of `dab` beside one of
//! `impasto` on fine cells, on the number of threads that is given, one and two in turn if none is; one by its time of the
//! processor, more by the clock: `cargo run --release -p maulstick-dab --example speed [THREADS [PART OF A NAME]]`.

use std::time::Instant;

use maulstick_brush::{BrushFile, Head, HeadPose};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::window::Window;
use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_impasto::Impasto;
use maulstick_model::brush::head::{Waypoint, low_bounds};
use maulstick_model::brush::load::{BrushLoad, Half};
use maulstick_model::brush::scale::Scale;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Handling, PaintModel, Step, StepReport, Sweep};
use maulstick_num::fork_join::{threads, with_threads};
use maulstick_types::Pose;
use maulstick_types::brush::Solve;

/// Cells either way.
const SIDE: u32 = 1024;
/// Wet paint on the canvas, quanta.
const FILM: f32 = 40_000.0;
/// Rounds, of which the first warms up.
const ROUNDS: usize = 12;

/// Time of the processor that this thread has had, s, as Linux counts it; by the clock elsewhere.
fn processor_time(since: Instant) -> f64 {
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = counted.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64(), |counted| 1e-9 * counted)
}

/// A brush on cells of one size.
struct Bench {
    file: BrushFile,
    head: Head,
    scale: Scale,
    traits: BrushTraits,
    window: Window,
}

/// A path from head to head: cells from one to the next, and by how much it turns on that way, rad.
type Path = (f64, f64);

impl Bench {
    /// A round brush of 10 mm with so many strips.
    fn new(strips: usize, cell_m: f64) -> Self {
        let scale = Scale { cell_m, zoom: 1.0 };
        let mut file = BrushFile::library("round").expect("a brush of the library");
        file.strips.count = strips;
        let file = file.scaled_to(10.0).expect("a size of it");
        let head = Head::of(&file);
        let traits = BrushTraits::of(&file, cell_m, 1.0);
        let mut store = TileStore::new([SIDE; 2]);
        let all = store.around([0; 2], [i64::from(SIDE); 2]).expect("cells");
        let window = Window::open(&mut store, all, &Relief::flat(cell_m)).expect("free");
        Self {
            file,
            head,
            scale,
            traits,
            window,
        }
    }

    /// The head at a place, cells.
    fn pose(&self, [x, y]: [f64; 2]) -> HeadPose {
        let cell = self.scale.cell_m;
        let solve = Solve {
            event_ns: 0,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose {
                position_m: [x * cell, y * cell, 0.45 * self.file.length_m()],
                ..Pose::IDENTITY
            },
            zoom: 1.0,
            angles_rad: vec![[0.3, 0.3]; self.file.spines.all_joints()],
            contacts: Vec::new(),
        };
        let mut pose = HeadPose::default();
        Waypoint::of(&solve, self.scale, 1.0).pose(&self.head, self.scale, &mut pose);
        pose
    }

    fn heads(&self, (way, turn): Path) -> Vec<HeadPose> {
        let (mut at, mut direction) = ([150.0, 300.0], 0.0f64);
        let mut poses = Vec::new();
        while poses.len() < 200 && at[0] > 60.0 && at[0] < f64::from(SIDE) - 120.0 {
            poses.push(self.pose(at));
            let (sine, cosine) = maulstick_num::sin_cos(direction);
            at = [at[0] + way * cosine, at[1] + way * sine];
            direction += turn;
        }
        poses
    }

    /// A stroke with a full brush over wet paint: what it did, and the seconds it took.
    fn stroke(
        &mut self,
        model: &mut dyn PaintModel,
        poses: &[HeadPose],
        margin: i64,
    ) -> (StepReport, f64) {
        self.window.plane_mut(0).fill(FILM);
        self.window.plane_mut(1).fill(0.0);
        let mut load = BrushLoad::clean(self.head.strips());
        load.fill(&self.head, &self.traits, &[(1, 1.0)], None, (Half::Both, 7));
        let mut sum = StepReport::default();
        let begun = Instant::now();
        let had = processor_time(begun);
        for place in 1..poses.len() {
            let (from, to) = (&poses[place - 1], &poses[place]);
            let Some((low, high)) = low_bounds(&self.head, to, &self.traits, 8.0) else {
                continue;
            };
            sum.add(&model.step(&mut Step {
                window: &mut self.window,
                head: &self.head,
                sweep: Sweep {
                    before: place.checked_sub(2).map(|before| &poses[before]),
                    from,
                    to,
                },
                bounds: (low.map(|at| at - margin), high.map(|at| at + margin)),
                load: &mut load,
                traits: self.traits,
                handling: Handling::default(),
                stain: 0.0,
                lasting: false,
                thinner: None,
            }));
        }
        let took = match threads() {
            1 => processor_time(begun) - had,
            _ => begun.elapsed().as_secs_f64(),
        };
        (sum, took)
    }
}

fn texels(only: &str) {
    let mut bench = Bench::new(96, 2.5e-4);
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
            let mut poses = bench.heads(way);
            if path == "oblique" {
                let place = |i: usize| [150.0 + 18.5 * i as f64, 300.0 + 7.6 * i as f64];
                poses = (0..40).map(|i| bench.pose(place(i))).collect();
            }
            if !format!("{name}.{path}").contains(only) {
                continue;
            }
            let mut model = Dab::stroking(stroker);
            let (mut cells, mut seconds) = (0, 0.0);
            for round in 0..ROUNDS {
                let (sum, took) = bench.stroke(&mut model, &poses, way.0.ceil() as i64);
                if round > 0 {
                    cells += sum.footprint_cells;
                    seconds += took;
                }
            }
            println!(
                "texels_per_s.{name}.{path}: {:.1} million",
                1e-6 * cells as f64 / seconds
            );
        }
    }
}

/// Time of steps of a rig on cells of .125 mm, µs, in turns.
fn models() {
    let mut bench = Bench::new(384, 1.25e-4);
    let step = f64::from(bench.traits.step_cells);
    let poses = bench.heads((step, 0.01));
    let mut models: [Box<dyn PaintModel>; 2] = [Box::<Dab>::default(), Box::<Impasto>::default()];
    let (mut took, mut cells) = ([0.0; 2], [0; 2]);
    for round in 0..ROUNDS {
        for (i, model) in models.iter_mut().enumerate() {
            let (sum, seconds) = bench.stroke(model.as_mut(), &poses, 2);
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
