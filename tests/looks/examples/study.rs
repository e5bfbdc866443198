//! Strokes to look at, 1:1: `study OUT.ppm CELL_MM`.

use maulstick_looks::easel::{Easel, Stroke, brush};
use maulstick_painting::picture::picture;
use maulstick_rig::UserError;

fn line(from: [f64; 2], to: [f64; 2], pressure: f64) -> Stroke {
    Stroke {
        from,
        to,
        pressure,
        lean_deg: 25.0,
    }
}

/// A loaded stroke, a light oblique one, white through wet blue.
fn strokes(easel: &mut Easel) -> Result<(), UserError> {
    let blue = "Ultramarine Blue=0.6,Titanium White=0.4";
    easel.load(blue)?;
    easel.stroke(&line([10.0, 120.0], [75.0, 120.0], 0.5))?;
    easel.load(blue)?;
    easel.stroke(&line([85.0, 108.0], [140.0, 124.0], 0.3))?;
    for x in [30.0, 42.0] {
        easel.load("Ultramarine Blue")?;
        easel.stroke(&line([x, 82.0], [x, 108.0], 0.5))?;
    }
    easel.take_up("white", brush("flat", 14.0)?)?;
    easel.load("Titanium White")?;
    easel.stroke(&line([12.0, 95.0], [90.0, 95.0], 0.5))
}

/// A clean filbert from red into yellow, and a badger over their seam.
fn smears(easel: &mut Easel) -> Result<(), UserError> {
    easel.take_up("wide", brush("flat", 14.0)?)?;
    let colours = ["Pyrrole Red", "Hansa Yellow Opaque"];
    for (place, x) in [15.0, 28.0, 41.0, 54.0].into_iter().enumerate() {
        easel.load(colours[place / 2])?;
        easel.stroke(&line([x, 46.0], [x, 76.0], 0.5))?;
    }
    easel.take_up("clean", brush("filbert", 10.0)?)?;
    easel.stroke(&line([12.0, 68.0], [58.0, 68.0], 0.4))?;
    easel.take_up("badger", brush("badger", 25.0)?)?;
    for _ in 0..3 {
        easel.stroke(&line([20.0, 52.0], [50.0, 52.0], 0.1))?;
        easel.stroke(&line([50.0, 52.0], [20.0, 52.0], 0.1))?;
    }
    Ok(())
}

/// A double load, a brush painted out, dabs, four strokes of a filbert.
fn loads(easel: &mut Easel) -> Result<(), UserError> {
    easel.take_up("double", brush("flat", 14.0)?)?;
    easel.load_beside("Quinacridone Magenta=0.6,Pyrrole Red=0.4", "Titanium White")?;
    easel.stroke(&line([75.0, 78.0], [140.0, 78.0], 0.5))?;
    easel.take_up("out", brush("flat", 14.0)?)?;
    easel.load("Burnt Umber")?;
    for stroke in 0..10 {
        let y = 30.0 + 5.0 * f64::from(stroke % 3);
        easel.stroke(&line([75.0, y], [140.0, y], 0.4))?;
    }
    easel.stroke(&line([75.0, 60.0], [140.0, 60.0], 0.05))?;
    easel.take_up("round", brush("round", 8.0)?)?;
    for dab in 0..6 {
        easel.load("Titanium White=0.8,Hansa Yellow Opaque=0.2")?;
        let x = 80.0 + 11.0 * f64::from(dab);
        easel.stroke(&line([x, 95.0], [x + 0.5, 95.0], 0.4))?;
    }
    easel.take_up("filbert", brush("filbert", 12.0)?)?;
    for stroke in 0..4 {
        easel.load("Titanium White=0.7,Burnt Umber=0.3")?;
        let (y, more) = (35.0 - 9.0 * f64::from(stroke), 0.1 * f64::from(stroke));
        easel.stroke(&line([8.0, y], [66.0, y - 2.0], 0.35 + more))?;
    }
    Ok(())
}

fn main() -> Result<(), UserError> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [path, cell_mm] = &words[..] else {
        return Err(UserError::usage("study OUT.ppm CELL_MM"));
    };
    let cell_mm = cell_mm
        .parse()
        .map_err(|_| UserError::usage(format!("'{cell_mm}' is no side of a cell, mm")))?;
    let flat = brush("flat", 14.0)?;
    let mut easel = Easel::new([150.0, 130.0], cell_mm, "linen", flat)?;
    strokes(&mut easel)?;
    smears(&mut easel)?;
    loads(&mut easel)?;
    let picture = picture(easel.offline.painting_mut(), 0);
    let mut file = format!("P6\n{} {}\n255\n", picture.width, picture.height).into_bytes();
    file.extend(&picture.rgb);
    std::fs::write(path, file).map_err(|error| UserError::failure(format!("{path}: {error}")))
}
