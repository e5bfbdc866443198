//! The skin in stage 1: every cell tests whether its middle lies in a triangle.

use std::collections::BTreeMap;

use maulstick_brush::head::STATIONS;
use maulstick_brush::{BrushFile, Head, HeadPose};
use maulstick_model::brush::traits::{BrushTraits, TEXELS_PER_STRIP};
use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::contact::Contact;

use crate::scene::{CELL_M, CELLS, Random, Scene};

/// Sixteen roundings of a place below 128 cells in f32.
const ROUNDING: f64 = 16.0 * 128.0 / 33_554_432.0;

/// Part of a triangle over a cell.
#[derive(Clone, Copy, Debug)]
struct Lies {
    z: f64,
    moved: [f64; 2],
    along: f64,
    around: f64,
    /// True if it certainly covers the cell.
    sure: bool,
    off: f64,
}

/// A scene whose strips all hang too high, over which the fude's skin is crumpled.
fn scene(seed: u64) -> Scene {
    let mut scene = Scene::new(seed);
    let mut random = Random::new(seed + 100);
    let mut file = BrushFile::library("fude").expect("fude");
    file.strips.count = scene.head.strips();
    scene.head = Head::of(&file);
    let far = |_: usize| 1e3;
    for pose in [&mut scene.from, &mut scene.to] {
        pose.z = (0..scene.head.strips() * STATIONS).map(far).collect();
    }
    let traits = BrushTraits::of(&file, CELL_M, 1.0);
    scene.traits.recede = traits.recede;
    // Slightly open, so that the skin does not recede beyond the paint.
    scene.to.splay *= 0.3;
    let skin = scene.head.skin().expect("a skin");
    let places = skin.places().to_vec();
    let turn = random.range(0.0, 6.0);
    let mut lay = |pose: &mut HeadPose, shift: [f64; 2], height: f64| {
        for [around, along] in &places {
            let angle = f64::from(*around) * 2.0 * std::f64::consts::PI + turn;
            let wide = 14.0 * (1.0 - 0.6 * f64::from(*along));
            let (sine, cosine) = maulstick_num::sin_cos(angle);
            let rough = random.range(-0.2, 0.2);
            pose.skin
                .x
                .push((50.0 + wide * cosine + 30.0 * f64::from(*along) + shift[0]) as f32);
            pose.skin.y.push((45.0 + wide * sine + shift[1]) as f32);
            pose.skin
                .z
                .push((height + 2.0 * sine + rough).max(0.0) as f32);
        }
    };
    lay(&mut scene.to, [0.0; 2], 1.0);
    lay(&mut scene.from, [-0.4, 0.3], 1.0);
    scene
}

/// All triangles over a cell's middle.
fn lying(scene: &Scene, at: [usize; 2]) -> Vec<Lies> {
    let skin = scene.head.skin().expect("a skin");
    let pose = &scene.to.skin;
    let middle = at.map(|cell| cell as f64 + 0.5);
    let mut found = Vec::new();
    for face in skin.faces() {
        for corners in [[0, 1, 2], [0, 2, 3]] {
            let number = corners.map(|corner: usize| face[corner] as usize);
            let [a, b, c] = number.map(|i| [f64::from(pose.x[i]), f64::from(pose.y[i])]);
            let area = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
                (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
            };
            let whole = area(a, b, c);
            let shares = [
                area(b, c, middle) / whole,
                area(c, a, middle) / whole,
                area(a, b, middle) / whole,
            ];
            let off = ROUNDING * 60.0 / whole.abs().max(1e-9);
            if whole.abs() < 1e-8 || shares.iter().any(|share| *share < -off) {
                continue;
            }
            let mix = |of: [f64; 3]| (0..3).map(|i| shares[i] * of[i]).sum::<f64>();
            let first = f64::from(skin.places()[face[0] as usize][0]);
            let around = |i: usize| {
                let own = f64::from(skin.places()[i][0]);
                own + (first - own).round()
            };
            let moved = |to: &[f32], from: &[f32]| {
                mix(number.map(|i| f64::from(to[i]) - f64::from(from[i])))
            };
            found.push(Lies {
                z: mix(number.map(|i| f64::from(pose.z[i]))),
                moved: [
                    moved(&pose.x, &scene.from.skin.x),
                    moved(&pose.y, &scene.from.skin.y),
                ],
                along: mix(number.map(|i| f64::from(skin.places()[i][1])))
                    * TEXELS_PER_STRIP as f64,
                around: mix(number.map(around)),
                sure: shares.iter().all(|share| *share > off),
                off: (4.0 * off).min(1.0),
            });
        }
    }
    found
}

