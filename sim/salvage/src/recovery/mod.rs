//! Recovery of the intact part of a damaged painting into a new one.
//!
//! Rows are read without SQLite, recognised by their tags and checked by their checksums. Intact rows go into a new file,
//! which is then opened, brought up to the end of its journal and written as any other. Content that depends on lost rows
//! is replaced or dropped:
//!
//! - a tile whose newest state is lost gets its last state in the history, or that of an older copy of its row;
//! - a dry layer whose paint is lost stays without paint; a lost one ends its stack;
//! - a step that cannot be undone from the recovered tiles is dropped with all older ones;
//! - a version with a lost tile is dropped;
//! - a ground or a tooth with a lost picture is replaced by the default;
//! - a brush whose load is lost is clean;
//! - the journal is replayed up to its first gap;
//! - a new record begins.
//!
//! The ledger is balanced: lost paint counts as removed by the cleaner, paint restored with an older tile as from the
//! tubes.

mod error;
mod files;
mod intact_rows;
mod inventory;
mod journal;
mod ledger;
mod materials;
mod painting_row;
mod report;
mod steps;
mod tiles;
mod versions;

use std::path::{Path, PathBuf};

use maulstick_document::file::database::{Database, lock_holder};
use maulstick_document::pack::{Forget, replay_journal};
use maulstick_document::tables::schema::{APPLICATION_ID, Table, VERSION};
use maulstick_document::{Access, DocumentError};
use maulstick_files::companion;
use maulstick_painting::snapshot::{PaintingSnapshot, SequencerSnapshot};

use crate::sqlite::{Scan, Value};
pub use error::SalvageError;
use intact_rows::{IntactRows, RowAge};
use inventory::Inventory;
use materials::MaterialSources;
use painting_row::PaintingRow;
pub use report::SalvageReport;
use steps::{Steps, UndoState, materials};

/// Temporary file of the new painting, which is removed unless it gets its final name.
struct TemporaryFile(PathBuf);

impl TemporaryFile {
    fn remove(&self) {
        for suffix in ["", "-wal", "-journal"] {
            // It may not exist.
            std::fs::remove_file(companion(&self.0, suffix)).ok();
        }
    }

    /// Checks that its journal is merged into it: closing leaves the journal beside it if the disk is full.
    fn check_merged(&self) -> Result<(), DocumentError> {
        match std::fs::metadata(companion(&self.0, "-wal")) {
            Ok(journal) if journal.len() > 0 => Err(DocumentError::Full),
            _ => Ok(()),
        }
    }
}

impl Drop for TemporaryFile {
    fn drop(&mut self) {
        self.remove();
    }
}

