//! Stages 2 to 5: each on the results of the stages before it, compared with its documentation in plain f64.

use std::collections::BTreeMap;

use maulstick_canvas::quantum::{CELL_MAX, QUANTA_PER_UNIT, SLOTS};
use maulstick_impasto::device::probe::{Probe, Prober};
use maulstick_impasto::stages::advection::STAIN;
use maulstick_impasto::stages::velocity::{EASE, SQUISH, STABLE};
use maulstick_model::transfer::Exchanging;

use crate::device;
use crate::probed::{Grid, VELOCITY_TOLERANCE, ahead, run, scene};
use crate::scene::{CELL_M, Scene, lying};

/// Tolerance in quanta: each face's count is truncated, and f32 may round it over a whole number.
const QUANTA: f64 = 2.0;
/// Share of the flow that roundings add.
const ROUNDING: f64 = 3e-6;

/// Velocity through a face, before the outflow of a cell is limited.
fn free(grid: &Grid<'_>, scene: &Scene, at: [i64; 2], axis: usize) -> f64 {
    let j = ahead(at, axis, 1);
    if !grid.is_on_surface(at) || !grid.is_on_surface(j) {
        return 0.0;
    }
    let of = |at: [i64; 2]| {
        grid.touched.get(&at).map(|c| {
            let (depth, cover) = (f64::from(c.depth), f64::from(c.cover));
            let total = f64::from(scene.window.total(c.cell as usize));
            // Paint that the brush does not reach has no resistance.
            let wet = if c.fraction > 0.0 {
                total * f64::from(scene.traits.cells_per_quantum)
            } else {
                0.0
            };
            let thinner = scene.thinner.and_then(|slot| scene.window.plane(slot));
            let thinner = thinner.map_or(0.0, |plane| f64::from(plane[c.cell as usize]));
            let thinner = thinner / total.max(1.0);
            let squish = (f64::from(SQUISH) * (1.0 + f64::from(EASE) * thinner))
                .min(f64::from(STABLE) / wet.max(1e-6));
            let follows = f64::from(scene.traits.follows) * (1.0 - 0.5 * thinner);
            (
                follows * cover * f64::from(c.fraction) * f64::from(c.moved[axis]),
                depth * cover,
                squish,
            )
        })
    };
    let (push, squish) = match (of(at), of(j)) {
        (Some(i), Some(j)) => (0.5 * (i.0 + j.0), i.2.min(j.2) * (i.1 - j.1)),
        (Some(i), None) => (i.0, i.2 * i.1),
        (None, Some(j)) => (j.0, -j.2 * j.1),
        (None, None) => return 0.0,
    };
    let v = (push + squish).clamp(-1.0, 1.0);
    let upwind = if v > 0.0 { at } else { j };
    if grid.touched.contains_key(&upwind) {
        v
    } else {
        0.0
    }
}

fn velocity(grid: &Grid<'_>, scene: &Scene, at: [i64; 2], axis: usize) -> f64 {
    let v = free(grid, scene, at, axis);
    let upwind = if v > 0.0 { at } else { ahead(at, axis, 1) };
    let right = free(grid, scene, upwind, axis);
    let left = free(grid, scene, ahead(upwind, axis, -1), axis);
    v / (right.max(0.0) + (-left).max(0.0)).max(1.0)
}

#[test]
fn paint_follows_the_brush_and_goes_out_of_its_way() {
    let mut prober = Prober::new(device()).expect("taken");
    let mut moving = 0;
    for seed in 0..8 {
        let mut scene = scene(seed, 0);
        scene.thinner = [None, Some(2), Some(9)][seed as usize % 3];
        scene.traits.follows = [0.5, 1.0][seed as usize % 2];
        let probe = run(&mut prober, &mut scene, "velocity");
        let grid = Grid::new(&probe, &scene);
        let mut worst = 0.0f64;
        for y in 0..grid.limit[1] {
            for x in 0..grid.limit[0] {
                for axis in 0..2 {
                    let want = velocity(&grid, &scene, [x, y], axis);
                    worst = worst.max((grid.face([x, y], axis) - want).abs());
                    moving += usize::from(want != 0.0);
                }
            }
        }
        println!("scene {seed}: velocities off by {worst:.2e}");
        assert!(worst <= VELOCITY_TOLERANCE, "scene {seed}: {worst}");
    }
    assert!(moving > 4000, "{moving}");
}

