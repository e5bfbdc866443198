//! Stage 2: a share of the brush's motion in each part of the step and −c·∇p, through the faces between cells.

use std::collections::BTreeMap;

use maulstick_brush::BrushFile;
use maulstick_canvas::relief::Relief;
use maulstick_canvas::window::{Area, Window};
use maulstick_impasto::stages::advection::{Advection, Axis};
use maulstick_impasto::stages::velocity::{EASE, Faces, SLIP, SQUISH, STABLE};
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::contact::Contact;

use crate::scene::{CELL_M, Scene, window};

/// Ten operations on numbers of at most a few cells, each rounded to 2⁻²⁴ of its result.
const TOLERANCE: f64 = 4e-6;

/// Effect of a touched cell on its paint.
#[derive(Clone, Copy)]
struct Touch {
    push: [f64; 2],
    depth: f64,
    squish: f64,
}

fn touch(c: &Contact, window: &Window, thinner: Option<usize>, follows: f64) -> Touch {
    let on = |plane: &[f32]| f64::from(plane[c.cell as usize]);
    let total: f64 = window.planes().map(|(_, plane)| on(plane)).sum();
    let thin = thinner.and_then(|slot| window.plane(slot)).map_or(0.0, on);
    let share = if total > 0.0 { thin / total } else { 0.0 };
    let wet = f64::from(c.depth) / f64::from(c.fraction).max(1e-30);
    let flow = f64::from(SQUISH) * (1.0 + f64::from(EASE) * share);
    // Paint below the bristles, in the gaps of the tooth, does not follow them.
    let grip = follows * (1.0 - f64::from(SLIP) * share) * f64::from(c.cover * c.fraction);
    Touch {
        push: c.moved.map(|cells| grip * f64::from(cells)),
        depth: f64::from(c.depth) * f64::from(c.cover),
        squish: flow.min(f64::from(STABLE) / wet.max(1e-6)),
    }
}

/// Velocities through the right and the upper face of each cell around.
fn oracle(
    footprint: &Footprint,
    window: &Window,
    thinner: Option<usize>,
    follows: f64,
) -> [Vec<f64>; 2] {
    let [width, height] = footprint.around.size.map(|cells| cells as i64);
    let touched: BTreeMap<(i64, i64), Touch> = footprint
        .contacts
        .iter()
        .map(|c| {
            let place = i64::from(c.local);
            (
                (place % width, place / width),
                touch(c, window, thinner, follows),
            )
        })
        .collect();
    let face = |x: i64, y: i64, axis: usize| {
        let next = [(x + 1, y), (x, y + 1)][axis];
        if x < 0 || y < 0 || next.0 >= width || next.1 >= height {
            return 0.0;
        }
        let (i, j) = (touched.get(&(x, y)), touched.get(&next));
        let sides: Vec<&Touch> = i.into_iter().chain(j).collect();
        let count = sides.len().max(1) as f64;
        let push = sides.iter().map(|t| t.push[axis]).sum::<f64>() / count;
        let c = sides.iter().map(|t| t.squish).fold(f64::MAX, f64::min);
        let fall = i.map_or(0.0, |t| t.depth) - j.map_or(0.0, |t| t.depth);
        let v = match count as usize * sides.len() {
            0 => 0.0,
            _ => (push + c * fall).clamp(-1.0, 1.0),
        };
        let donor = if v > 0.0 { i } else { j };
        if donor.is_some() { v } else { 0.0 }
    };
    [0, 1].map(|axis| {
        let before = |x: i64, y: i64| [(x - 1, y), (x, y - 1)][axis];
        let leaves = |x: i64, y: i64| {
            let (bx, by) = before(x, y);
            (face(x, y, axis).max(0.0) - face(bx, by, axis).min(0.0)).max(1.0)
        };
        let mut faces = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let v = face(x, y, axis);
                let (nx, ny) = [(x + 1, y), (x, y + 1)][axis];
                faces.push(
                    v / if v > 0.0 {
                        leaves(x, y)
                    } else {
                        leaves(nx, ny)
                    },
                );
            }
        }
        faces
    })
}

fn agrees(faces: &Faces, oracle: &[Vec<f64>; 2]) -> bool {
    let near = |got: &[f32], want: &[f64]| {
        got.len() == want.len()
            && got
                .iter()
                .zip(want)
                .all(|(got, want)| (f64::from(*got) - want).abs() <= TOLERANCE)
    };
    near(&faces.right, &oracle[0]) && near(&faces.above, &oracle[1])
}

