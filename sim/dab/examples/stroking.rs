//! The same strokes by both stroking algorithms (Baxter 2004, fig. 4.1), as a picture: on the left Algorithm 1, on the right
//! Algorithm 2; heads far from each other above, nearer below; three times as large beside each the middle of it.
//! `cargo run --release -p maulstick-dab --example stroking FILE.ppm`.

mod scene;

use std::io::Write as _;

use maulstick_brush::HeadPose;
use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_dab::volume::{OPAQUE, UNIT};

use crate::scene::Bench;

/// Cells of the surface either way, and those of it that are shown.
const SIDE: u32 = 384;
const SHOWN: [usize; 2] = [320, 200];
/// The part that is shown larger: its middle and half its side.
const INSET: ([usize; 2], usize) = ([172, 100], 33);
const LARGER: usize = 3;
/// Ways from head to head, cells: a fast hand and a slow one.
const WAYS: [f64; 2] = [28.0, 7.0];

/// An S that a flat brush follows while it turns.
fn heads(bench: &Bench, way: f64) -> Vec<HeadPose> {
    let count = (300.0 / way) as usize;
    let head = |i: usize| {
        let t = i as f64 / count as f64;
        let (sine, _) = maulstick_num::sin_cos(6.2 * t);
        bench.pose([40.0 + 240.0 * t, 84.0 + 48.0 * sine], 2.6 * t)
    };
    (0..=count).map(head).collect()
}

/// Grey of each shown cell, the lowest row first.
fn stroke(stroker: Stroker, way: f64) -> Vec<u8> {
    let mut bench = Bench::new("flat", 256, (SIDE, 2.5e-4));
    let poses = heads(&bench, way);
    bench.stroke(&mut Dab::stroking(stroker), &poses, way.ceil() as i64 + 8);
    let width = bench.window.width();
    let plane = bench.window.plane(1).unwrap_or_default();
    let cells = (0..SHOWN[1]).flat_map(|y| (0..SHOWN[0]).map(move |x| y * width + x));
    let grey = |cell: usize| 255.0 - 225.0 * (plane[cell] / (OPAQUE * UNIT)).min(1.0);
    cells.map(|cell| grey(cell) as u8).collect()
}

fn main() -> std::io::Result<()> {
    let Some(path) = std::env::args().nth(1) else {
        eprintln!("where to? stroking FILE.ppm");
        std::process::exit(2);
    };
    let inset = 2 * INSET.1 * LARGER;
    let size = [2 * (SHOWN[0] + inset), 2 * SHOWN[1]];
    let mut page = vec![255u8; size[0] * size[1]];
    for (row, way) in WAYS.into_iter().enumerate() {
        for (column, stroker) in [Stroker::Faster, Stroker::Better].into_iter().enumerate() {
            let grey = stroke(stroker, way);
            let [left, top] = [column * (SHOWN[0] + inset), row * SHOWN[1]];
            let of = |x: usize, y: usize| grey[(SHOWN[1] - 1 - y) * SHOWN[0] + x];
            for y in 0..SHOWN[1] {
                let line = &mut page[(top + y) * size[0] + left..][..SHOWN[0] + inset];
                for (x, pixel) in line.iter_mut().enumerate() {
                    *pixel = match x.checked_sub(SHOWN[0]) {
                        None => of(x, y),
                        Some(x) => {
                            let [across, down] =
                                [0, 1].map(|i| INSET.0[i] - INSET.1 + [x, y][i] / LARGER);
                            of(across, down.min(SHOWN[1] - 1))
                        }
                    };
                }
            }
        }
    }
    let mut file = std::fs::File::create(path)?;
    write!(file, "P6\n{} {}\n255\n", size[0], size[1])?;
    file.write_all(&page.iter().flat_map(|grey| [*grey; 3]).collect::<Vec<u8>>())
}
