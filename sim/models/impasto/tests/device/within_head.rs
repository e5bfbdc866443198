//! Paint within the head, after the earlier stages, compared with the processor's.

use maulstick_canvas::quantum::SLOTS;
use maulstick_impasto::device::probe::Prober;
use maulstick_impasto::stages::bristle_flow::flow;
use maulstick_impasto::stages::seep::seep;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::TEXELS_PER_STRIP;
use maulstick_model::footprint::contact::Contact;

use crate::device;
use crate::probed::{run, stepped};
use crate::scene::Scene;

/// A scene in which no paint is pushed, and so none over the border.
fn scene(seed: u64, steps: u64) -> Scene {
    let mut scene = crate::probed::scene(seed, steps);
    scene.handling.push = false;
    scene
}

/// Seeping between and along bristles agrees with the processor's, in either order, after the flow: two passes, each
/// with an error of up to a quantum.
#[test]
fn paint_seeps_between_strips() {
    let mut prober = Prober::new(device()).expect("taken");
    for steps in [3, 7, 11, 15] {
        let mut flowed = scene(steps, steps);
        run(&mut prober, &mut flowed, "bristle_flow");
        let mut seeped = scene(steps, steps);
        let counts = seeped.counts();
        run(&mut prober, &mut seeped, "seep");
        assert_eq!(seeped.counts(), counts, "after {steps} steps");
        let off = |turn: u64| {
            let mut scene = scene(steps, steps);
            scene.load = stepped(&flowed.load, turn);
            seep(&mut scene.step());
            let films = |load: &BrushLoad| {
                let planes = (0..SLOTS).filter_map(|slot| load.film_of(slot).map(<[u32]>::to_vec));
                planes.chain([load.films().to_vec()]).collect::<Vec<_>>()
            };
            let (one, two) = (films(&scene.load), films(&seeped.load));
            assert_eq!(one.len(), two.len());
            let pairs = one.iter().flatten().zip(two.iter().flatten());
            pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
        };
        let worst = off(steps + 1);
        println!("after {steps} steps: films off by {worst}");
        assert!(worst <= 4, "after {steps} steps: {worst}");
        for faulty in [steps + 2, steps + 3] {
            assert!(off(faulty) > 4, "another turn passes");
        }
    }
}

/// The flow agrees with the processor's after the exchange: within 2 quanta of film and 6 inside, like its oracle, in
/// all strips, including those without contact.
#[test]
fn paint_flows_within_all_strips() {
    let mut prober = Prober::new(device()).expect("taken");
    for seed in 0..6 {
        // Without flow the exchange's result stays.
        let mut still = scene(seed, 1);
        still.thinner = [None, Some(2)][seed as usize % 2];
        (still.traits.refill, still.traits.creep) = (0.0, 0.0);
        let probe = run(&mut prober, &mut still, "bristle_flow");
        let mut flowed = scene(seed, 1);
        flowed.thinner = still.thinner;
        let counts = flowed.counts();
        run(&mut prober, &mut flowed, "bristle_flow");
        assert_eq!(flowed.counts(), counts, "scene {seed}");
        let not_flowed = still.load.clone();
        still.traits = flowed.traits;
        flow(&mut still.step());
        let mut touched = vec![false; still.head.strips()];
        let strip = |contact: &Contact| contact.texel as usize / TEXELS_PER_STRIP;
        let contacts = probe.contacts.iter();
        contacts.for_each(|contact| touched[strip(contact)] = true);
        let off = |one: &BrushLoad, two: &BrushLoad, of_touched: bool| {
            let mut worst = [0u32; 2];
            for slot in 0..SLOTS {
                let parts = [
                    (one.film_of(slot), two.film_of(slot)),
                    (one.inside(slot), two.inside(slot)),
                ];
                for (worst, (one, two)) in worst.iter_mut().zip(parts) {
                    let pairs = one.unwrap_or_default().iter().zip(two.unwrap_or_default());
                    let pairs = pairs.enumerate();
                    let pairs =
                        pairs.filter(|(texel, _)| touched[texel / TEXELS_PER_STRIP] == of_touched);
                    *worst = pairs.fold(*worst, |worst, (_, (a, b))| worst.max(a.abs_diff(*b)));
                }
            }
            worst
        };
        for of_touched in [true, false] {
            let worst = off(&flowed.load, &still.load, of_touched);
            println!("scene {seed}, touched {of_touched}: film and inside off by {worst:?}");
            assert!(worst[0] <= 2 && worst[1] <= 6, "scene {seed}: {worst:?}");
            let fault = off(&flowed.load, &not_flowed, of_touched);
            let some = touched.contains(&of_touched);
            assert!(!some || fault[1] > 6, "no flow passes: {fault:?}");
        }
        assert!(
            touched.contains(&true) && touched.contains(&false),
            "scene {seed}"
        );
        let films = (0..still.load.texels()).map(|texel| flowed.load.film(texel));
        let counted = films.enumerate().all(|(texel, film)| {
            let of = (0..SLOTS).filter_map(|slot| flowed.load.film_of(slot));
            film == of.map(|film| film[texel]).sum::<u32>()
        });
        assert!(counted, "scene {seed}");
    }
}
