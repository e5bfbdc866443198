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

/// In these scenes the device agrees with the processor in every mode.
pub(crate) fn agree(
    gpu: &mut dyn PaintModel,
    cpu: &mut dyn PaintModel,
    near: Near,
    scene_of: fn(u64) -> Scene,
) {
    let painting = Handling::default();
    let with = |transfer| Handling {
        transfer,
        ..painting
    };
    for (name, handling, thinner) in [
        ("paint", painting, None),
        ("thinned", painting, Some(4)),
        (
            "unpushed",
            Handling {
                push: false,
                ..painting
            },
            None,
        ),
        (
            "thin",
            Handling {
                most: 150_000.5,
                ..painting
            },
            None,
        ),
        ("lasting", painting, None),
        ("sponge", with(Transfer::Sponge), None),
        ("marker", with(Transfer::Marker { flow: 0.002 }), None),
        ("sampler", with(Transfer::Sampler), None),
        ("vacuum", with(Transfer::Vacuum), None),
    ] {
        let lasting = name == "lasting";
        let (mut off, mut did) = ([const { Vec::new() }; 2], 0.0f32);
        for seed in 0..4 {
            let scene = || {
                let mut scene = scene_of(seed);
                (scene.handling, scene.thinner) = (handling, thinner);
                scene
            };
            let (mut on_cpu, mut on_gpu) = (scene(), scene());
            let counts = on_gpu.counts();
            let want = step(cpu, &mut on_cpu, lasting);
            let got = step(gpu, &mut on_gpu, lasting);
            let cells = [got, want].map(|report| report.footprint_cells);
            let few = (near.beyond * cells[1] as f64) as u64;
            assert!(
                cells[0].abs_diff(cells[1]) <= few,
                "{name} {seed}: {cells:?}"
            );
            assert_eq!(on_gpu.counts(), after(&counts, &got), "{name} {seed}");
            lying(&on_gpu.window);
            let share = |got: u64, want: u64| (got as f64 / want.max(1) as f64 - 1.0).abs();
            assert!(
                want.wet == 0 || share(got.wet, want.wet) < 0.01,
                "{got:?} {want:?}"
            );
            assert!(
                want.thinner == 0 || share(got.thinner, want.thinner) < 0.01,
                "{got:?} {want:?}"
            );
            for (all, own) in off.iter_mut().zip(apart(&on_cpu, &on_gpu)) {
                all.extend(own);
            }
            did = apart(&scene(), &on_gpu)
                .into_iter()
                .flatten()
                .fold(did, f32::max);
        }
        let mut alike = true;
        for (off, quanta) in off.iter().zip(near.quanta) {
            let worst = off.iter().copied().fold(0.0, f32::max);
            let beyond = off.iter().filter(|off| **off > quanta).count();
            println!(
                "{name}: {beyond} of {} counts off, by {worst} of {did}",
                off.len()
            );
            alike &= beyond as f64 <= near.beyond * off.len() as f64;
        }
        assert!(alike && did > 1000.0, "{name}");
    }
}
