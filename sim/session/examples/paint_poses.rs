//! Paints with a brush that follows given poses, like a robot's, and writes the picture:
//!
//! ```text
//! cargo run --release -p maulstick-session --example paint_poses -- picture.png [poses.csv]
//! ```
//!
//! The table has the columns `t,x,y,z,qx,qy,qz,qw`: time, s, and the pose of the ferrule on the desk, m; the bristles point
//! along its −z, the middle of the canvas is the origin. Without a table the brush draws a spiral.

use std::error::Error;
use std::f64::consts::TAU;
use std::fs::File;
use std::io::BufWriter;

use maulstick_brush::BrushFile;
use maulstick_brush::single_spine::{HEADER, poses};
use maulstick_num::sin_cos;
use maulstick_optics::PaintLibrary;
use maulstick_painting::picture::picture;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_session::Offline;
use maulstick_types::scene::CANVAS;
use maulstick_types::stylus::{StylusPose, StylusSample, axes};

/// Poses a second of the spiral.
const RATE_HZ: f64 = 100.0;
/// Lean of the handle along x, rad.
const LEAN_RAD: f64 = 0.35;

/// Three turns outward in six seconds; the ferrule is a quarter of the head nearer than where the bristles just touch.
fn spiral(head_m: f64) -> String {
    let (sine, cosine) = sin_cos(0.5 * LEAN_RAD);
    let mut text = format!("{HEADER}\n");
    for pose in 0..=600 {
        let t = f64::from(pose) / RATE_HZ;
        let radius_m = 0.01 + 0.006 * t;
        let (y, x) = sin_cos(0.5 * TAU * t);
        let (x, y, z) = (radius_m * x, radius_m * y, 0.75 * head_m);
        text += &format!("{t},{x},{y},{z},0,{sine},0,{cosine}\n");
    }
    text
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let to = arguments.next();
    let to = to.ok_or("name the picture to write: paint_poses picture.png [poses.csv]")?;
    let file = BrushFile::library("round")?;
    let table = match arguments.next() {
        Some(path) => std::fs::read_to_string(path)?,
        None => spiral(file.length_m()),
    };

    let setup = PaintingSetup {
        cells: [512, 512],
        ..PaintingSetup::default()
    };
    let painting = Painting::new(&setup, PaintLibrary::measured()?)?;
    let loads = vec!["Ultramarine Blue=0.6,Titanium White=0.4".parse()?];
    let mut offline = Offline::new(painting, "main", file, 0.5, loads)?;
    for pose in poses(&table)? {
        let sample = StylusSample {
            senses: axes::POSITION | axes::ORIENTATION,
            pose: StylusPose::Ferrule {
                pose: pose.brush.to_pose(),
            },
            in_range: true,
            ..StylusSample::away()
        };
        offline.sample((pose.t * 1e9) as u64, &sample)?;
    }
    offline.end_take()?;

    let painting = offline.painting_mut();
    let report = painting.report();
    println!(
        "{} steps of the brush, {} cells covered, {} quanta missing",
        report.steps, report.covered_cells, report.quanta_missing
    );
    picture(painting, CANVAS).encode_png(BufWriter::new(File::create(&to)?))?;
    println!("{to}");
    Ok(())
}