/// One pass in f64, in whole quanta.
fn pass(grid: &Grid<'_>, planes: &mut [Vec<f64>], axis: usize, stain: f64) {
    let cells = planes.first().map_or(0, Vec::len);
    let total: Vec<f64> = (0..cells)
        .map(|c| planes.iter().map(|p| p[c]).sum())
        .collect();
    let loose = |at: [i64; 2]| (total[grid.cell(at)] - stain).max(0.0);
    let room = |at: [i64; 2]| {
        let mut coming = 0.0;
        for (from, v) in [
            (ahead(at, axis, -1), grid.face(ahead(at, axis, -1), axis)),
            (ahead(at, axis, 1), -grid.face(at, axis)),
        ] {
            if v > 0.0 {
                coming += v * (2.0 - v) * loose(from);
            }
        }
        let free = (f64::from(CELL_MAX) - 64.0 - total[grid.cell(at)]).max(0.0);
        if coming > free { free / coming } else { 1.0 }
    };
    for plane in planes.iter_mut() {
        let before = plane.clone();
        let q = |at: [i64; 2], beside: [i64; 2]| {
            before[grid.cell(if grid.is_around(beside) { beside } else { at })]
        };
        for y in 0..grid.limit[1] {
            for x in 0..grid.limit[0] {
                let at = [x, y];
                let v = grid.face(at, axis);
                if v == 0.0 {
                    continue;
                }
                let j = ahead(at, axis, 1);
                let (donor, to) = if v > 0.0 { (at, j) } else { (j, at) };
                let held = q(donor, donor);
                let a = held - q(donor, ahead(donor, axis, -1));
                let b = q(donor, ahead(donor, axis, 1)) - held;
                let slope = if a * b > 0.0 {
                    2.0 * a * b / (a + b)
                } else {
                    0.0
                };
                let w = v.abs();
                let share = loose(donor) / total[grid.cell(donor)].max(1.0) * room(to);
                let flux = (w * (held + 0.5 * v.signum() * (1.0 - w) * slope) * share).trunc();
                plane[grid.cell(donor)] -= flux;
                plane[grid.cell(to)] += flux;
            }
        }
    }
}

fn planes(scene: &Scene) -> Vec<Vec<f64>> {
    let planes = scene.window.planes();
    planes
        .map(|(_, plane)| plane.iter().map(|count| f64::from(*count)).collect())
        .collect()
}

#[test]
fn paint_goes_where_it_is_pushed_and_none_is_lost() {
    let mut prober = Prober::new(device()).expect("taken");
    let (mut moved, mut turned) = (0, 0.0f64);
    for (seed, steps) in (0..8).zip([0, 1, 6, 3].into_iter().cycle()) {
        let mut scene = scene(seed, steps);
        scene.traits.follows = 0.5;
        let (before, counts) = (planes(&scene), scene.counts());
        let stain = f64::from(STAIN);
        let probe = run(&mut prober, &mut scene, "advection");
        assert_eq!(scene.counts(), counts, "scene {seed}");
        lying(&scene.window);
        let grid = Grid::new(&probe, &scene);
        let off = |axes: [usize; 2]| {
            let mut want = before.clone();
            axes.iter()
                .for_each(|axis| pass(&grid, &mut want, *axis, stain));
            let pairs = planes(&scene).into_iter().flatten();
            let pairs = pairs.zip(want.into_iter().flatten());
            pairs
                .map(|(got, want)| (got - want).abs())
                .fold(0.0, f64::max)
        };
        let axes = if steps % 2 == 0 { [0, 1] } else { [1, 0] };
        let worst = off(axes);
        println!("scene {seed}: counts off by {worst}");
        assert!(worst <= QUANTA, "scene {seed}: {worst}");
        turned = turned.max(off([axes[1], axes[0]]));
        let changed = planes(&scene)
            .into_iter()
            .flatten()
            .zip(before.into_iter().flatten());
        moved += changed.filter(|(a, b)| a != b).count();
    }
    assert!(moved > 4000, "{moved}");
    assert!(turned > 100.0 * QUANTA, "the other order passes: {turned}");
}

