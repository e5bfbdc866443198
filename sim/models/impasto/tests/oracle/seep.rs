//! Paint between bristles: the fuller of two neighbouring films gives, of its own mixture.

use maulstick_canvas::quantum::SLOTS;
use maulstick_impasto::stages::seep::seep;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::{BrushTraits, Seep, TEXELS_PER_STRIP};

use crate::scene::{Scene, brush};

/// Tolerance: a film exchanges once across and once along, both truncated, and its second share is of a count with the
/// first error.
const BOUND: f64 = 4.0;

/// Difference between the films of two strips that remains, as a share of a full film.
const HOLDS: f64 = 0.3;

/// Films by slot and texel.
type Films = Vec<Vec<f64>>;

fn films_of(load: &BrushLoad) -> Films {
    let film = |slot: usize| match load.film_of(slot) {
        Some(film) => film.iter().map(|count| f64::from(*count)).collect(),
        None => vec![0.0; load.texels()],
    };
    (0..SLOTS).map(film).collect()
}

fn total(films: &Films, texel: usize) -> f64 {
    films.iter().map(|film| film[texel]).sum()
}

/// Moves half the share of the unheld difference from the fuller film to the other, of the parts above `clings`; a share
/// of 1 leaves the held difference.
fn even_out(films: &mut Films, [a, b]: [usize; 2], share: f64, [holds, clings]: [f64; 2]) {
    let (one, other) = (total(films, a), total(films, b));
    let (from, to) = if one > other { (a, b) } else { (b, a) };
    let full = one.max(other);
    let falls = (one.max(clings) - other.max(clings)).abs() - holds;
    if falls <= 0.0 {
        return;
    }
    for film in films {
        let goes = 0.5 * share * falls * film[from] / full;
        film[from] -= goes;
        film[to] += goes;
    }
}

/// Films after a turn: between strips of one order, in pairs, and along strips; pairs start at the first and at the
/// second in turn.
fn oracle(scene: &Scene, seep: Seep, holds: f64) -> Films {
    let holds = holds * scene.traits.film_full;
    let turn = scene.load.steps();
    let mut films = films_of(&scene.load);
    let order = &scene.head.beside()[(turn % 2) as usize];
    let first = (turn / 2 % 2) as usize;
    for pair in order[first..].chunks_exact(2) {
        for k in 0..TEXELS_PER_STRIP {
            let texels = [0, 1].map(|side| pair[side] as usize * TEXELS_PER_STRIP + k);
            even_out(&mut films, texels, seep.beside, [holds, 0.0]);
        }
    }
    for strip in 0..scene.head.strips() {
        let first = (scene.load.steps() as usize + strip) % 2;
        for k in (first..TEXELS_PER_STRIP - 1).step_by(2) {
            even_out(
                &mut films,
                [
                    strip * TEXELS_PER_STRIP + k,
                    strip * TEXELS_PER_STRIP + k + 1,
                ],
                seep.along,
                [0.0, seep.clings],
            );
        }
    }
    films
}

fn agrees(got: &Films, want: &Films) -> bool {
    let (got, want) = (got.iter().flatten(), want.iter().flatten());
    got.zip(want).all(|(a, b)| (a - b).abs() <= BOUND)
}

fn spread(load: &BrushLoad) -> f64 {
    let films = load.films().iter().map(|film| f64::from(*film));
    let mean = films.clone().sum::<f64>() / load.texels() as f64;
    films.map(|film| (film - mean) * (film - mean)).sum()
}

#[test]
fn the_fuller_film_gives_and_none_is_lost() {
    // Scenes that tell each fault apart; not all can, as films that cling do not flow along strips.
    let mut told = [0; 4];
    for seed in 0..16 {
        let mut scene = Scene::new(seed);
        let cell_m = [2.5e-4, 1e-3, 1e-2][seed as usize % 3];
        scene.traits.seep = BrushTraits::of(&brush(24, 0.25), cell_m, 1.0).seep;
        for _ in 0..=seed % 7 {
            scene.load.count_step();
        }
        let (before, held) = (scene.counts(), films_of(&scene.load));
        let uneven = spread(&scene.load);
        let want = oracle(&scene, scene.traits.seep, HOLDS);
        let own = scene.traits.seep;
        let less = |part: [f64; 3]| Seep {
            beside: part[0] * own.beside,
            along: part[1] * own.along,
            clings: part[2] * own.clings,
        };
        let others = [
            (less([0.9, 1.0, 1.0]), HOLDS),
            (less([1.0, 0.9, 1.0]), HOLDS),
            (less([1.0, 1.0, 0.9]), HOLDS),
            (own, 0.9 * HOLDS),
        ]
        .map(|(seep, holds)| oracle(&scene, seep, holds));
        seep(&mut scene.step());
        let mut got = films_of(&scene.load);
        assert_eq!(scene.counts(), before, "scene {seed}");
        assert!(agrees(&got, &want), "scene {seed}");
        assert!(!agrees(&held, &want), "films that do not seep pass");
        for (told, other) in told.iter_mut().zip(&others) {
            *told += usize::from(!agrees(&got, other));
        }
        assert!(spread(&scene.load) < uneven, "films even out");
        for texel in 0..scene.load.texels() {
            let counted = f64::from(scene.load.film(texel));
            assert_eq!(counted, total(&got, texel), "counted afresh");
        }
        got[2][5] += 10.0 * BOUND;
        assert!(!agrees(&got, &want), "a fault in scene {seed} passes");
    }
    assert!(told.iter().all(|told| *told > 8), "others pass: {told:?}");
}

/// Equal films exchange nothing: adjacent colours stay distinct.
#[test]
fn equal_films_of_two_colours_stay_two() {
    let mut scene = Scene::new(3);
    let wet = 2 * scene.traits.film_full as u32;
    let mut load = BrushLoad::clean(scene.head.strips());
    for texel in 0..load.texels() {
        load.add_film(texel / TEXELS_PER_STRIP % 2, texel, wet);
    }
    load.count_films();
    scene.load = load;
    for _ in 0..40 {
        scene.load.count_step();
        let before = scene.load.clone();
        seep(&mut scene.step());
        assert!(scene.load == before);
    }
    scene.load.add_film(0, 0, wet);
    scene.load.count_films();
    let before = films_of(&scene.load);
    for _ in 0..4 {
        scene.load.count_step();
        seep(&mut scene.step());
    }
    assert!(films_of(&scene.load) != before, "the test cannot tell");
}

/// The whole head feeds the bristles that touch: a film that is repeatedly used up gets paint from strips that are not
/// beside it.
#[test]
fn the_whole_head_feeds_a_bristle() {
    let mut scene = Scene::new(4);
    let full = scene.traits.film_full as u32;
    let mut load = BrushLoad::clean(scene.head.strips());
    for texel in 0..load.texels() {
        load.add_film(0, texel, full);
    }
    load.count_films();
    scene.load = load;
    let before = scene.load.total();
    let mut used = 0;
    for _ in 0..2400 {
        let left = scene.load.set_texel(0, 7, [0, 0]);
        used += u64::from(left[0]);
        scene.load.count_films();
        scene.load.count_step();
        seep(&mut scene.step());
    }
    assert_eq!(scene.load.total() + used, before);
    assert!(
        used > 3 * TEXELS_PER_STRIP as u64 * u64::from(full),
        "{used}"
    );
}
