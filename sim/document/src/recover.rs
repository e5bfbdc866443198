//! Recovery of the intact part of a damaged painting into a new one.
//!
//! Rows are read without SQLite, told apart by their tags and checked by their sums. Those that are
//! whole go into a new file, which is then opened, brought up to the journal and written as any other.
//! What cannot stand any more without the rest goes:
//!
//! - a tile whose newest state is gone is as the history, or an older copy of its row, last had it;
//! - a dry layer whose paint is gone stays without paint, one of which nothing is known ends its stack;
//! - a step that does not lead back from what is on the tiles now goes with all older ones;
//! - a version of which a tile is gone goes;
//! - a ground or a tooth of which the picture is gone is the plain one;
//! - a brush of which it is not known what it carried is clean;
//! - the journal is done again up to its first gap.
//!
//! The ledger is made to balance: paint that is gone counts as taken by the cleaner, paint that came
//! back with an older tile as given by the tubes.

mod found;
mod gathering;
mod pictures;
mod rest;
mod steps;
mod stock;
mod tiles;

use std::path::{Path, PathBuf};

use maulstick_painting::history::TilePlace;
use maulstick_painting::snapshot::{PaintingSnapshot, SequencerSnapshot};

use crate::database::{Access, Database, beside, holder};
use crate::error::DocumentError;
use crate::pack::{History, settle};
use crate::scan::{Scan, Value};
use crate::schema::{APPLICATION_ID, Table, VERSION};
use found::Found;
use gathering::{Gathered, Standing};
use pictures::Pictures;
use steps::{Now, Steps, makes};
use stock::Stock;

/// Content recovered from a damaged painting, and its losses.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Salvage {
    /// Tiles with paint that are as they were.
    pub tiles: u64,
    /// Tiles that are as the history or an older copy had them.
    pub older: Vec<TilePlace>,
    /// Tiles that lost wet paint or a dry layer.
    pub thinned: Vec<TilePlace>,
    /// Tiles that lost everything.
    pub missing: Vec<TilePlace>,
    /// Dry layers of tiles that lost their paint, or all that was below them.
    pub layers: u64,
    /// Steps that are there.
    pub steps: u64,
    /// Steps that are gone.
    pub lost_steps: u64,
    /// Versions that are there.
    pub versions: u64,
    /// Versions that are gone.
    pub lost_versions: Vec<String>,
    /// Brushes that are clean because it is not known what they carried.
    pub brushes: Vec<String>,
    /// Files that were lost and have others in their place.
    pub files: Vec<String>,
    /// Accepted things that were done again.
    pub records: u64,
    /// Accepted things that could not be done again.
    pub lost_records: u64,
    /// Rows that are not what was written.
    pub rows: u64,
    /// Pages of the file that are gone, with all rows on them.
    pub pages: u64,
    /// True if the state of the painting besides its tiles is an older one.
    pub is_old: bool,
    /// The format that the file names, if this program does not know it: a newer one may hold more than was found.
    pub format: Option<i32>,
}

impl Salvage {
    /// True if nothing was damaged.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let whole = Self {
            tiles: self.tiles,
            steps: self.steps,
            versions: self.versions,
            records: self.records,
            ..Self::default()
        };
        *self == whole
    }
}

/// Temporary file of the new painting until it gets its name; removed if it does not get it.
struct Part(PathBuf);

impl Part {
    fn remove(&self) {
        for suffix in ["", "-wal", "-journal"] {
            // It may not be there.
            std::fs::remove_file(beside(&self.0, suffix)).ok();
        }
    }

    /// Sees that all of it is in the one file that gets the name: closing leaves the journal beside it
    /// where the disk is full.
    fn is_folded(&self) -> Result<(), DocumentError> {
        match std::fs::metadata(beside(&self.0, "-wal")) {
            Ok(journal) if journal.len() > 0 => Err(DocumentError::Full),
            _ => Ok(()),
        }
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        self.remove();
    }
}

/// Recovers the intact part of a damaged painting into a new one. The damaged one is only read. `tell` receives the
/// progress: done, of total.
///
/// # Errors
/// [`DocumentError::Taken`] if something is at `to`, [`DocumentError::Lost`] if the rest does not make a painting,
/// [`DocumentError::InUse`] if a program has the damaged one open, or the system's error. There is nothing at `to`
/// then.
pub fn recover(
    damaged: &Path,
    to: &Path,
    tell: &mut dyn FnMut(u64, u64),
) -> Result<Salvage, DocumentError> {
    if std::fs::metadata(damaged)?.is_dir() {
        return Err(DocumentError::NoPainting);
    }
    // A journal that lies about there would be taken for the new painting's.
    let mut names = ["", "-wal", "-journal"].into_iter();
    if names.any(|suffix| std::fs::symlink_metadata(beside(to, suffix)).is_ok()) {
        return Err(DocumentError::Taken);
    }
    let holder = holder(damaged);
    if holder.is_some() {
        return Err(DocumentError::InUse { holder });
    }
    let format = unknown_format(damaged)?;
    let mut scan = Scan::open(damaged)?;
    let part = Part(part_of(to));
    part.remove();
    let (database, _) = Database::open(&part.0, Access::Paint, None)?;
    let salvage = Salvage {
        format,
        ..write(&mut scan, &database, tell)?
    };
    database.close()?;
    part.is_folded()?;
    settle(&part.0, History::Kept).map_err(|error| match error {
        DocumentError::Damaged(what) => DocumentError::Lost(what),
        error => error,
    })?;
    part.is_folded()?;
    tell(PARTS, PARTS);
    std::fs::rename(&part.0, to)?;
    Ok(salvage)
}

