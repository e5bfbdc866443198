//! A brush on a surface without tooth, for the examples.

use std::time::Instant;

use maulstick_brush::{BrushFile, Head, HeadPose};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::window::Window;
use maulstick_model::brush::head::{Waypoint, low_bounds};
use maulstick_model::brush::load::{BrushLoad, Half};
use maulstick_model::brush::scale::Scale;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Handling, PaintModel, Step, StepReport, Sweep};
use maulstick_num::fork_join::threads;
use maulstick_types::Pose;
use maulstick_types::brush::Solve;

/// Time of the processor that this thread has had, s, as Linux counts it; by the clock elsewhere.
fn processor_time(since: Instant) -> f64 {
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = counted.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64(), |counted| 1e-9 * counted)
}

/// A brush on cells of one size.
pub(crate) struct Bench {
    file: BrushFile,
    head: Head,
    scale: Scale,
    pub(crate) traits: BrushTraits,
    pub(crate) window: Window,
}

impl Bench {
    /// A brush of the library, 10 mm wide, with so many strips, on a surface of so many cells either way.
    pub(crate) fn new(brush: &str, strips: usize, (side, cell_m): (u32, f64)) -> Self {
        let scale = Scale { cell_m, zoom: 1.0 };
        let mut file = BrushFile::library(brush).expect("a brush of the library");
        file.strips.count = strips;
        let file = file.scaled_to(10.0).expect("a size of it");
        let head = Head::of(&file);
        let traits = BrushTraits::of(&file, cell_m, 1.0);
        let mut store = TileStore::new([side; 2]);
        let all = store.around([0; 2], [i64::from(side); 2]).expect("cells");
        let window = Window::open(&mut store, all, &Relief::flat(cell_m)).expect("free");
        Self {
            file,
            head,
            scale,
            traits,
            window,
        }
    }

    /// The head at a place, cells, turned about its axis, rad.
    pub(crate) fn pose(&self, [x, y]: [f64; 2], turn: f64) -> HeadPose {
        let cell = self.scale.cell_m;
        let (sine, cosine) = maulstick_num::sin_cos(0.5 * turn);
        let solve = Solve {
            event_ns: 0,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose {
                position_m: [x * cell, y * cell, 0.45 * self.file.length_m()],
                orientation: [0.0, 0.0, sine, cosine],
            },
            zoom: 1.0,
            angles_rad: vec![[0.3, 0.3]; self.file.spines.all_joints()],
            contacts: Vec::new(),
        };
        let mut pose = HeadPose::default();
        Waypoint::of(&solve, self.scale, 1.0).pose(&self.head, self.scale, &mut pose);
        pose
    }

    /// A full brush.
    pub(crate) fn loaded(&self) -> BrushLoad {
        let mut load = BrushLoad::clean(self.head.strips());
        load.fill(&self.head, &self.traits, &[(1, 1.0)], None, (Half::Both, 7));
        load
    }

    /// Steps through poses: what they did. `margin` is the longest way between two heads, cells.
    pub(crate) fn steps(
        &mut self,
        model: &mut dyn PaintModel,
        load: &mut BrushLoad,
        poses: &[HeadPose],
        margin: i64,
    ) -> StepReport {
        let mut sum = StepReport::default();
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
                load,
                traits: self.traits,
                handling: Handling::default(),
                stain: 0.0,
                lasting: false,
                thinner: None,
            }));
        }
        sum
    }

    /// A stroke with a full brush: what it did, and the seconds it took, of the processor if it is one thread's. `margin` is the
    /// longest way between two heads, cells.
    pub(crate) fn stroke(
        &mut self,
        model: &mut dyn PaintModel,
        poses: &[HeadPose],
        margin: i64,
    ) -> (StepReport, f64) {
        let mut load = self.loaded();
        let begun = Instant::now();
        let had = processor_time(begun);
        let mut sum = self.steps(model, &mut load, poses, margin);
        sum.add(&model.settle(&mut self.window, &mut load));
        let took = match threads() {
            1 => processor_time(begun) - had,
            _ => begun.elapsed().as_secs_f64(),
        };
        (sum, took)
    }
}
