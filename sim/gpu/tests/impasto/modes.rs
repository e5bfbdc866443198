//! Whole steps of a brush that is used otherwise than for painting, beside those of the processor.

use maulstick_canvas::quantum::{Counts, SLOTS};
use maulstick_gpu::GpuImpasto;
use maulstick_impasto::Impasto;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::interface::{Handling, PaintModel, StepReport, Transfer};

use crate::device;
use crate::scene::{Scene, lying};

/// Quanta by which a count on a cell may be off, and one on the brush, where many cells draw on a texel.
const QUANTA: [f32; 2] = [4.0, 24.0];

/// Does one step and settles it.
fn step(model: &mut impl PaintModel, scene: &mut Scene, lasting: bool) -> StepReport {
    let mut step = scene.step();
    step.lasting = lasting;
    let mut report = model.step(&mut step);
    let Scene { window, load, .. } = scene;
    report.add(&model.settle(window, load));
    report
}

/// The farthest that counts on cells, and on the brush, of two scenes are apart.
fn apart(one: &Scene, two: &Scene) -> [f32; 2] {
    let mut worst = [0.0f32; 2];
    for slot in 0..SLOTS {
        let planes = [one, two].map(|scene| scene.window.plane(slot).unwrap_or_default());
        let pairs = planes[0].iter().zip(planes[1]);
        worst[0] = pairs.fold(worst[0], |worst, (a, b)| worst.max((a - b).abs()));
        for part in [BrushLoad::film_of, BrushLoad::inside] {
            let [a, b] = [one, two].map(|scene| part(&scene.load, slot).unwrap_or_default());
            let pairs = a.iter().zip(b);
            worst[1] = pairs.fold(worst[1], |worst, (a, b)| worst.max(a.abs_diff(*b) as f32));
        }
    }
    worst
}

fn after(counts: &Counts, report: &StepReport) -> Counts {
    std::array::from_fn(|slot| {
        let changed = report.from_nowhere[slot] - report.lifted[slot] as i64;
        counts[slot].saturating_add_signed(changed)
    })
}

#[test]
fn every_mode_does_what_the_processor_does() {
    let mut gpu = GpuImpasto::new(device()).expect("taken");
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
        let (mut worst, mut did) = ([0.0f32; 2], 0.0f32);
        for seed in 0..4 {
            let scene = || {
                let mut scene = Scene::new(seed);
                (scene.handling, scene.thinner) = (handling, thinner);
                scene
            };
            let (mut on_cpu, mut on_gpu) = (scene(), scene());
            let counts = on_gpu.counts();
            let want = step(&mut Impasto::default(), &mut on_cpu, lasting);
            let got = step(&mut gpu, &mut on_gpu, lasting);
            assert_eq!(got.footprint_cells, want.footprint_cells, "{name} {seed}");
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
            let off = apart(&on_cpu, &on_gpu);
            (0..2).for_each(|i| worst[i] = worst[i].max(off[i]));
            did = apart(&scene(), &on_gpu).into_iter().fold(did, f32::max);
        }
        println!("{name}: off by {worst:?} of {did}");
        let near = worst[0] <= QUANTA[0] && worst[1] <= QUANTA[1];
        assert!(near && did > 1000.0, "{name}: {worst:?} {did}");
    }
}
