//! The 30 s recording, painted offline: process time from start to picture.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use maulstick_device::Take;
use maulstick_device::demo;
use maulstick_device::table::{TableLayout, import};
use maulstick_rig::Fault;

use crate::report::{Report, quantile, sorted};
use crate::running::maulstick;

/// Runs of which the median is reported.
const RUNS: usize = 5;
/// Four loads in turn.
const LOADS: [&str; 4] = [
    "Ultramarine Blue",
    "Pyrrole Red",
    "Yellow Ochre",
    "Phthalo Green Blue Shade=0.3,Titanium White=0.7",
];

/// The recording of a person's strokes if it lies beside the project, else the demo; and its length
/// in seconds.
pub(crate) fn performance(place: &Path) -> Result<(PathBuf, f64), Fault> {
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
pub(crate) fn run(report: &mut Report) -> Result<(), Fault> {
    let fault = |error: std::io::Error| Fault::failure(error.to_string());
    let place = tempfile::tempdir().map_err(fault)?;
    let (take, _) = performance(place.path())?;
    let mut seconds = Vec::new();
    for _ in 0..RUNS {
        let start = Instant::now();
        let mut command = Command::new(maulstick()?);
        command.arg("render").arg(&take).args([
            "-o",
            "p.png",
            "--ledger",
            "l.json",
            "--cell-mm",
            "0.25",
        ]);
        command.args(LOADS.iter().flat_map(|load| ["--load", load]));
        let status = command.current_dir(place.path()).status().map_err(fault)?;
        if !status.success() {
            return Err(Fault::failure("the recording cannot be rendered"));
        }
        seconds.push(start.elapsed().as_secs_f64());
    }
    report.row("recording.time", quantile(&sorted(seconds), 0.5), "s");
    let ledger = std::fs::read(place.path().join("l.json")).map_err(fault)?;
    let ledger: serde_json::Value =
        serde_json::from_slice(&ledger).map_err(|error| Fault::failure(error.to_string()))?;
    for (name, key) in [
        ("recording.steps", "steps"),
        ("recording.footprint_cells", "footprint_cells"),
        ("recording.covered_cells", "covered_cells"),
        ("recording.quanta_missing", "quanta_missing"),
    ] {
        report.row(name, ledger[key].as_f64().unwrap_or(f64::NAN), "");
    }
    Ok(())
}
