//! Work besides the steps of the 30 s recording: packing its PNG, its light, the heights of its tooth; each as a share
//! of the processor's time for all of it, so a busy machine shows the same. Medians of five.

use std::time::Duration;

use maulstick_appearance::Bakery;
use maulstick_appearance::picture::{Depth, Export, Picture};
use maulstick_brush::BrushFile;
use maulstick_canvas::tile::TileId;
use maulstick_device::Take;
use maulstick_exchange::write_lit_png;
use maulstick_optics::PaintLibrary;
use maulstick_painting::picture::lit_drawing;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_rig::UserError;
use maulstick_session::Offline;
use maulstick_types::scene::CANVAS;

use crate::report::{Report, quantile, sorted};
use crate::thread_cpu::{process_cpu, thread_cpu};

/// Width of its brush, mm, and the share of the head's length by which full pressure presses it in.
const BRUSH_MM: f64 = 10.0;
const DEPTH_SHARE: f64 = 0.5;
/// Largest share of each.
const SHARE_MAX: f64 = 0.05;
/// Runs of which the median is reported.
const RUNS: usize = 5;

fn fault(error: impl ToString) -> UserError {
    UserError::failure(error.to_string())
}

/// Measures and reports.
pub(crate) fn run(
    report: &mut Report,
    take: &Take,
    loads: &[&str],
    (cells, cell_mm): (u32, f64),
) -> Result<(), UserError> {
    let begun = process_cpu();
    let setup = PaintingSetup {
        cells: [cells; 2],
        cell_m: 1e-3 * cell_mm,
        ..PaintingSetup::default()
    };
    let library = PaintLibrary::measured().map_err(fault)?;
    let painting = Painting::new(&setup, library).map_err(fault)?;
    let brush = BrushFile::library("round").map_err(fault)?;
    let brush = brush.scaled_to(BRUSH_MM).map_err(fault)?;
    let loads: Result<Vec<_>, _> = loads.iter().map(|load| load.parse()).collect();
    let loads = loads.map_err(|error| fault(format!("{error}")))?;
    let refused = |refusal: maulstick_painting::EditError| fault(refusal);
    let mut offline = Offline::new(painting, "main", brush, DEPTH_SHARE, loads).map_err(refused)?;
    let samples: Vec<_> = take
        .samples
        .iter()
        .map(|at| (at.time_ns, &at.sample))
        .collect();
    offline.follow(&samples, |_, _| {}).map_err(refused)?;
    let mut painting = offline.into_painting();
    let (export, mut file) = (Export::default(), Vec::new());
    let looks = (&export, Depth::Eight);
    write_lit_png(&mut painting, CANVAS, looks, &mut file, &mut |_, _| {}).map_err(fault)?;
    let whole = (process_cpu() - begun).as_secs_f64();
    let (light, pixels) = light(&mut painting, &export)?;
    for (name, took) in [
        ("recording.light_share", light),
        ("recording.png_share", packing(cells as usize, pixels)?),
        ("recording.tooth_share", tooth(&setup)?),
    ] {
        report.beside(name, took / whole, "", ("target", SHARE_MAX));
    }
    Ok(())
}

/// Median duration of several runs, s, and the result of the last.
fn median<T>(
    mut work: impl FnMut() -> Result<(T, Duration), UserError>,
) -> Result<(f64, T), UserError> {
    let (mut made, took) = work()?;
    let mut seconds = vec![took.as_secs_f64()];
    for _ in 1..RUNS {
        let took;
        (made, took) = work()?;
        seconds.push(took.as_secs_f64());
    }
    Ok((quantile(&sorted(seconds), 0.5), made))
}

/// Time of light, shadows, gamut and encoding of the picture, s, and its pixels.
fn light(painting: &mut Painting, export: &Export) -> Result<(f64, Vec<u8>), UserError> {
    let drawing = lit_drawing(painting, CANVAS, export);
    let drawing = drawing.ok_or_else(|| fault("there is no canvas"))?;
    let banded = drawing.banded();
    median(|| {
        let (mut pixels, mut took) = (Vec::new(), Duration::ZERO);
        for band in 0..banded.bands() {
            let heights = banded.heights_around(band);
            let mut rows = drawing.blank(band, Depth::Eight);
            for (id, tile) in banded.tiles(band) {
                let shown = banded.shown(id, tile, &mut Bakery::default());
                let begun = thread_cpu();
                drawing.lay((id, &shown), Some(&heights), Depth::Eight, &mut rows);
                took += thread_cpu() - begun;
            }
            pixels.extend(rows);
        }
        Ok((pixels, took))
    })
}

/// Time of packing a picture as a PNG, s.
fn packing(side: usize, pixels: Vec<u8>) -> Result<f64, UserError> {
    let picture = Picture::srgb(side, side, pixels);
    let (took, _) = median(|| {
        let (mut file, begun) = (Vec::new(), thread_cpu());
        picture.encode_png(&mut file).map_err(fault)?;
        Ok((file, thread_cpu() - begun))
    })?;
    Ok(took)
}

/// Time of the heights of the whole canvas's tooth, once, s.
fn tooth(setup: &PaintingSetup) -> Result<f64, UserError> {
    let (took, _) = median(|| {
        let library = PaintLibrary::measured().map_err(fault)?;
        let painting = Painting::new(setup, library).map_err(fault)?;
        let canvas = painting.store(CANVAS).zip(painting.bare(CANVAS));
        let (store, bare) = canvas.ok_or_else(|| fault("there is no canvas"))?;
        let begun = thread_cpu();
        let [across, up] = store.grid();
        let tiles = (0..up).flat_map(|y| (0..across).map(move |x| TileId { x, y }));
        let cells: usize = tiles.map(|id| bare.relief.tile(id).len()).sum();
        Ok((cells, thread_cpu() - begun))
    })?;
    Ok(took)
}