/// Share of its motion that paint follows: nearly half under bristles, because it sticks to canvas and bristle alike
/// (Baxter 2004, § 6.4.2), and all before a blade.
fn followed(kind: &str) -> f64 {
    match kind {
        "knife" => 1.0,
        _ => 0.41,
    }
}

#[test]
fn paint_follows_the_brush_and_goes_out_of_its_way() {
    let (mut clamped, mut squished, mut slowed, mut partly) = (0, 0, 0, 0);
    for seed in 0..32 {
        let mut scene = Scene::new(seed);
        scene.thinner = [None, Some(2)][seed as usize / 2 % 2];
        let kind = ["round", "knife"][seed as usize / 4 % 2];
        let file = BrushFile::library(kind).expect(kind);
        scene.traits.follows = BrushTraits::of(&file, CELL_M, 1.0).follows;
        scene.traits.parts = 1 + seed as u32 % 3;
        let follows = followed(kind) / f64::from(scene.traits.parts);
        let mut footprint = Footprint::default();
        footprint.find(&mut scene.step());
        if seed % 2 == 0 {
            // Faster than real steps, so that the clamp acts.
            for contact in &mut footprint.contacts {
                let times = 4.0 * scene.traits.parts as f32;
                contact.moved = contact.moved.map(|cells| times * cells);
            }
        }
        let mut faces = Faces::default();
        faces.find(&footprint, &scene.step());
        let want = oracle(&footprint, &scene.window, scene.thinner, follows);
        assert!(agrees(&faces, &want), "scene {seed}");
        for c in &footprint.contacts {
            let v = want[0][c.local as usize];
            clamped += usize::from(v.abs() == 1.0);
            slowed += usize::from(v.abs() > 0.5 && v.abs() < 1.0);
            partly += usize::from(c.fraction > 0.0 && c.fraction < 1.0);
            let pushed = follows * f64::from(c.cover * c.fraction) * f64::from(c.moved[0]);
            squished += usize::from((v - pushed).abs() > 1e-3);
        }
        // A fault: paint that follows as a whole where the bristles reach only its top.
        let mut whole = footprint.clone();
        for contact in &mut whole.contacts {
            (contact.cover, contact.fraction) = (contact.cover * contact.fraction, 1.0);
        }
        let faulty = oracle(&whole, &scene.window, scene.thinner, follows);
        assert!(!agrees(&faces, &faulty), "scene {seed}: all of it follows");
        let at = (0..want[1].len()).max_by(|a, b| want[1][*a].total_cmp(&want[1][*b]));
        faces.above[at.expect("cells")] += 10.0 * TOLERANCE as f32;
        assert!(!agrees(&faces, &want), "a fault in scene {seed} passes");
    }
    let seen = [clamped, squished / 50, slowed, partly / 50];
    assert!(seen.iter().all(|seen| *seen > 20), "{seen:?}");
}

/// A pad as wide as a few bristles is pressed down into an even film at the speed of a brush: the penetrated volume is
/// displaced by c alone. Ridges stay beside bristles because c is too small to press all paint out. Under the middle of
/// a whole head paint is not pressed out: that takes a globally solved pressure (Baxter 2004, § 6.11).
#[test]
fn what_is_penetrated_is_displaced_as_c_has_it() {
    let (squished, want) = (displaced(1.0), gives_way(1.0));
    println!("displaced by penetrated volume: {squished:.3}, by c {want:.3}");
    assert!((squished - want).abs() < 0.02, "{squished} {want}");
    assert!((0.1..=1.02).contains(&squished), "{squished}");
    let feeble = displaced(0.25);
    println!("by a quarter of c: {feeble:.3}");
    assert!((feeble - want).abs() > 0.1, "{feeble} {want}");
}

/// Radius of the pad, thickness of the film, depth of the pad, cells, and number of its steps.
const RADIUS: f64 = 2.5;
const FILM: f64 = 0.4;
const DEPTH: f64 = 0.3;
const STEPS: usize = 40;

/// The pad is a paraboloid whose rim is a film's thickness higher.
fn bottom(x: usize, y: usize, depth: f64) -> f64 {
    let (dx, dy) = (x as f64 - 44.5, y as f64 - 44.5);
    FILM - depth * (1.0 - (dx * dx + dy * dy) / (RADIUS * RADIUS))
}

