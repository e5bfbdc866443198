//! Size of a painting's file after so many strokes of a hand, by its tables:
//! `cargo run --release -p maulstick-session --example file_size -- 150`.
//!
//! The canvas is 25.6 cm wide, of 1024 × 1024 cells; a stroke lasts a second and a half, and another four pass before the next.
//! What the document does in that time it does here between two strokes.

use std::path::Path;

use maulstick_brush::BrushFile;
use maulstick_document::{Access, Document, DocumentSettings, DocumentStats};
use maulstick_optics::PaintLibrary;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_session::{Autosave, Offline};
use maulstick_types::Mixture;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng as _;

type Fault = Box<dyn std::error::Error>;

/// Samples of a stroke, at 200 Hz, and of the pause after it.
const SAMPLES: [u64; 2] = [300, 800];
const SAMPLE_NS: u64 = 5_000_000;

const MIXTURES: [&str; 6] = [
    "Ultramarine Blue=0.6,Titanium White=0.4",
    "Titanium White",
    "Yellow Ochre=0.7,Titanium White=0.3",
    "Pyrrole Red=0.5,Bone Black=0.5",
    "Cobalt Blue=0.3,Yellow Ochre=0.7",
    "Bone Black=0.2,Titanium White=0.8",
];

fn main() -> Result<(), Fault> {
    let mut arguments = std::env::args().skip(1);
    let strokes: u64 = arguments.next().map_or(Ok(30), |text| text.parse())?;
    let path = arguments.next();
    let folder = std::env::temp_dir().join(format!("file-size-{}", std::process::id()));
    let path = path.map_or_else(|| folder.join("hand.maul"), Into::into);
    std::fs::create_dir_all(&folder)?;
    paint(&path, strokes)?;
    let stats = DocumentStats::read(&path)?;
    println!("{strokes} strokes: {:.1} MB", stats.bytes as f64 / 1e6);
    for (table, bytes) in &stats.tables {
        println!("  {table:<10} {:.2} MB", *bytes as f64 / 1e6);
    }
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}

fn paint(path: &Path, strokes: u64) -> Result<(), Fault> {
    let (document, _) = Document::open(&DocumentSettings::new(path, Access::Paint))?;
    let setup = PaintingSetup {
        cells: [1024, 1024],
        cell_m: 0.25e-3,
        ..PaintingSetup::default()
    };
    let pager = document.pager().clone();
    let painting = Painting::paged(&setup, PaintLibrary::measured()?, pager)?;
    let loads: Result<Vec<Mixture>, _> = MIXTURES.iter().map(|text| text.parse()).collect();
    let file = BrushFile::library("flat")?;
    let mut offline = Offline::new(painting, "main", file, 0.5, loads?)?;
    let mut autosave = Autosave::new(document, offline.sequencer_mut(), 0);
    let mut dice = Pcg64Mcg::new(11);
    let mut unit = move || (dice.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let mut now_ns = 1_000_000_000;
    let mut saved_ns = now_ns;
    for _ in 0..strokes {
        let from = [0, 1].map(|_| 0.2 * (unit() - 0.5));
        let to = [0, 1].map(|_| 0.2 * (unit() - 0.5));
        let bend = [0, 1].map(|_| 0.05 * (unit() - 0.5));
        let press = 0.3 + 0.5 * unit();
        let samples: Vec<(u64, StylusSample)> = (0..SAMPLES[0] + SAMPLES[1])
            .map(|number| {
                let t = (number as f64 / SAMPLES[0] as f64).min(1.0);
                let at = |i: usize| from[i] + (to[i] - from[i]) * t + bend[i] * 4.0 * t * (1.0 - t);
                let sample = StylusSample {
                    pose: StylusPose::Contact {
                        point_m: [at(0), at(1), 0.0],
                        tilt_rad: DEFAULT_TILT_RAD,
                        twist_rad: 0.0,
                        pressure: press * (8.0 * t.min(1.0 - t)).min(1.0),
                    },
                    in_range: true,
                    ..StylusSample::away()
                };
                (now_ns + number * SAMPLE_NS, sample)
            })
            .collect();
        now_ns += samples.len() as u64 * SAMPLE_NS;
        let followed: Vec<(u64, &StylusSample)> =
            samples.iter().map(|(ns, sample)| (*ns, sample)).collect();
        offline.follow(&followed, |sequencer, number| {
            let now_ns = followed[number].0;
            autosave.turn(sequencer, now_ns);
            if now_ns >= saved_ns + 1_000_000_000 {
                saved_ns = now_ns;
                autosave.document().flush();
            }
        })?;
    }
    autosave.close(offline.sequencer_mut())?;
    Ok(())
}