/// Press of the heads.
const PRESS: f32 = 0.3;

/// Share of the shear: bristles shear fully from a press of .45 on, and less by the square.
fn shear(blade: bool) -> f64 {
    if blade {
        1.0
    } else {
        (f64::from(PRESS) / 0.45).powi(2)
    }
}

/// Baxter 2004, Algorithm 3, by path length, of which a reference cell leaves `kept`, with a film that bridges a gap:
/// units to the canvas, back, and swapped. The part of a film beyond its gap fills it 16 times as fast, until 3/10
/// of all are on the brush. A blade does only that, and takes up all that it reaches.
fn wanted([a_b, a_c, lies, gap]: [f64; 4], travel: f64, (kept, blade): (f64, bool)) -> [f64; 3] {
    let goes = |times: f64| 1.0 - maulstick_num::powf(kept, times * travel);
    let free = (a_b - gap).max(0.0);
    let bridged = if blade {
        free
    } else {
        (0.7 * a_b - 0.3 * lies).clamp(0.0, free)
    };
    let fill = goes(16.0) * gap.min(bridged);
    let (carried, most) = if blade {
        (0.0, 1.0)
    } else {
        (free, 1e-4 / 0.025)
    };
    let difference = carried - a_c;
    let donor = if difference > 0.0 { a_b - fill } else { a_c };
    let net = (goes(1.0) * difference.abs()).min(most * travel).min(donor);
    // Films that touch across a gap shear a skin of 90 µm, half as much where the gap is 15 µm.
    let swap = if blade { 0.01 } else { 1.0 };
    let sheared = shear(blade) * swap * travel * 15e-6 / (15e-6 + 0.025 * gap);
    let swap = sheared.min(1.0) * (a_b - gap).clamp(0.0, 90e-6 / 0.025).min(lies);
    if difference > 0.0 {
        [fill + net, 0.0, swap]
    } else {
        [(fill - net).max(0.0), (net - fill).max(0.0), swap]
    }
}

