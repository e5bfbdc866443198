//! The 30 s recording, painted offline: process time from start to picture.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use maulstick_device::Take;
use maulstick_device::demo;
use maulstick_device::table::{TableLayout, import};
use maulstick_rig::UserError;

use crate::peers::Libmypaint;
use crate::report::Report;
use crate::running::maulstick;
use crate::tails;

/// Side of the canvas, mm.
const SIDE_MM: f64 = 256.0;
/// Side of a usual cell, mm.
const USUAL_MM: f64 = 0.25;
/// Runs of which the median is reported.
const RUNS: usize = 5;
/// Four loads in turn.
const LOADS: [&str; 4] = [
    "Ultramarine Blue",
    "Pyrrole Red",
    "Yellow Ochre",
    "Phthalo Green Blue Shade=0.3,Titanium White=0.7",
];

/// The recording of a person's strokes if it is beside the project, else the demo; and its length in seconds.
pub(crate) fn performance(place: &Path) -> Result<(PathBuf, f64), UserError> {
    let table =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/painting30sec.dat");
    let take = if table.exists() {
        import(&table, TableLayout::default(), "table")?.take
    } else {
        eprintln!("the 30 s recording is not there: the demo takes its place");
        demo::performance(demo::Subject::Flower, 1)
    };
    let path = place.join("take.mcap");
    take.write(&path)?;
    Ok((
        path,
        Take::read(&place.join("take.mcap"))?.length_ns() as f64 * 1e-9,
    ))
}

/// Measures and reports.
pub(crate) fn run(report: &mut Report, model: &str) -> Result<(), UserError> {
    let fault = |error: std::io::Error| UserError::failure(error.to_string());
    let place = tempfile::tempdir().map_err(fault)?;
    let place = place.path();
    let (take, _) = performance(place)?;
    let peer = Libmypaint::build(place, &Take::read(&take)?);
    if peer.is_none() {
        eprintln!("libmypaint-dev, mypaint-brushes or cc are missing: without libmypaint");
    }
    let (mut seconds, mut pairs) = (Vec::new(), Vec::new());
    for _ in 0..RUNS {
        seconds.push(painted(place, &take, (USUAL_MM, model))?);
        if let Some(peer) = &peer {
            let start = Instant::now();
            peer.paint()?;
            pairs.push((seconds[seconds.len() - 1], start.elapsed().as_secs_f64()));
        }
    }
    let name = "recording.025.time";
    if pairs.is_empty() {
        report.median(name, "s", seconds)
    } else {
        report.paired(name, "s", "libmypaint, modelling", &pairs)
    }
    let ledger = std::fs::read(place.join("l.json")).map_err(fault)?;
    let ledger: serde_json::Value =
        serde_json::from_slice(&ledger).map_err(|error| UserError::failure(error.to_string()))?;
    for (name, key) in [
        ("recording.steps", "steps"),
        ("recording.footprint_cells", "footprint_cells"),
        ("recording.covered_cells", "covered_cells"),
        ("recording.quanta_missing", "quanta_missing"),
    ] {
        report.row(name, ledger[key].as_f64().unwrap_or(f64::NAN), "");
    }
    for (name, cell_mm) in [
        ("recording.0125.time", 0.125),
        ("recording.00625.time", 0.0625),
    ] {
        report.row(name, painted(place, &take, (cell_mm, model))?, "s");
    }
    let cells = (SIDE_MM / USUAL_MM).round() as u32;
    tails::run(report, &Take::read(&take)?, &LOADS, (cells, USUAL_MM))
}

/// Paints the take on cells of a side by a model; how long that takes, s.
fn painted(place: &Path, take: &Path, (cell_mm, model): (f64, &str)) -> Result<f64, UserError> {
    let fault = |error: std::io::Error| UserError::failure(error.to_string());
    let start = Instant::now();
    let side = (SIDE_MM / cell_mm).round();
    let mut command = Command::new(maulstick()?);
    command.arg("render").arg(take).args(["-o", "p.png"]);
    command.args(["--ledger", "l.json", "--cell-mm", &cell_mm.to_string()]);
    command.args(["--size", &format!("{side}x{side}"), "--model", model]);
    command.args(LOADS.iter().flat_map(|load| ["--load", load]));
    let status = command.current_dir(place).status().map_err(fault)?;
    if status.success() {
        Ok(start.elapsed().as_secs_f64())
    } else {
        Err(UserError::failure("the recording cannot be rendered"))
    }
}
