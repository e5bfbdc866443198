//! Whole steps of a brush that is used otherwise than for painting, beside those of the processor.

use maulstick_canvas::quantum::{Counts, SLOTS};
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::interface::{Handling, PaintModel, StepReport, Transfer};

use crate::scene::{Scene, lying};

/// Tolerances between two backends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near {
    /// Tolerated difference, quanta, of a count on a cell, and of one on the brush, where many cells draw on a texel.
    pub(crate) quanta: [f32; 2],
    /// Tolerated share of the counts of either kind that differ more, and of the cells that only one touches.
    pub(crate) beyond: f64,
}

/// Does one step and settles it.
fn step(model: &mut dyn PaintModel, scene: &mut Scene, lasting: bool) -> StepReport {
    let mut step = scene.step();
    step.lasting = lasting;
    let mut report = model.step(&mut step);
    let Scene { window, load, .. } = scene;
    report.add(&model.settle(window, load));
    report
}

/// Differences between two scenes of counts on cells, and on the brush.
fn apart(one: &Scene, two: &Scene) -> [Vec<f32>; 2] {
    let mut apart = [const { Vec::new() }; 2];
    for slot in 0..SLOTS {
        let planes = [one, two].map(|scene| scene.window.plane(slot).unwrap_or_default());
        let pairs = planes[0].iter().zip(planes[1]);
        apart[0].extend(pairs.map(|(a, b)| (a - b).abs()));
        for part in [BrushLoad::film_of, BrushLoad::inside] {
            let [a, b] = [one, two].map(|scene| part(&scene.load, slot).unwrap_or_default());
            apart[1].extend(a.iter().zip(b).map(|(a, b)| a.abs_diff(*b) as f32));
        }
    }
    apart
}

fn after(counts: &Counts, report: &StepReport) -> Counts {
    std::array::from_fn(|slot| {
        let changed = report.from_nowhere[slot] - report.lifted[slot] as i64;
        counts[slot].saturating_add_signed(changed)
    })
}

/// A way to use a brush.
struct Mode {
    name: &'static str,
    handling: Handling,
    thinner: Option<usize>,
    lasting: bool,
}

impl Mode {
    fn of(name: &'static str, handling: Handling) -> Self {
        Self {
            name,
            handling,
            thinner: None,
            lasting: false,
        }
    }

    fn transferring(name: &'static str, transfer: Transfer) -> Self {
        let handling = Handling {
            transfer,
            ..Handling::default()
        };
        Self::of(name, handling)
    }

    /// This mode in a scene.
    fn set(&self, mut scene: Scene) -> Scene {
        (scene.handling, scene.thinner) = (self.handling, self.thinner);
        scene
    }
}

fn modes() -> [Mode; 9] {
    let painting = Handling::default();
    let unpushed = Handling {
        push: false,
        ..painting
    };
    let thin = Handling {
        most: 150_000.5,
        ..painting
    };
    [
        Mode::of("paint", painting),
        Mode {
            thinner: Some(4),
            ..Mode::of("thinned", painting)
        },
        Mode::of("unpushed", unpushed),
        Mode::of("thin", thin),
        Mode {
            lasting: true,
            ..Mode::of("lasting", painting)
        },
        Mode::transferring("sponge", Transfer::Sponge),
        Mode::transferring("marker", Transfer::Marker { flow: 0.002 }),
        Mode::transferring("sampler", Transfer::Sampler),
        Mode::transferring("vacuum", Transfer::Vacuum),
    ]
}

/// The totals of a step on the device agree with those of the processor.
fn check_report(got: &StepReport, want: &StepReport, beyond: f64, what: &str) {
    let cells = [got, want].map(|report| report.footprint_cells);
    let few = (beyond * cells[1] as f64) as u64;
    assert!(cells[0].abs_diff(cells[1]) <= few, "{what}: {cells:?}");
    for [got, want] in [[got.wet, want.wet], [got.thinner, want.thinner]] {
        let off = (got as f64 / want.max(1) as f64 - 1.0).abs();
        assert!(want == 0 || off < 0.01, "{what}: {got} {want}");
    }
}

/// Differences of two backends in the steps of a mode.
#[derive(Default)]
struct Differences {
    /// Of counts on cells, and of those on the brush.
    off: [Vec<f32>; 2],
    /// Greatest change of a count by a step.
    did: f32,
}

impl Differences {
    fn add(&mut self, before: &Scene, on_cpu: &Scene, on_gpu: &Scene) {
        for (all, own) in self.off.iter_mut().zip(apart(on_cpu, on_gpu)) {
            all.extend(own);
        }
        let changes = apart(before, on_gpu);
        self.did = changes.into_iter().flatten().fold(self.did, f32::max);
    }

    fn check(&self, name: &str, near: Near) {
        let mut alike = true;
        for (off, quanta) in self.off.iter().zip(near.quanta) {
            let worst = off.iter().copied().fold(0.0, f32::max);
            let beyond = off.iter().filter(|off| **off > quanta).count();
            println!(
                "{name}: {beyond} of {} counts off, by {worst} of {}",
                off.len(),
                self.did
            );
            alike &= beyond as f64 <= near.beyond * off.len() as f64;
        }
        assert!(alike && self.did > 1000.0, "{name}");
    }
}

/// In these scenes the device agrees with the processor in every mode.
pub(crate) fn agree(
    gpu: &mut dyn PaintModel,
    cpu: &mut dyn PaintModel,
    near: Near,
    scene_of: fn(u64) -> Scene,
) {
    for mode in modes() {
        let mut differences = Differences::default();
        for seed in 0..4 {
            let what = format!("{} {seed}", mode.name);
            let scene = || mode.set(scene_of(seed));
            let (mut on_cpu, mut on_gpu) = (scene(), scene());
            let counts = on_gpu.counts();
            let want = step(cpu, &mut on_cpu, mode.lasting);
            let got = step(gpu, &mut on_gpu, mode.lasting);
            check_report(&got, &want, near.beyond, &what);
            assert_eq!(on_gpu.counts(), after(&counts, &got), "{what}");
            lying(&on_gpu.window);
            differences.add(&scene(), &on_cpu, &on_gpu);
        }
        differences.check(mode.name, near);
    }
}
