//! Refilling of strips from their reservoirs after the blends, compared with the processor's.

use maulstick_canvas::quantum::SLOTS;
use maulstick_dab::device::probe::{Probe, Prober};
use maulstick_dab::dither::Dither;
use maulstick_dab::first_blend;
use maulstick_dab::reservoir::{Refill, refill};
use maulstick_dab::stroke::{Course, Stroker};
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::TEXELS_PER_STRIP;

use crate::device;
use crate::scene::Scene;

/// The same scene after `steps` steps of its brush.
fn scene(seed: u64, steps: u64) -> Scene {
    let mut scene = Scene::far(seed, 4.0);
    (0..steps).for_each(|_| scene.load.count_step());
    // So that a whole deep unit moves now and then, with a few texels of quanta.
    scene.traits.film_full *= 40.0;
    scene.traits.inside_full *= 40.0;
    for slot in 0..SLOTS {
        if let Some((film, inside)) = scene.load.planes_mut(slot) {
            film.iter_mut().for_each(|count| *count *= 20);
            inside.iter_mut().for_each(|count| *count *= 40);
        }
    }
    scene.load.count_films();
    scene
}

/// The processor's result on a load with the strips under a probe, with the thresholds of this step.
fn filled(scene: &mut Scene, probe: &Probe, number: u64) {
    let step = scene.step();
    let way = Course::of(&step.sweep, None).way;
    let cells = (way[0] * way[0] + way[1] * way[1]).sqrt();
    let flows = Refill::of(&step.traits, cells);
    let dither = Dither::new(step.load.seed(), first_blend(number));
    let over = |strip: &usize| {
        let strip_of = |texel: u32| texel as usize / TEXELS_PER_STRIP;
        probe.over.iter().any(|over| strip_of(over.texel) == *strip)
    };
    let strips: Vec<usize> = (0..scene.head.strips()).filter(over).collect();
    refill(&mut scene.load, &flows, strips, dither);
    scene.load.count_films();
}

/// The largest difference of a paint's counts on and in a strip, as a share of the largest count: the amount that moves
/// is a share of one of its texels.
fn apart(one: &BrushLoad, two: &BrushLoad) -> f64 {
    let mut worst = 0.0f64;
    for slot in (0..SLOTS).filter(|slot| one.has(*slot)) {
        let [one, two] = [one, two].map(|load| {
            [BrushLoad::film_of, BrushLoad::inside].map(|part| part(load, slot).unwrap_or_default())
        });
        for strip in 0..one[0].len() / TEXELS_PER_STRIP {
            let texels = strip * TEXELS_PER_STRIP..(strip + 1) * TEXELS_PER_STRIP;
            let [one, two] =
                [&one, &two].map(|parts| parts.map(|part| &part[texels.clone()]).concat());
            let largest = one.iter().chain(&two).max().copied().unwrap_or_default();
            let off = one.iter().zip(&two).map(|(a, b)| a.abs_diff(*b)).max();
            worst = worst.max(f64::from(off.unwrap_or_default()) / f64::from(largest.max(4096)));
        }
    }
    worst
}

#[test]
fn reservoirs_fill_surfaces_again() {
    let mut prober = Prober::new(device(), Stroker::Faster).expect("taken");
    let mut flowed = 0;
    for seed in 0..6 {
        // The load after the blends, without refilling.
        let mut before = scene(seed, seed);
        before.traits.refill = 0.0;
        let probe = prober.run(&mut before.step(), "refill");
        let probe = probe.expect("done").expect("on the surface");
        let mut on_gpu = scene(seed, seed);
        let number = on_gpu.load.steps();
        let counts = on_gpu.load.total();
        prober.run(&mut on_gpu.step(), "refill").expect("done");
        let lies = |scene: &Scene| scene.counts();
        assert_eq!(lies(&on_gpu), lies(&before), "scene {seed}");
        assert_eq!(on_gpu.load.steps(), number + 1);
        let on_cpu = |number: u64| {
            let mut scene = scene(seed, seed);
            scene.load.clone_from(&before.load);
            filled(&mut scene, &probe, number);
            scene.load
        };
        // Several roundings of f32 in a step.
        let off = apart(&on_gpu.load, &on_cpu(number));
        println!("scene {seed}: counts off by {off:.1e}");
        assert!(off < 2e-6, "scene {seed}: {off}");
        let mut recounted = on_gpu.load.clone();
        recounted.count_films();
        assert!(
            recounted == on_gpu.load,
            "scene {seed}: films are not counted"
        );
        assert!(
            apart(&on_gpu.load, &on_cpu(number + 1)) > 1e-3,
            "other thresholds pass"
        );
        flowed += usize::from(apart(&on_gpu.load, &before.load) > 1e-3);
        assert!(counts > 0);
    }
    assert_eq!(flowed, 6);
}
