//! Times and sizes of solids: strokes of a heavy brush over a square canvas, written as STL and as binary
//! glTF at a step of one cell.
//! `cargo run --release -p maulstick-exchange --example solid -- MODEL CELLS FOLDER`.

use std::error::Error;
use std::fs::File;
use std::path::Path;
use std::time::Instant;

use maulstick_brush::BrushFile;
use maulstick_exchange::{SolidSetup, write_glb, write_stl};
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::Load;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::Pose;
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::BrushName;

/// Side of a cell, m.
const CELL_M: f64 = 2.5e-4;
/// Distance between strokes, and from a stroke to the rim, mm.
const APART_MM: f64 = 16.0;
/// Distance between poses of a brush, mm.
const POSE_MM: f64 = 2.0;
const PAINTS: [&str; 3] = ["Pyrrole Red", "Titanium White", "Ultramarine Blue"];
const SETUP: SolidSetup = SolidSetup {
    base_mm: 2.0,
    exaggeration: 1.0,
    step: 1,
};

/// Strokes from left to right over all of a canvas.
fn painted(model: &str, side: u32) -> Result<Painting, Box<dyn Error>> {
    let setup = PaintingSetup {
        cells: [side; 2],
        model: model.to_owned(),
        cell_m: CELL_M,
        ..PaintingSetup::default()
    };
    let mut painting = Painting::new(&setup, PaintLibrary::measured()?)?;
    let file = BrushFile::library("round")?.scaled_to(8.0)?;
    painting.define_brush("main", file.clone());
    let side_mm = f64::from(side) * CELL_M * 1e3;
    let strokes = ((side_mm / APART_MM) as u32).saturating_sub(1);
    let poses = ((side_mm - 2.0 * APART_MM).max(0.0) / POSE_MM) as u64;
    for stroke in 0..strokes {
        let up_mm = APART_MM * f64::from(stroke + 1);
        let [one, other] = [0, 1].map(|next| PAINTS[(stroke as usize + next) % PAINTS.len()]);
        painting.apply(Load {
            mixture: format!("{one}=0.5,{other}=0.5").parse()?,
            beside: None,
            brush: BrushName::main(),
        })?;
        let solve = |pose: u64| Solve {
            event_ns: 0,
            stroke: u64::from(stroke) + 1,
            surface: CANVAS,
            flags: 0,
            pose: Pose {
                position_m: [
                    (APART_MM + POSE_MM * pose as f64) * 1e-3,
                    up_mm * 1e-3,
                    0.6 * file.length_m(),
                ],
                ..Pose::IDENTITY
            },
            zoom: 1.0,
            angles_rad: vec![[0.2, 0.3]; file.spines.all_joints()],
            contacts: Vec::new(),
        };
        let state = BrushState {
            device: 1,
            device_epoch: 1,
            device_seq: 0,
            solves: (0..=poses).map(solve).collect(),
        };
        painting.state("main", stroke + 1, &state)?;
    }
    Ok(painting)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, cells, folder] = &arguments[..] else {
        eprintln!("solid MODEL CELLS FOLDER, say `solid impasto 1024 /tmp`");
        std::process::exit(2);
    };
    let began = Instant::now();
    let mut painting = painted(model, cells.parse()?)?;
    println!("painted in {:.1} s", began.elapsed().as_secs_f64());
    for ending in ["stl", "glb"] {
        let path = Path::new(folder).join(format!("{model}.{ending}"));
        let (began, file) = (Instant::now(), File::create(&path)?);
        let mut untold = |_, _| {};
        let size = match ending {
            "stl" => write_stl(&mut painting, CANVAS, &SETUP, file, &mut untold)?,
            _ => write_glb(&mut painting, CANVAS, &SETUP, file, &mut untold)?,
        };
        println!(
            "{}: {} triangles, {:.1} MB in {:.2} s",
            path.display(),
            size.triangles,
            std::fs::metadata(&path)?.len() as f64 * 1e-6,
            began.elapsed().as_secs_f64(),
        );
    }
    Ok(())
}
