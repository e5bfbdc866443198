//! A painting with a brush, strokes for it, and the difference of two such paintings.

use maulstick_appearance::picture::{Depth, Export};
use maulstick_brush::BrushFile;
use maulstick_gpu::Device;
use maulstick_model::interface::PaintModel;
use maulstick_optics::PaintLibrary;
use maulstick_optics::colour::{RgbSpace, apply, delta_e_2000, lab, srgb_decode};
use maulstick_painting::edits::{Fill, FillPaint, Load};
use maulstick_painting::picture::flat_drawing;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{BrushName, FilmThickness};
use maulstick_types::{Mixture, Pose};

/// Cells of .25 mm of the canvas either way.
const SIDE: u32 = 128;
/// Quanta of 1 µm.
const MICROMETRE: f32 = 671.0;

/// The round brush with few strips.
pub(crate) fn brush() -> BrushFile {
    let mut file = BrushFile::library("round").expect("round");
    file.strips.count = 48;
    file.scaled_to(8.0).expect("a size")
}

pub(crate) fn mixture(text: &str) -> Mixture {
    text.parse().expect("a mixture")
}

/// Makes a painting, on a device if there is one.
pub(crate) type Easel<'a> = &'a dyn Fn(Option<Device>) -> Painting;

/// A canvas with a film of white and cells `finer` times as small, and a brush with blue, of the model of this name, whose
/// steps another one may compute.
pub(crate) fn easel_of((name, finer): (&str, u32), model: Option<Box<dyn PaintModel>>) -> Painting {
    let setup = PaintingSetup {
        cells: [finer * SIDE; 2],
        cell_m: 2.5e-4 / f64::from(finer),
        model: name.to_owned(),
        ..PaintingSetup::default()
    };
    let library = PaintLibrary::measured().expect("whole");
    let mut painting = Painting::new(&setup, library).expect("a painting");
    if let Some(model) = model {
        painting.set_model(model);
    }
    for name in ["main", "other"] {
        painting.define_brush(name, brush());
    }
    painting
        .apply(Fill {
            paint: FillPaint::Mixture {
                mixture: mixture("Titanium White"),
            },
            thickness: FilmThickness::new(40e-6).expect("in range"),
            surface: CANVAS,
        })
        .expect("laid");
    painting
        .apply(Load {
            mixture: mixture("Ultramarine Blue=0.6,Yellow Ochre=0.4"),
            beside: None,
            brush: BrushName::main(),
        })
        .expect("loaded");
    painting
        .apply(Load {
            mixture: mixture("Pyrrole Red"),
            beside: None,
            brush: BrushName::new("other").expect("valid"),
        })
        .expect("loaded");
    painting
}

/// States of a stroke, `shift` mm higher than the first: across, pressed and turning.
pub(crate) fn stroke(number: u64, shift: f64, states: usize) -> Vec<BrushState> {
    let file = brush();
    let state = |i: usize| {
        let t = i as f64 / states as f64;
        let (sine, cosine) = maulstick_num::sin_cos(0.3 * t);
        let y_mm = 10.0 + shift + 2.0 * maulstick_num::sin(4.0 * t);
        let joints = file.spines.all_joints();
        BrushState {
            device: 1,
            device_epoch: 1,
            device_seq: 0,
            solves: vec![Solve {
                event_ns: 0,
                stroke: number,
                surface: CANVAS,
                flags: 0,
                pose: Pose {
                    position_m: [
                        (8.0 + 16.0 * t) * 1e-3,
                        y_mm * 1e-3,
                        (0.75 - 0.25 * t) * file.length_m(),
                    ],
                    orientation: [0.0, 0.0, sine, cosine],
                },
                zoom: 1.0,
                angles_rad: (0..joints).map(|_| [0.1, 0.25]).collect(),
                contacts: Vec::new(),
            }],
        }
    };
    (0..states).map(state).collect()
}

/// The brush is lifted.
pub(crate) fn lifted() -> BrushState {
    let mut states = stroke(0, 0.0, 1);
    states.remove(0)
}

pub(crate) fn paint(painting: &mut Painting, brush: &str, states: &[BrushState]) {
    for state in states {
        painting.state(brush, 1, state).expect("it fits");
    }
}

