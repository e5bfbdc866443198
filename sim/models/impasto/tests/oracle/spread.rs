//! What a contact gives is spread evenly along a step of several cells, over cells that its bristles touch, too.

use std::collections::{BTreeMap, BTreeSet};

use maulstick_canvas::quantum::SLOTS;
use maulstick_impasto::stages::exchange::Exchange;
use maulstick_model::footprint::Footprint;

use crate::exchange::{Expected, PRESS, RULES, film, on, oracle};
use crate::scene::Scene;

/// Shares of a bar of `length` cells on the cells beside the one that its middle lies in, wherever in it.
fn bar(length: usize) -> Vec<f64> {
    const PLACES: usize = 64;
    let half = length as f64 / 2.0;
    let overlap = |off: usize, middle: f64| {
        let [from, to] = [off as f64 - 0.5, off as f64 + 0.5];
        (to.min(middle + half) - from.max(middle - half)).max(0.0)
    };
    let share = |off: usize| {
        let places = (0..PLACES).map(|place| (place as f64 + 0.5) / PLACES as f64 - 0.5);
        places.map(|middle| overlap(off, middle)).sum::<f64>() / (PLACES * length) as f64
    };
    (1..=length.div_ceil(2)).map(share).collect()
}

/// A cell's change: quanta that leave, quanta that come, and their tolerance.
type Changes = BTreeMap<(usize, usize), [f64; 3]>;

/// Direction of a head's motion: the axis along which it is longer, and cells along the other one in one along this.
fn direction(scene: &Scene) -> (usize, f64) {
    let way = |from: &[f32], to: &[f32]| -> f32 { to.iter().zip(from).map(|(b, a)| b - a).sum() };
    let (from, to) = (&scene.from, &scene.to);
    let moved = [way(&from.x, &to.x), way(&from.y, &to.y)].map(f64::from);
    let axis = usize::from(moved[1].abs() > moved[0].abs());
    (axis, moved[1 - axis] / moved[axis])
}

/// Cells beside a cell along a step of `length` cells, each with its share of a deposit.
fn beside(footprint: &Footprint, scene: &Scene, cell: usize, length: usize) -> Vec<(usize, f64)> {
    let width = scene.window.width();
    let (axis, slope) = direction(scene);
    let length = ((length as f64 / (1.0 + slope * slope).sqrt()).round() as usize).min(8);
    // In sixty-fourths.
    let slope = (64.0 * slope).round() / 64.0;
    let around = footprint.around;
    let mut found = Vec::new();
    for (place, share) in bar(length).into_iter().enumerate() {
        for way in [-1, 1] {
            let off = place as f64 + 1.0;
            let mut steps = [0; 2];
            steps[axis] = way * off as isize;
            steps[1 - axis] = way * (off * slope + 0.5).floor() as isize;
            let at = [cell % width, cell / width];
            let to = [0, 1].map(|i| at[i].checked_add_signed(steps[i]));
            let [Some(x), Some(y)] = to else {
                continue;
            };
            let inside = |i: usize, at: usize| {
                (around.from[i]..around.from[i] + around.size[i]).contains(&at)
            };
            if inside(0, x) && inside(1, y) {
                found.push((y * width + x, share));
            }
        }
    }
    found
}

/// Changes by a spread over `length` cells of what is given, by slot and cell; and the kinds of paint that come to each
/// cell.
fn spread(
    footprint: &Footprint,
    scene: &Scene,
    expected: &Expected,
    length: usize,
) -> (Changes, BTreeMap<usize, BTreeSet<usize>>) {
    let (window, traits) = (&scene.window, &scene.traits);
    let (mut changes, mut kinds) = (Changes::new(), BTreeMap::new());
    let touched: BTreeSet<usize> = footprint.contacts.iter().map(|c| c.cell as usize).collect();
    let top = |cell: usize| window.base()[cell] + window.total(cell) * traits.cells_per_quantum;
    for (number, c) in footprint.contacts.iter().enumerate() {
        let cell = c.cell as usize;
        let films = film(&scene.load, c.texel as usize) as f32 * traits.film_cells_per_quantum;
        let bottom = top(cell) - c.depth + c.gap - films;
        for (beside, share) in beside(footprint, scene, cell, length) {
            if !touched.contains(&beside) && top(beside) <= bottom {
                continue;
            }
            for slot in 0..SLOTS {
                let [given, bound] = expected.given[&(slot, number)];
                let part = given * share;
                let mut put = |cell: usize, parts: [f64; 2]| {
                    let change = changes.entry((slot, cell)).or_insert([0.0; 3]);
                    change[0] += parts[0];
                    change[1] += parts[1];
                    change[2] += if given > 0.0 { 1.0 + bound } else { 0.0 };
                };
                put(cell, [part, 0.0]);
                put(beside, [0.0, part]);
                let texel = scene.load.film_of(slot);
                if texel.is_some_and(|film| film[c.texel as usize] > 0) {
                    let come: &mut BTreeSet<usize> = kinds.entry(beside).or_default();
                    come.insert(slot);
                }
            }
        }
    }
    (changes, kinds)
}

