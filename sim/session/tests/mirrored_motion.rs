//! A mirrored motion paints the mirrored painting, except for the randomness of tooth and bristles.

#[path = "../../motion/tests/hands/mod.rs"]
mod hands;

use hands::{HEAD_M, along, hatching, pen, six_dof};
use maulstick_brush::BrushFile;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_motion::{Mirror, TakeSample, mirrored};
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::Scrape;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_session::Offline;
use maulstick_types::stylus::StylusPose;

/// Cells of the canvas and their side, m.
const CELLS: [usize; 2] = [256, 256];
const CELL_M: f64 = 5e-4;
/// Cells of a block over which paint is compared: tooth and single bristles are finer.
const BLOCK: usize = 4;
/// Paintings of a motion.
const PAINTINGS: usize = 3;
/// Cells of a tile.
const TILE: usize = 64;

/// A brush of the library, 12 mm wide.
fn brush(kind: &str) -> BrushFile {
    let file = BrushFile::library(kind).expect("of the library");
    file.scaled_to(12.0).expect("a size")
}

/// Paint in blocks of the canvas, m, rows from below: mean of several paintings, each with its bristles in another
/// disorder.
fn painted(motion: &[TakeSample], kind: &str) -> Vec<Vec<f64>> {
    let setup = PaintingSetup {
        cells: CELLS.map(|side| side as u32),
        cell_m: CELL_M,
        ..PaintingSetup::default()
    };
    let painting = Painting::new(&setup, PaintLibrary::measured().expect("whole")).expect("one");
    let load = "Ultramarine Blue".parse().expect("a mixture");
    let loads = vec![load];
    let mut offline =
        Offline::new(painting, "main", brush(kind), 0.5, loads.clone()).expect("set up");
    let samples: Vec<_> = motion
        .iter()
        .map(|taken| (taken.time_ns, &taken.sample))
        .collect();
    let mut sums = vec![vec![0.0; CELLS[0] / BLOCK]; CELLS[1] / BLOCK];
    for _ in 0..PAINTINGS {
        offline.follow(&samples, |_, _| {}).expect("painted");
        offline.end_take().expect("ended");
        add_blocks(offline.painting_mut(), &mut sums);
        let all = Scrape {
            region: None,
            surface: 0,
        };
        offline.edit(all).expect("scraped");
        offline.begin_take(loads.clone()).expect("begun");
    }
    sums
}

fn add_blocks(painting: &Painting, sums: &mut [Vec<f64>]) {
    let store = painting.store(0).expect("a canvas");
    for (id, version) in store.iter() {
        for (_, plane) in version.tile.iter().flat_map(|tile| tile.wet().to_vec()) {
            for (cell, count) in plane.iter().enumerate().take(TILE_CELLS) {
                let at = [
                    id.x as usize * TILE + cell % TILE,
                    id.y as usize * TILE + cell / TILE,
                ];
                sums[at[1] / BLOCK][at[0] / BLOCK] +=
                    f64::from(*count) * QUANTUM_M / PAINTINGS as f64;
            }
        }
    }
}

/// The blocks in a mirror.
fn in_mirror(mut sums: Vec<Vec<f64>>, mirror: Mirror) -> Vec<Vec<f64>> {
    match mirror {
        Mirror::X => sums.iter_mut().for_each(|row| row.reverse()),
        Mirror::Y => sums.reverse(),
    }
    sums
}

/// Share of the paint at other places.
fn off(one: &[Vec<f64>], other: &[Vec<f64>]) -> f64 {
    let (one, other) = (one.iter().flatten(), other.iter().flatten());
    let all: f64 = one.clone().sum();
    let apart: f64 = one.zip(other).map(|(a, b)| (a - b).abs()).sum();
    0.5 * apart / all
}

/// A slanted brush drawn in two strokes, by a pen and by a 6-DOF stylus.
fn hands_of(kind: &str) -> [(&'static str, Vec<TakeSample>); 2] {
    let length_m = brush(kind).length_m();
    // The hand has another head: the brush's is shorter by this.
    let lower_m = HEAD_M - length_m;
    let ways = [
        [[-0.035, -0.03], [0.03, -0.01]],
        [[0.02, 0.012], [-0.03, 0.035]],
    ];
    let height_m = |pressure: f64| length_m * (0.3 - 0.8 * pressure) - lower_m;
    let six = |at: [f64; 2], pressure: f64| six_dof([at[0], at[1], height_m(pressure)]);
    [
        ("pen", along(&ways, 0.1, pen)),
        ("6-DOF", along(&ways, 0.1, six)),
    ]
}

#[test]
fn what_is_painted_in_a_mirror_is_the_painting_in_a_mirror() {
    for kind in ["flat", "chisel"] {
        for (hand, motion) in hands_of(kind) {
            let own = painted(&motion, kind);
            for mirror in [Mirror::X, Mirror::Y] {
                let shown = painted(
                    &mirrored(&motion, mirror, [0.0; 2]).expect("mirrored"),
                    kind,
                );
                let right = off(&in_mirror(own.clone(), mirror), &shown);
                // The place alone is mirrored, as if the handle were not.
                let place_alone: Vec<TakeSample> = motion
                    .iter()
                    .map(|taken| {
                        let mut taken = taken.clone();
                        let axis = usize::from(mirror == Mirror::Y);
                        let at = taken.point(HEAD_M)[axis];
                        match &mut taken.sample.pose {
                            StylusPose::Contact { point_m, .. } => point_m[axis] -= 2.0 * at,
                            StylusPose::Ferrule { pose } => pose.position_m[axis] -= 2.0 * at,
                        }
                        taken
                    })
                    .collect();
                let fault = off(
                    &in_mirror(own.clone(), mirror),
                    &painted(&place_alone, kind),
                );
                println!("{kind} {hand} {mirror:?}: {right:.3}, handle not mirrored {fault:.3}");
                assert!(right < 0.2, "{kind} {hand} {mirror:?}: {right}");
                assert!(
                    fault > 1.5 * right,
                    "{kind} {hand} {mirror:?}: a fault passes: {fault}"
                );
            }
        }
    }
}

#[test]
fn hatching_in_a_mirror_is_hatching() {
    let motion = hatching(4, 0.04, 0.008, 0.5);
    let own = painted(&motion, "round");
    let shown = painted(
        &mirrored(&motion, Mirror::X, [0.0; 2]).expect("mirrored"),
        "round",
    );
    let right = off(&in_mirror(own.clone(), Mirror::X), &shown);
    let fault = off(&own, &shown);
    println!("round hatching: {right:.3}, not mirrored {fault:.3}");
    assert!(right < 0.1 && fault > 0.5, "{right} {fault}");
}

#[test]
fn a_slanted_brush_is_mirrored_in_its_broad_side() {
    let [(_, motion), _] = hands_of("chisel");
    let own = in_mirror(painted(&motion, "chisel"), Mirror::X);
    let mut shown = mirrored(&motion, Mirror::X, [0.0; 2]).expect("mirrored");
    let right = off(&own, &painted(&shown, "chisel"));
    // Mirrored in its narrow side, the slant would be that of another brush.
    for taken in &mut shown {
        if let StylusPose::Contact { twist_rad, .. } = &mut taken.sample.pose {
            *twist_rad += std::f64::consts::PI;
        }
    }
    let fault = off(&own, &painted(&shown, "chisel"));
    println!("chisel: {right:.3}, in its narrow side {fault:.3}");
    assert!(right < 0.2 && fault > 1.5 * right, "{right} {fault}");
}
