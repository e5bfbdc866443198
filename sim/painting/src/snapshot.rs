//! Snapshots: a painting and its sequencer in the form of a document, without tiles, history and versions.

use std::collections::BTreeMap;

use maulstick_model::brush::head::WaypointSnapshot;
use maulstick_model::brush::scale::Scale;
use maulstick_types::command::reply_cache::ReplyCache;
use maulstick_types::scene::Scene;
use maulstick_types::{Mixture, Origin};
use serde::{Deserialize, Serialize};

use crate::clock::Clock;
use crate::ledger::Ledger;

/// Saved state of a brush.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BrushSnapshot {
    /// Its file, TOML; in the document the file's hash.
    pub file: String,
    /// Page of its load.
    pub load: u64,
    /// Epoch of the brush and number of the newest stroke.
    pub stroke: Option<(u32, u64)>,
    /// Its path while it paints: surface, place of its last step, and later position.
    pub path: Option<(u32, Scale, WaypointSnapshot, Option<WaypointSnapshot>)>,
    /// See `path`: the step before the last.
    #[serde(default)]
    pub before: Option<WaypointSnapshot>,
    /// Loads that its strokes take in turn, and the number of strokes since its take began.
    pub loads: Vec<Mixture>,
    /// Number of strokes; see `loads`.
    pub strokes: usize,
    /// Seed of the disorder of its bristles.
    pub seed: u64,
    /// Length of its newest stroke, and that at the last regrouping of its bristles, m.
    #[serde(default)]
    pub way_m: [f64; 2],
}

/// A step that is not finished.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OpenStepSnapshot {
    /// Its number.
    pub step: u64,
    /// The tiles that it may have changed: surface, column, row.
    pub reached: Vec<[u32; 3]>,
    /// Most quanta that a cell of a surface ever had, before it.
    pub tops: BTreeMap<u32, f32>,
}

/// A painting besides its tiles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PaintingSnapshot {
    /// The desk.
    pub scene: Scene,
    /// The paints, as a file; in the document the file's hash.
    pub paints: String,
    /// Most quanta that a cell of a surface ever had.
    pub tops: BTreeMap<u32, f32>,
    /// The brushes, by name.
    pub brushes: BTreeMap<String, BrushSnapshot>,
    /// The books.
    pub ledger: Ledger,
    /// Number of the newest tile version.
    pub versions: u64,
    /// Number of the next page.
    pub next_page: u64,
    /// Number of the newest step.
    pub step: u64,
    /// The steps that are not finished.
    pub open_steps: Vec<OpenStepSnapshot>,
    /// Steps that were undone, the last one at the end.
    pub undone: Vec<u64>,
    /// True if any step has changed more than brush loads.
    #[serde(default)]
    pub has_changed_surfaces: bool,
    /// The version on which the painter continues.
    pub line: Option<String>,
    /// Work that was done.
    #[serde(flatten)]
    pub work: WorkSnapshot,
    /// Limits of what is kept of the past.
    #[serde(flatten)]
    pub quotas: QuotaSnapshot,
    /// Time elapsed, and dryings in progress.
    pub clock: Clock,
    /// Rows that the document has of it; `None` in paintings from before rows were counted.
    pub rows: Option<RowCounts>,
}

/// Work that was done on a painting.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorkSnapshot {
    /// Strokes of all brushes; 0 at first in paintings from before they were counted.
    #[serde(default)]
    pub strokes: u64,
    /// Steps of the paint model.
    pub steps: u64,
    /// Cells of its footprints.
    pub footprint_cells: u64,
    /// Time of the first and of the last state, ns.
    pub span_ns: Option<(u64, u64)>,
}

/// Limits of what is kept of a painting's past.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct QuotaSnapshot {
    /// Most bytes of the history.
    pub quota: u64,
    /// Most bytes of the record; 0 keeps none.
    #[serde(default = "default_record_quota")]
    pub record_quota: u64,
}

/// Bytes of a record at most, unless a painting says otherwise.
pub(crate) const RECORD_QUOTA: u64 = 512 << 20;

fn default_record_quota() -> u64 {
    RECORD_QUOTA
}

/// Numbers of rows that a document has of the painter's work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RowCounts {
    /// Tiles that were ever painted on.
    pub tiles: u64,
    /// Steps of the history, those that are not finished among them.
    pub steps: u64,
    /// Named versions.
    pub versions: u64,
}

/// A take that may paint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TakeSnapshot {
    /// Its player.
    pub device: u32,
    /// Epoch of its playing.
    pub epoch: u32,
    /// True once its last state has arrived.
    pub ended: bool,
    /// The newest step when it began.
    pub step: u64,
    /// Strokes of the painting when it began.
    #[serde(default)]
    pub strokes: u64,
}

/// States of a brush that an undo dropped before they were painted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CutStates {
    /// The brush, by the hash of its name.
    pub source: u32,
    /// Its epoch.
    pub epoch: u32,
    /// First state.
    pub from: u64,
    /// Last state.
    pub to: u64,
}

impl CutStates {
    /// True if a state of this number is one of them.
    #[must_use]
    pub fn has(&self, brush: Origin, sequence: u64) -> bool {
        (self.source, self.epoch) == (brush.source, brush.epoch)
            && (self.from..=self.to).contains(&sequence)
    }
}

/// The sequencer at a place of its journal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SequencerSnapshot {
    /// Index of the next journal entry.
    pub next: u64,
    /// Number of accepted records.
    pub serial: u64,
    /// Takes that may paint, by brush.
    pub takes: BTreeMap<String, TakeSnapshot>,
    /// Players that are gone.
    pub gone: Vec<u32>,
    /// States that an undo dropped and that are still to come.
    pub cut: Vec<CutStates>,
    /// Consumed states of brushes: source, epoch, next.
    pub consumed: Vec<(u32, u32, u64)>,
    /// The newest reply to each client.
    pub replies: ReplyCache,
    /// True in a file that a player has prepared for its session: only the player may paint in it.
    #[serde(default)]
    pub held: bool,
}