/// What comes to a cell beside the contacts without another paint makes no sheet, elsewhere it lies on top.
fn lies_on_top(
    (before, long): (&Scene, &Scene),
    (changes, kinds): (&Changes, &BTreeMap<usize, BTreeSet<usize>>),
    touched: &BTreeSet<usize>,
) {
    for (cell, come) in kinds.iter().filter(|(cell, _)| !touched.contains(*cell)) {
        let lay = (0..SLOTS).filter(|slot| on(&before.window, *slot, *cell) > 0.0);
        let all: BTreeSet<usize> = lay.chain(come.iter().copied()).collect();
        for slot in come {
            let [_, came, bound] = changes[&(*slot, *cell)];
            let want = if all.len() > 1 { came } else { 0.0 };
            let upper = long.window.upper(*slot);
            let upper = upper.map_or(0.0, |upper| f64::from(upper[*cell]));
            assert!((upper - want).abs() <= bound, "cell {cell}: {upper} {want}");
        }
    }
}

#[test]
fn deposits_are_spread_along_the_step() {
    let (mut beside, mut inside, mut told) = (0, 0, 0);
    for seed in 0..24 {
        let length = 1 + seed as usize % 5;
        let scene = |cells: f32| {
            let mut scene = Scene::new(seed);
            scene.to.press = PRESS;
            scene.traits.step_cells = cells;
            scene.traits.cell_per_reference = 1.0 / length as f32;
            scene
        };
        let (mut alone, mut long) = (scene(0.0), scene(length as f32));
        let mut footprint = Footprint::default();
        footprint.find(&mut alone.step());
        footprint.find(&mut long.step());
        let expected = oracle(&footprint.contacts, &long, RULES[0].1);
        let (changes, kinds) = spread(&footprint, &long, &expected, length);
        let (other, _) = spread(&footprint, &long, &expected, 3 * length);
        let before = scene(0.0);
        let counts = before.counts();
        for scene in [&mut alone, &mut long] {
            Exchange::default().run(&footprint, &mut scene.step());
            assert_eq!(scene.counts(), counts, "scene {seed}");
        }
        assert!(alone.load == long.load, "the brush gives as much");
        let touched: BTreeSet<usize> = footprint.contacts.iter().map(|c| c.cell as usize).collect();
        let off = |changes: &Changes, slot: usize, cell: usize| {
            let [sent, came, bound] = changes.get(&(slot, cell)).copied().unwrap_or_default();
            let want = on(&alone.window, slot, cell) + came - sent;
            ((on(&long.window, slot, cell) - want).abs(), bound)
        };
        for slot in 0..SLOTS {
            for cell in 0..long.window.width() * long.window.height() {
                let (off, bound) = off(&changes, slot, cell);
                assert!(off <= bound, "scene {seed}, cell {cell}: {off} of {bound}");
                beside += usize::from(bound > 0.0 && !touched.contains(&cell));
                inside += usize::from(bound > 0.0 && touched.contains(&cell));
            }
        }
        told += usize::from(changes.keys().any(|(slot, cell)| {
            let (off, bound) = off(&other, *slot, *cell);
            off > bound
        }));
        lies_on_top((&before, &long), (&changes, &kinds), &touched);
    }
    assert!(beside > 500 && inside > 5000, "{beside} {inside}");
    assert!(told > 20, "another length passes: {told} of 24 told");
}
