//! Whole steps of a brush that is used otherwise than for painting, beside those of the processor.

use maulstick_gpu::GpuImpasto;
use maulstick_paint::impasto::Impasto;
use maulstick_paint::model::{Handling, PaintModel, StepReport, Transfer};
use maulstick_paint::quantum::{Counts, SLOTS};

use crate::device;
use crate::scene::{Scene, lying};

/// Quanta by which a count may be off: one through each of the stages.
const QUANTA: f32 = 4.0;

/// Does one step and settles it.
fn step(model: &mut impl PaintModel, scene: &mut Scene) -> StepReport {
    let mut report = model.step(&mut scene.step());
    let Scene { window, load, .. } = scene;
    report.add(&model.settle(window, load));
    report
}

/// The farthest that a count of two scenes is apart.
fn apart(one: &Scene, two: &Scene) -> f32 {
    let mut worst = 0.0f32;
    for slot in 0..SLOTS {
        let planes = [one, two].map(|scene| scene.window.plane(slot).unwrap_or_default());
        let pairs = planes[0].iter().zip(planes[1]);
        worst = pairs.fold(worst, |worst, (a, b)| worst.max((a - b).abs()));
        for plane in [
            |scene: &Scene, slot| scene.load.film_of(slot).map(<[u32]>::to_vec),
            |scene, slot| scene.load.inside(slot).map(<[u32]>::to_vec),
        ] {
            let [a, b] = [one, two].map(|scene| plane(scene, slot).unwrap_or_default());
            let pairs = a.iter().zip(&b);
            worst = pairs.fold(worst, |worst, (a, b)| worst.max(a.abs_diff(*b) as f32));
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
        ("sponge", with(Transfer::Sponge), None),
        ("marker", with(Transfer::Marker { flow: 0.002 }), None),
        ("sampler", with(Transfer::Sampler), None),
        ("vacuum", with(Transfer::Vacuum), None),
    ] {
        let (mut worst, mut did) = (0.0f32, 0.0f32);
        for seed in 0..4 {
            let scene = || {
                let mut scene = Scene::new(seed);
                (scene.handling, scene.thinner) = (handling, thinner);
                scene
            };
            let (mut on_cpu, mut on_gpu) = (scene(), scene());
            let counts = on_gpu.counts();
            let want = step(&mut Impasto::default(), &mut on_cpu);
            let got = step(&mut gpu, &mut on_gpu);
            assert_eq!(got.footprint_cells, want.footprint_cells, "{name} {seed}");
            assert_eq!(on_gpu.counts(), after(&counts, &got), "{name} {seed}");
            lying(&on_gpu.window);
            let share = |got: u64, want: u64| (got as f64 / want.max(1) as f64 - 1.0).abs();
            assert!(
                want.wet == 0 || share(got.wet, want.wet) < 0.01,
                "{got:?} {want:?}"
            );
            assert!(want.thinner == 0 || share(got.thinner, want.thinner) < 0.01);
            worst = worst.max(apart(&on_cpu, &on_gpu));
            did = did.max(apart(&scene(), &on_gpu));
        }
        println!("{name}: off by {worst} of {did}");
        assert!(worst <= QUANTA && did > 1000.0, "{name}: {worst} {did}");
    }
}