/// Paint on cells and films after the exchange, with its tolerance.
fn exchanged(
    probe: &Probe,
    scene: &Scene,
    rule: (f64, bool),
) -> BTreeMap<(bool, usize, usize), [f64; 2]> {
    let (window, load, traits) = (&scene.window, &scene.load, &scene.traits);
    let mut asked = BTreeMap::<u32, [f64; 2]>::new();
    let mut wants = Vec::new();
    for c in &probe.contacts {
        let lying = f64::from(window.total(c.cell as usize));
        let film = f64::from(load.film(c.texel as usize));
        let [u, v] = c.moved.map(f64::from);
        let travel = (u * u + v * v).sqrt() * f64::from(traits.cell_per_reference);
        let a_b = film * f64::from(traits.film_units_per_quantum);
        let lies = lying / QUANTA_PER_UNIT;
        let a_c = lies * f64::from(c.fraction) * shear(rule.1);
        // A unit is 25 mm.
        let gap = f64::from(c.gap) * CELL_M / 0.025;
        let [out, back, swap] = wanted([a_b, a_c, lies, gap], travel, rule)
            .map(|units| units * f64::from(c.cover) * QUANTA_PER_UNIT);
        let room = QUANTA_PER_UNIT - lying;
        let swap = swap.min(room);
        let want = [(out + swap).min(room), (back + swap).min(lying)].map(f64::trunc);
        let sums = asked.entry(c.texel).or_default();
        (0..2).for_each(|i| sums[i] += want[i]);
        wants.push(want);
    }
    let mut expected = BTreeMap::new();
    for (c, want) in probe.contacts.iter().zip(&wants) {
        let (cell, texel) = (c.cell as usize, c.texel as usize);
        let lying = f64::from(window.total(cell));
        let film = f64::from(load.film(texel));
        let [drawn, offered] = asked[&c.texel];
        let out = (film / drawn.max(1.0)).min(1.0);
        let room = traits.film_most - film + drawn * out;
        let taken = (room / offered.max(1.0)).clamp(0.0, 1.0);
        for slot in 0..SLOTS {
            let of_film = load
                .film_of(slot)
                .map_or(0.0, |film| f64::from(film[texel]));
            let mut planes = window.planes();
            let of_cell = planes.find(|(of, _)| *of == slot);
            let of_cell = of_cell.map_or(0.0, |(_, plane)| f64::from(plane[cell]));
            let left = want[0] * out * of_film / film.max(1.0);
            let taken = want[1] * taken * of_cell / lying.max(1.0);
            let bound = QUANTA + ROUNDING * (left + taken);
            let entry = expected.entry((true, slot, cell)).or_insert([of_cell, 0.0]);
            (entry[0], entry[1]) = (entry[0] + left - taken, entry[1] + bound);
            let entry = expected
                .entry((false, slot, texel))
                .or_insert([of_film, 0.0]);
            (entry[0], entry[1]) = (entry[0] + taken - left, entry[1] + bound);
        }
    }
    expected
}

#[test]
fn paint_goes_both_ways() {
    let mut prober = Prober::new(device()).expect("taken");
    for seed in 0..8 {
        // Of bristles, and of a blade.
        let rule = if seed < 6 { (0.9, false) } else { (0.4, true) };
        let scene = || {
            let mut scene = scene(seed, 0);
            scene.traits.exchanging = match rule {
                (_, false) => Exchanging::BRISTLES,
                (_, true) => Exchanging::BLADE,
            };
            scene.traits.step_cells = 0.0;
            scene.to.press = PRESS;
            scene.handling.push = false;
            scene
        };
        let mut pushed = scene();
        let counts = pushed.counts();
        let probe = run(&mut prober, &mut pushed, "advection");
        let expected = exchanged(&probe, &pushed, rule);
        let mut scene = scene();
        // Without flow in the head the exchange's result stays.
        (scene.traits.refill, scene.traits.creep) = (0.0, 0.0);
        let last = run(&mut prober, &mut scene, "bristle_flow");
        assert_eq!(last.contacts, probe.contacts);
        assert_eq!(scene.counts(), counts, "scene {seed}");
        lying(&scene.window);
        assert_eq!(scene.load.steps(), 1);
        let agrees = |scene: &Scene| {
            let mut near = 0;
            for ((is_cell, slot, at), [want, bound]) in &expected {
                let got = if *is_cell {
                    let mut planes = scene.window.planes();
                    let plane = planes.find(|(of, _)| of == slot);
                    plane.map_or(0.0, |(_, plane)| f64::from(plane[*at]))
                } else {
                    scene
                        .load
                        .film_of(*slot)
                        .map_or(0.0, |film| f64::from(film[*at]))
                };
                near += usize::from((got - want).abs() <= *bound);
            }
            near
        };
        let near = agrees(&scene);
        println!("scene {seed}: {near} of {} counts", expected.len());
        assert_eq!(near, expected.len(), "scene {seed}");
        let cell = probe.contacts[probe.contacts.len() / 2].cell as usize;
        let plane = scene.window.plane_mut(0);
        plane[cell] += 8.0;
        assert!(agrees(&scene) < near, "a fault passes");
    }
}