/// Path at which a painting is made before it gets its name; its journal is beside it.
#[must_use]
pub fn part_of(to: &Path) -> PathBuf {
    beside(to, &format!(".part-{}", std::process::id()))
}

/// The format that the file names, if this program does not know it: a newer one, or a damaged number.
fn unknown_format(damaged: &Path) -> Result<Option<i32>, DocumentError> {
    use std::io::Read as _;
    let mut head = [0; 100];
    let read = std::fs::File::open(damaged)?.read_exact(&mut head);
    let number = |at: usize| i32::from_be_bytes([0, 1, 2, 3].map(|byte| head[at + byte]));
    let [version, application] = [60, 68].map(number);
    let unknown = read.is_ok() && application == APPLICATION_ID && version > VERSION;
    Ok(unknown.then_some(version))
}

/// Number of progress reports.
const PARTS: u64 = 1000;

/// Writes what is whole.
fn write(
    scan: &mut Scan<std::fs::File>,
    database: &Database,
    tell: &mut dyn FnMut(u64, u64),
) -> Result<Salvage, DocumentError> {
    let mut tell = |from: u64, done: u64, all: u64| {
        tell(from + done * (PARTS / 2) / all.max(1), PARTS + 1);
    };
    let mut gathered = Gathered::read(scan, database, &mut |done, all| tell(0, done, all))?;
    let Some((mut kept, of_painting)) = gathered.painting.take() else {
        let what = "what the painting is besides its tiles: no state of it is whole";
        return Err(DocumentError::Lost(what.to_owned()));
    };
    let sequencer = gathered.sequencer.take();
    let (mut sequencer, of_sequencer) =
        sequencer.unwrap_or((SequencerSnapshot::default(), Standing::Older));
    let base = match (of_painting, of_sequencer) {
        (Standing::Current, Standing::Current) => Standing::Current,
        _ => Standing::Older,
    };
    let mut salvage = Salvage {
        rows: gathered.torn,
        pages: gathered.pages_lost,
        is_old: base == Standing::Older,
        ..Salvage::default()
    };
    let read = |done: u64, all: u64| tell(PARTS / 2, done, all);
    let mut stock = Stock::read(database, kept.next_page, &mut { read })?;
    database.connection.execute_batch("BEGIN IMMEDIATE")?;
    stock.lay(database, &gathered.dry)?;
    salvage.layers = stock.hollow + stock.cut;
    rest::files(&mut kept, &mut salvage, database)?;
    rest::brushes(&mut kept, &mut stock, &mut salvage, database)?;
    let pictures = Pictures::read(database)?;
    salvage.files.extend(pictures.mend(&mut kept.scene));
    let shelves = (&stock, &pictures);
    tiles_and_steps(&mut gathered, &mut kept, shelves, &mut salvage, database)?;
    let shelves = (&mut stock, &pictures);
    rest::versions(&gathered, &mut kept, shelves, &mut salvage, database)?;
    rest::journal(&gathered, &mut sequencer, base, &mut salvage, database)?;
    kept.next_page = kept.next_page.max(stock.next);
    // Lost rows are not reported as missing again.
    kept.rows = None;
    for (key, state) in [
        ("painting", serde_json::to_string(&kept)?),
        ("sequencer", serde_json::to_string(&sequencer)?),
    ] {
        let values = vec![Value::Text(key.to_owned()), Value::Text(state)];
        Found::of(Table::State, values).write(database)?;
    }
    database.connection.execute_batch("COMMIT")?;
    Ok(salvage)
}

fn tiles_and_steps(
    gathered: &mut Gathered,
    kept: &mut PaintingSnapshot,
    (stock, pictures): (&Stock, &Pictures),
    salvage: &mut Salvage,
    database: &Database,
) -> Result<(), DocumentError> {
    let newest = gathered.steps.keys().last().copied().unwrap_or(0);
    kept.step = kept.step.max(newest.max(0) as u64);
    let steps = Steps::of(gathered, kept, pictures);
    let tiles = tiles::write(gathered, &steps.states(), stock, kept, salvage, database)?;
    let carried = kept.brushes.iter();
    let now = Now {
        loads: carried
            .filter_map(|(name, brush)| Some((name.clone(), stock.load(brush.load)?)))
            .collect(),
        layers: kept.scene.layers.clone(),
        makes: makes(&kept.scene),
        tiles: tiles.clone(),
    };
    let walked = steps.write(now, stock, database)?;
    (salvage.steps, salvage.lost_steps) = (walked.kept, walked.dropped);
    kept.open_steps
        .retain(|open| walked.done.contains(&open.step));
    kept.undone = walked.undone;
    let carried = kept.brushes.values().map(|brush| &brush.load);
    let there = rest::paint(stock, tiles.into_values(), carried);
    rest::rebase(&mut kept.ledger, &there);
    Ok(())
}
