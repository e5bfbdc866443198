//! Paint within the head: out to a film that lacks some, in from one with an excess, and along.

use maulstick_brush::Head;
use maulstick_canvas::quantum::SLOTS;
use maulstick_impasto::stages::bristle_flow::flow;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::{BrushTraits, TEXELS_PER_STRIP};

use crate::scene::{Scene, brush};

/// Truncation: twice at a film, and inside also at both ends of two flows.
const FILM_BOUND: f64 = 2.0;
const INSIDE_BOUND: f64 = 6.0;

type Texels = [[f64; TEXELS_PER_STRIP]; SLOTS];

/// Film and inside of a strip, by slot.
fn strip_of(load: &BrushLoad, strip: usize) -> [Texels; 2] {
    let run = strip * TEXELS_PER_STRIP..(strip + 1) * TEXELS_PER_STRIP;
    let copy = |plane: Option<&[u32]>| {
        plane.map_or([0.0; TEXELS_PER_STRIP], |plane| {
            std::array::from_fn(|k| f64::from(plane[run.clone()][k]))
        })
    };
    [
        std::array::from_fn(|slot| copy(load.film_of(slot))),
        std::array::from_fn(|slot| copy(load.inside(slot))),
    ]
}

fn oracle([film, inside]: &[Texels; 2], full: f64, traits: &BrushTraits) -> [Texels; 2] {
    let sum = |plane: &Texels, k: usize| plane.iter().map(|slot| slot[k]).sum::<f64>();
    let [mut new_film, mut new_inside] = [*film, *inside];
    for k in 0..TEXELS_PER_STRIP {
        let (f, i) = (sum(film, k), sum(inside, k));
        let falls = |to: Option<usize>| {
            let there = to
                .filter(|to| *to < TEXELS_PER_STRIP)
                .map_or(i, |to| sum(inside, to));
            (traits.creep * (i - there)).max(0.0)
        };
        let missing = (full - f).max(0.0);
        let mut leaves = [
            traits.refill * missing.min(i),
            falls(Some(k + 1)),
            falls(k.checked_sub(1)),
        ];
        let wanted: f64 = leaves.iter().sum();
        if wanted > i {
            leaves = leaves.map(|amount| amount * i / wanted);
        }
        let over = traits.refill * (f - full).max(0.0);
        for slot in 0..SLOTS {
            let [rises, onward, back] = leaves.map(|amount| amount * inside[slot][k] / i.max(1.0));
            let sinks = over * film[slot][k] / f.max(1.0);
            new_film[slot][k] += rises - sinks;
            new_inside[slot][k] += sinks - rises - onward - back;
            if onward > 0.0 {
                new_inside[slot][k + 1] += onward;
            }
            if back > 0.0 {
                new_inside[slot][k - 1] += back;
            }
        }
    }
    [new_film, new_inside]
}

fn agrees(got: &[Texels; 2], want: &[Texels; 2]) -> bool {
    [FILM_BOUND, INSIDE_BOUND]
        .iter()
        .enumerate()
        .all(|(part, bound)| {
            let (got, want) = (got[part].iter().flatten(), want[part].iter().flatten());
            got.zip(want).all(|(a, b)| (a - b).abs() <= *bound)
        })
}

/// On the reference cell, and on coarse cells, where a step is long and all paint may leave at once.
#[test]
fn paint_flows_within_all_strips_and_none_is_lost() {
    for (seed, cell_m) in (0..24).zip([2.5e-4, 1e-3, 2e-3, 1e-2].into_iter().cycle()) {
        let mut scene = Scene::new(seed);
        let coarse = BrushTraits::of(&brush(24, 0.25), cell_m, 1.0);
        (scene.traits.refill, scene.traits.creep) = (coarse.refill, coarse.creep);
        empty_some(&mut scene.load, &scene.head);
        let before = scene.counts();
        let strips = scene.head.strips();
        let held: Vec<_> = (0..strips).map(|s| strip_of(&scene.load, s)).collect();
        flow(&mut scene.step());
        assert_eq!(scene.counts(), before, "scene {seed}");
        for strip in 0..strips {
            let mut got = strip_of(&scene.load, strip);
            let full = scene.traits.film_full * f64::from(scene.head.capacity()[strip]);
            let want = oracle(&held[strip], full, &scene.traits);
            assert!(agrees(&got, &want), "strip {strip} of scene {seed}");
            assert!(!agrees(&held[strip], &want), "no flow in {strip} passes");
            let sum = |film: &Texels, k: usize| film.iter().map(|slot| slot[k]).sum::<f64>();
            for k in 0..TEXELS_PER_STRIP {
                let (from, to) = (sum(&held[strip][0], k), sum(&got[0], k));
                assert!(
                    from.min(full) <= to && to <= from.max(full),
                    "away from full"
                );
                assert_eq!(f64::from(scene.load.film(strip * TEXELS_PER_STRIP + k)), to);
            }
            got[1][2][5] += 10.0 * INSIDE_BOUND;
            assert!(!agrees(&got, &want), "a fault in scene {seed} passes");
        }
    }
}

/// Empties texels beside full ones: the steepest differences.
fn empty_some(load: &mut BrushLoad, head: &Head) {
    for slot in 0..SLOTS {
        let Some((_, inside)) = load.planes_mut(slot) else {
            continue;
        };
        for texel in (0..head.strips() * TEXELS_PER_STRIP).filter(|texel| texel % 3 != 1) {
            inside[texel] = 0;
        }
    }
}

#[test]
fn a_used_up_film_fills_again() {
    let mut scene = Scene::new(5);
    for slot in 0..SLOTS {
        if let Some((film, inside)) = scene.load.planes_mut(slot) {
            film.fill(0);
            inside.fill(scene.traits.film_full as u32);
        }
    }
    scene.load.count_films();
    let full = scene.traits.film_full * f64::from(scene.head.capacity()[0]);
    for _ in 0..100 {
        flow(&mut scene.step());
    }
    let film = f64::from(scene.load.film(7));
    assert!((0.99..=1.0).contains(&(film / full)), "{film} of {full}");
}