/// Recovers the intact part of a damaged painting into a new one. The damaged one is only read. `progress` gets the parts
/// done and their total.
///
/// # Errors
/// [`DocumentError::Taken`] if there is a file at `to`, [`DocumentError::InUse`] if a program has the damaged painting
/// open, [`SalvageError::Lost`] if the intact rows do not make a painting, or the system's error. On an error there is
/// no file at `to`.
pub fn recover(
    damaged: &Path,
    to: &Path,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<SalvageReport, SalvageError> {
    if std::fs::metadata(damaged)?.is_dir() {
        return Err(DocumentError::NoPainting.into());
    }
    // SQLite would take a journal that is already there for the new painting's.
    let mut names = ["", "-wal", "-journal"].into_iter();
    if names.any(|suffix| std::fs::symlink_metadata(companion(to, suffix)).is_ok()) {
        return Err(DocumentError::Taken.into());
    }
    let holder = lock_holder(damaged);
    if holder.is_some() {
        return Err(DocumentError::InUse { holder }.into());
    }
    let format = unknown_format(damaged)?;
    let mut scan = Scan::open(damaged)?;
    let part = TemporaryFile(temporary_path(to));
    part.remove();
    let (database, _) = Database::open(&part.0, Access::Paint, None)?;
    let report = SalvageReport {
        format,
        ..write(&mut scan, &database, progress)?
    };
    database.close()?;
    part.check_merged()?;
    replay_journal(&part.0, Forget::Nothing).map_err(|error| match error {
        DocumentError::Damaged(what) => SalvageError::Lost(what),
        error => error.into(),
    })?;
    part.check_merged()?;
    progress(PARTS, PARTS);
    std::fs::rename(&part.0, to)?;
    Ok(report)
}

/// Temporary path of the new painting until it gets its final name; its journal is beside it.
#[must_use]
pub fn temporary_path(to: &Path) -> PathBuf {
    companion(to, &format!(".part-{}", std::process::id()))
}

/// Format in the file's header, if this program does not know it: a newer one, or a damaged number.
fn unknown_format(damaged: &Path) -> Result<Option<i32>, DocumentError> {
    use std::io::Read as _;
    let mut head = [0; 100];
    let read = std::fs::File::open(damaged)?.read_exact(&mut head);
    let number = |at: usize| i32::from_be_bytes([0, 1, 2, 3].map(|byte| head[at + byte]));
    let [version, application] = [60, 68].map(number);
    let unknown = read.is_ok() && application == APPLICATION_ID && version > VERSION;
    Ok(unknown.then_some(version))
}

/// Number of parts of the progress.
const PARTS: u64 = 1000;

/// Writes the intact content.
fn write(
    scan: &mut Scan<std::fs::File>,
    database: &Database,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<SalvageReport, SalvageError> {
    let mut progress = |from: u64, done: u64, all: u64| {
        progress(from + done * (PARTS / 2) / all.max(1), PARTS + 1);
    };
    let mut rows = IntactRows::read(scan, database, &mut |done, all| progress(0, done, all))?;
    let Some((mut snapshot, painting_age)) = rows.painting.take() else {
        let what = "its state: every copy of scene, ledger and brushes is damaged";
        return Err(SalvageError::Lost(what.to_owned()));
    };
    let (mut sequencer, sequencer_age) = rows
        .sequencer
        .take()
        .unwrap_or((SequencerSnapshot::default(), RowAge::Older));
    let age = match (painting_age, sequencer_age) {
        (RowAge::Current, RowAge::Current) => RowAge::Current,
        _ => RowAge::Older,
    };
    let mut report = SalvageReport {
        rows: rows.damaged,
        pages: rows.pages_lost,
        is_old: age == RowAge::Older,
        ..SalvageReport::default()
    };
    let mut read = |done: u64, all: u64| progress(PARTS / 2, done, all);
    let mut inventory = Inventory::read(database, snapshot.next_page, &mut read)?;
    database.connection().execute_batch("BEGIN IMMEDIATE")?;
    inventory.write_dry_layers(database, &rows.dry)?;
    report.layers = inventory.emptied + inventory.cut_off;
    files::replace_lost(&mut snapshot, &mut report, database)?;
    files::clean_brushes(&mut snapshot, &mut inventory, &mut report, database)?;
    let sources = MaterialSources::read(database)?;
    report
        .files
        .extend(sources.replace_lost(&mut snapshot.scene));
    let intact = (&inventory, &sources);
    write_tiles_and_steps(&mut rows, &mut snapshot, intact, &mut report, database)?;
    let intact = (&mut inventory, &sources);
    versions::write(&rows, &mut snapshot, intact, &mut report, database)?;
    journal::write(&rows, &mut sequencer, age, &mut report, database)?;
    snapshot.next_page = snapshot.next_page.max(inventory.next);
    // Without this count, lost rows are not reported as missing later on.
    snapshot.rows = None;
    for (key, state) in [
        ("painting", serde_json::to_string(&snapshot)?),
        ("sequencer", serde_json::to_string(&sequencer)?),
    ] {
        let values = vec![Value::Text(key.to_owned()), Value::Text(state)];
        PaintingRow::new(Table::State, values).write(database)?;
    }
    database.connection().execute_batch("COMMIT")?;
    Ok(report)
}

fn write_tiles_and_steps(
    rows: &mut IntactRows,
    snapshot: &mut PaintingSnapshot,
    (inventory, sources): (&Inventory, &MaterialSources),
    report: &mut SalvageReport,
    database: &Database,
) -> Result<(), DocumentError> {
    let newest = rows.steps.keys().last().copied().unwrap_or(0);
    snapshot.step = snapshot.step.max(newest.max(0) as u64);
    let steps = Steps::take(rows, snapshot, sources);
    let states = steps.states();
    let tiles = tiles::write(rows, &states, inventory, snapshot, report, database)?;
    let brushes = snapshot.brushes.iter();
    let now = UndoState {
        loads: brushes
            .filter_map(|(name, brush)| Some((name.clone(), inventory.load(brush.load)?)))
            .collect(),
        layers: snapshot.scene.layers.clone(),
        materials: materials(&snapshot.scene),
        tiles: tiles.clone(),
    };
    let written = steps.write(now, inventory, database)?;
    (report.steps, report.lost_steps) = (written.count, written.dropped);
    snapshot
        .open_steps
        .retain(|open| written.done.contains(&open.step));
    snapshot.undone = written.undone;
    let loads = snapshot.brushes.values().map(|brush| &brush.load);
    let there = ledger::paint(inventory, tiles.into_values(), loads);
    ledger::balance(&mut snapshot.ledger, &there);
    Ok(())
}