/// Expected result of [`displaced`]: −c·∇p between cells, from the paint on the fuller one.
fn gives_way(share: f64) -> f64 {
    const FROM: usize = 30;
    const SIDE: usize = 30;
    let mut film = vec![FILM; SIDE * SIDE];
    for step in 1..=STEPS {
        let depth = DEPTH * (step as f64 / STEPS as f64);
        let reached = |place: usize, film: &[f64]| {
            let bottom = bottom(FROM + place % SIDE, FROM + place / SIDE, depth);
            let reach = (film[place] - bottom).min(film[place]);
            (reach > 0.0 && bottom <= FILM).then_some(share * reach)
        };
        let before = film.clone();
        for place in 0..SIDE * (SIDE - 1) - 1 {
            for next in [place + 1, place + SIDE] {
                let (one, other) = (reached(place, &before), reached(next, &before));
                let v = one.unwrap_or(0.0) - other.unwrap_or(0.0);
                let from = if v > 0.0 { place } else { next };
                if reached(from, &before).is_none() {
                    continue;
                }
                // The smaller c of the touched cells: that of the thicker paint.
                let touched = [one.map(|_| before[place]), other.map(|_| before[next])];
                let thick = touched.into_iter().flatten().fold(0.0, f64::max);
                let c = f64::from(SQUISH).min(f64::from(STABLE) / thick);
                let goes = c * v * before[from];
                (film[place], film[next]) = (film[place] - goes, film[next] + goes);
            }
        }
    }
    let (mut penetrated, mut left) = (0.0, 0.0);
    for (place, film) in film.iter().enumerate() {
        let bottom = bottom(FROM + place % SIDE, FROM + place / SIDE, DEPTH);
        if bottom < FILM {
            (penetrated, left) = (penetrated + FILM - bottom, left + FILM - film);
        }
    }
    left / penetrated
}

/// Volume displaced from the cells under the pad, as a share of the pad's volume below the film's surface, with c
/// multiplied by `share`.
fn displaced(share: f32) -> f64 {
    let mut scene = Scene::new(0);
    scene.window = window(&Relief::flat(CELL_M));
    let to_cells = f64::from(scene.traits.cells_per_quantum);
    let [right, top] = scene.window.limit();
    let width = scene.window.width();
    let laid = (FILM / to_cells).floor() as f32;
    let plane = scene.window.plane_mut(0);
    for y in 0..top {
        plane[y * width..y * width + right].fill(laid);
    }
    let area = Area {
        from: [20, 20],
        size: [50, 50],
    };
    let (mut advection, mut faces) = (Advection::default(), Faces::default());
    for step in 1..=STEPS {
        let depth = DEPTH * (step as f64 / STEPS as f64);
        let mut footprint = Footprint::default();
        footprint.around = area;
        for local in 0..50 * 50 {
            let (x, y) = (20 + local % 50, 20 + local / 50);
            let wet = f64::from(scene.window.total(y * width + x)) * to_cells;
            let reach = wet - bottom(x, y, depth);
            let beside = bottom(x, y, depth) > FILM;
            if reach <= 0.0 || beside {
                continue;
            }
            footprint.wet.push(scene.window.total(y * width + x));
            footprint.contacts.push(Contact {
                cell: (y * width + x) as u32,
                local: local as u32,
                cover: 1.0,
                depth: (share as f64 * reach.min(wet)) as f32,
                fraction: (share as f64 * reach.min(wet) / wet) as f32,
                ..Contact::default()
            });
        }
        faces.find(&footprint, &scene.step());
        let first = if step % 2 == 0 { Axis::X } else { Axis::Y };
        advection.run(area, &faces, &mut scene.window, first, 0.0);
    }
    let (mut penetrated, mut left) = (0.0, 0.0);
    for y in 20..70 {
        for x in 20..70 {
            let taken = FILM - bottom(x, y, DEPTH);
            let beside = bottom(x, y, DEPTH) > FILM;
            if taken > 0.0 && !beside {
                penetrated += taken;
                left += FILM - f64::from(scene.window.total(y * width + x)) * to_cells;
            }
        }
    }
    left / penetrated
}

/// A thinned film gives way to the brush sooner, and follows it less.
#[test]
fn thinner_lets_paint_slip_and_flow() {
    use maulstick_impasto::stages::velocity::{follows, squish};
    assert!(follows(0.5, 0.8) < follows(0.5, 0.2) && squish(0.001, 0.8) > squish(0.001, 0.2));
    assert_eq!(
        squish(10.0, 0.8),
        squish(10.0, 0.0),
        "stable in thick paint"
    );
}