/// True if a contact, or none, is possible for a cell.
fn fits(scene: &Scene, at: [usize; 2], got: Option<&Contact>) -> bool {
    let found = lying(scene, at);
    let sure = found.iter().filter(|lies| lies.sure);
    let lowest = sure.map(|lies| lies.z + lies.off).fold(f64::MAX, f64::min);
    let place = at[1] * scene.window.width() + at[0];
    let counts = scene.window.planes().map(|(_, p)| f64::from(p[place]));
    let wet = counts.sum::<f64>() * f64::from(scene.traits.cells_per_quantum);
    let ground = f64::from(scene.window.base()[place]);
    let film_of = |strip: usize, along: f64| {
        let texel = strip * TEXELS_PER_STRIP + (along as usize).min(TEXELS_PER_STRIP - 1);
        f64::from(scene.load.film(texel)) * f64::from(scene.traits.film_cells_per_quantum)
    };
    let ride = f64::from(scene.window.ride()[place]);
    // The skin recedes where the strips show, and sinks in as they do.
    let keeps = f64::from(scene.traits.recede) * f64::from(scene.to.splay)
        - f64::from(scene.traits.sink) * f64::from(scene.to.press);
    let mut none = lowest == f64::MAX;
    for lies in found.iter().filter(|lies| lies.z - lies.off <= lowest) {
        for turn in [lies.around - 1e-4, lies.around, lies.around + 1e-4] {
            let strip = scene.head.strip_around(turn as f32);
            let rests = (lies.z + ride.min(0.0)).max(ride);
            let reach = ground + wet - rests - keeps;
            let film = film_of(strip, lies.along);
            if reach + film > -lies.off {
                let depth = reach.clamp(0.0, wet);
                let is = got.is_some_and(|got| {
                    got.texel as usize / TEXELS_PER_STRIP == strip
                        && (f64::from(got.depth) - depth).abs() <= lies.off
                        && (f64::from(got.gap) - (-reach).max(0.0)).abs() <= lies.off
                        && (0..2)
                            .all(|i| (f64::from(got.moved[i]) - lies.moved[i]).abs() <= lies.off)
                        && got.cover == 1.0
                });
                if is {
                    return true;
                }
            }
            none |= reach + film <= lies.off;
        }
    }
    got.is_none() && none
}

fn compare(scene: &Scene, contacts: &[Contact]) -> Result<usize, String> {
    let width = scene.window.width();
    let mut checked = 0;
    let found: BTreeMap<u32, &Contact> = contacts.iter().map(|c| (c.cell, c)).collect();
    for y in 0..CELLS[1] as usize {
        for x in 0..CELLS[0] as usize {
            let cell = (y * width + x) as u32;
            let got = found.get(&cell).copied();
            if !fits(scene, [x, y], got) {
                return Err(format!(
                    "cell {x}, {y}: {got:?}, {:?}",
                    lying(scene, [x, y])
                ));
            }
            checked += usize::from(got.is_some());
        }
    }
    Ok(checked)
}

#[test]
fn the_lowest_face_touches_and_faults_are_found() {
    let mut touched = 0;
    for seed in 0..6 {
        let mut scene = scene(seed);
        scene.bounds = ([0; 2], [100, 90]);
        let mut footprint = Footprint::default();
        footprint.find(&mut scene.step());
        let contacts = footprint.contacts;
        touched += compare(&scene, &contacts).unwrap_or_else(|e| panic!("scene {seed}: {e}"));
        let sure = |c: &Contact| {
            let at = [
                c.cell as usize % scene.window.width(),
                c.cell as usize / scene.window.width(),
            ];
            c.depth > 0.01
                && lying(&scene, at)
                    .iter()
                    .all(|lies| lies.sure && lies.off < 0.1)
        };
        let at = contacts.iter().position(sure).expect("a clear contact");
        let faults: [fn(&mut Contact); 5] = [
            |c| c.depth += 0.7,
            |c| c.gap += 0.7,
            |c| c.moved[0] += 0.7,
            |c| c.cover = 0.9,
            |c| c.texel += TEXELS_PER_STRIP as u32,
        ];
        for (number, fault) in faults.iter().enumerate() {
            let mut faulty = contacts.clone();
            fault(&mut faulty[at]);
            assert!(compare(&scene, &faulty).is_err(), "fault {number} passes");
        }
        let mut missing = contacts.clone();
        missing.remove(at);
        assert!(compare(&scene, &missing).is_err(), "a missing cell passes");
    }
    println!("{touched} cells touched");
    assert!(touched > 1000, "{touched}");
}