/// Quanta of all paints on the canvas.
pub(crate) fn volume(painting: &mut Painting) -> u64 {
    painting.commit();
    let store = painting.store(CANVAS).expect("a canvas");
    store.counts().iter().sum()
}

/// Counts of a canvas's tiles and of what brushes carry: all that a stroke changes.
pub(crate) fn all(painting: &mut Painting) -> Vec<Vec<u32>> {
    let checkpoint = painting.checkpoint(0);
    let mut all = Vec::new();
    for (place, version) in &checkpoint.tiles {
        let Some(tile) = &version.tile else { continue };
        for (slot, plane) in &*tile.wet() {
            let mut counts = vec![place.0, place.1.x, place.1.y, *slot as u32];
            counts.extend(plane.iter().map(|count| *count as u32));
            all.push(counts);
        }
    }
    for page in checkpoint.loads.values() {
        let load = page.get();
        all.push(load.films().to_vec());
        for slot in 0..16 {
            all.extend(load.film_of(slot).map(<[u32]>::to_vec));
            all.extend(load.inside(slot).map(<[u32]>::to_vec));
        }
    }
    all
}

fn colours(painting: &mut Painting) -> Vec<[f64; 3]> {
    let export = Export::default();
    let drawing = flat_drawing(painting, CANVAS, &export).expect("a canvas");
    let to_xyz = RgbSpace::Srgb.to_xyz();
    let white = apply(&to_xyz, [1.0; 3]);
    let mut colours = Vec::new();
    for band in 0..drawing.banded().bands() {
        let values = drawing.band(band, Depth::Sixteen);
        colours.extend(values.chunks_exact(6).map(|pixel| {
            let linear = [0, 1, 2].map(|c| {
                let value = u16::from_be_bytes([pixel[2 * c], pixel[2 * c + 1]]);
                srgb_decode(f64::from(value) / 65535.0)
            });
            lab(apply(&to_xyz, linear), white)
        }));
    }
    colours
}

/// Wet quanta by cell, in the order of the pictures: from the top row.
fn wet(painting: &mut Painting) -> Vec<f32> {
    painting.commit();
    let side = painting.store(CANVAS).expect("a canvas").cells()[0] as usize;
    let mut wet = vec![0.0; side * side];
    for (id, version) in painting.store(CANVAS).expect("a canvas").iter() {
        let Some(tile) = &version.tile else { continue };
        for (_, plane) in &*tile.wet() {
            for (cell, count) in plane.iter().enumerate() {
                let x = id.x as usize * 64 + cell % 64;
                let y = id.y as usize * 64 + cell / 64;
                wet[(side - 1 - y) * side + x] += count;
            }
        }
    }
    wet
}

/// Mean and 99th percentile of ΔE00 where either has more than 1 µm of wet paint.
pub(crate) fn difference(one: &mut Painting, two: &mut Painting) -> [f64; 2] {
    let (wet_one, wet_two) = (wet(one), wet(two));
    let pairs = colours(one).into_iter().zip(colours(two));
    let mut apart: Vec<f64> = pairs
        .zip(wet_one.iter().zip(&wet_two))
        .filter(|(_, (a, b))| a.max(**b) > MICROMETRE)
        .map(|((a, b), _)| delta_e_2000(a, b))
        .collect();
    apart.sort_by(f64::total_cmp);
    assert!(apart.len() > 1000, "{} cells", apart.len());
    let mean = apart.iter().sum::<f64>() / apart.len() as f64;
    [mean, apart[apart.len() * 99 / 100]]
}

/// Paint that a stroke left on two canvases, on which there was as much `before`: how far the volumes are apart, as a share,
/// and mean and 99th percentile of ΔE00.
pub(crate) fn apart(one: &mut Painting, two: &mut Painting, before: u64) -> (f64, [f64; 2]) {
    let deposited = |after: u64| after as f64 - before as f64;
    let off = (deposited(volume(two)) / deposited(volume(one)) - 1.0).abs();
    let colours = difference(one, two);
    println!("volume off by {off:.2e}, ΔE00 {colours:.3?}");
    (off, colours)
}
