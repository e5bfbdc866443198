//! Strokes to look at, 1:1: `study OUT.ppm CELL_MM`.

use maulstick_looks::easel::{Easel, Stroke, brush};
use maulstick_painting::picture::picture;
use maulstick_rig::UserError;

fn main() -> Result<(), UserError> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let cell: f64 = words[1].parse().expect("a number");
    let mut e = Easel::new([150.0, 130.0], cell, "linen", brush("flat", 14.0)?)?;
    let line = |from: [f64; 2], to: [f64; 2], pressure: f64| Stroke {
        from,
        to,
        pressure,
        lean_deg: 25.0,
    };
    // A loaded stroke, a light one, an oblique one.
    e.load("Ultramarine Blue=0.6,Titanium White=0.4")?;
    e.stroke(&line([10.0, 120.0], [75.0, 120.0], 0.5))?;
    e.load("Ultramarine Blue=0.6,Titanium White=0.4")?;
    e.stroke(&line([85.0, 108.0], [140.0, 124.0], 0.3))?;
    // White through wet blue.
    for x in [30.0, 42.0] {
        e.load("Ultramarine Blue")?;
        e.stroke(&line([x, 82.0], [x, 108.0], 0.5))?;
    }
    e.take_up("white", brush("flat", 14.0)?)?;
    e.load("Titanium White")?;
    e.stroke(&line([12.0, 95.0], [90.0, 95.0], 0.5))?;
    // A clean filbert from red into yellow; badger over the seam.
    e.take_up("wide", brush("flat", 14.0)?)?;
    for x in [15.0, 28.0] {
        e.load("Pyrrole Red")?;
        e.stroke(&line([x, 46.0], [x, 76.0], 0.5))?;
    }
    for x in [41.0, 54.0] {
        e.load("Hansa Yellow Opaque")?;
        e.stroke(&line([x, 46.0], [x, 76.0], 0.5))?;
    }
    e.take_up("clean", brush("filbert", 10.0)?)?;
    e.stroke(&line([12.0, 68.0], [58.0, 68.0], 0.4))?;
    e.take_up("badger", brush("badger", 25.0)?)?;
    for k in 0..6 {
        let ends = if k % 2 == 0 {
            [20.0, 50.0]
        } else {
            [50.0, 20.0]
        };
        e.stroke(&line([ends[0], 52.0], [ends[1], 52.0], 0.1))?;
    }
    // Double load; a dry brush; dabs.
    e.take_up("double", brush("flat", 14.0)?)?;
    e.load_beside("Quinacridone Magenta=0.6,Pyrrole Red=0.4", "Titanium White")?;
    e.stroke(&line([75.0, 78.0], [140.0, 78.0], 0.5))?;
    e.take_up("out", brush("flat", 14.0)?)?;
    e.load("Burnt Umber")?;
    for k in 0..10 {
        let y = 30.0 + 5.0 * f64::from(k % 3);
        e.stroke(&line([75.0, y], [140.0, y], 0.4))?;
    }
    e.stroke(&line([75.0, 60.0], [140.0, 60.0], 0.05))?;
    e.take_up("round", brush("round", 8.0)?)?;
    for k in 0..6 {
        e.load("Titanium White=0.8,Hansa Yellow Opaque=0.2")?;
        let x = 80.0 + 11.0 * f64::from(k);
        e.stroke(&line([x, 95.0], [x + 0.5, 95.0], 0.4))?;
    }
    // Six strokes of one load, shorter and shorter, and a long one on the ground.
    e.take_up("wide2", brush("filbert", 12.0)?)?;
    for k in 0..4 {
        e.load("Titanium White=0.7,Burnt Umber=0.3")?;
        let y = 35.0 - 9.0 * f64::from(k);
        e.stroke(&line([8.0, y], [66.0, y - 2.0], 0.35 + 0.1 * f64::from(k)))?;
    }
    let picture = picture(e.offline.painting_mut(), 0);
    let [w, h] = [picture.width, picture.height];
    let mut out = format!("P6\n{w} {h}\n255\n").into_bytes();
    out.extend(picture.rgb.iter());
    std::fs::write(&words[0], out).expect("written");
    Ok(())
}
