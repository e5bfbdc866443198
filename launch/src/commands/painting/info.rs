//! `maulstick painting info`: contents of a painting.

use std::path::PathBuf;

use clap::Args;
use maulstick_document::{Document, DocumentError, DocumentStats, Opened, RecordStats};
use maulstick_rig::UserError;
use maulstick_rig::size::show_bytes;
use maulstick_session::{LoggedWhat, painting_log};
use serde_json::{Value, json};

use super::wall_time::{utc, utc_seconds};
use crate::commands::{print_json, progress, progress_bar, say};
use crate::document::{read, wrong};
use crate::performance::refused;

/// Options of `maulstick painting info`.
#[derive(Args, Clone, Debug)]
pub struct InfoOptions {
    /// Painting
    file: PathBuf,
    /// Read every tile of the painting and its history, to check that all are intact
    #[arg(long)]
    check: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Shows what a painting holds.
///
/// # Errors
/// A [`UserError`] where it cannot be read, or is damaged.
pub(super) fn run(options: &InfoOptions) -> Result<i32, UserError> {
    let path = &options.file;
    let stats = DocumentStats::read(path).map_err(|error| wrong(path, &error))?;
    if options.check {
        let bar = progress_bar(0).with_message("reading");
        let checked = stats.check(path, &mut progress(&bar));
        bar.finish_and_clear();
        checked.map_err(|error| wrong(path, &error))?;
    }
    let (document, opened) = read(path)?;
    if options.check {
        opened.check().map_err(|error| wrong(path, &error))?;
    }
    let pending = opened.pending();
    let record = stats
        .record
        .map(|stats| RecordInfo::read(stats, &document, &opened));
    let mut sequencer = opened.sequencer().map_err(refused)?;
    let journal = sequencer.journal_next();
    let painting = sequencer.painting_mut();
    let ledger = painting.report();
    if let Some(what) = document.pager().fault() {
        return Err(wrong(path, &DocumentError::Damaged(what.to_owned())));
    }
    let scene = painting.scene();
    let canvas = &scene.surfaces[0];
    let size_cm = canvas
        .cells
        .map(|cells| f64::from(cells) * canvas.cell_m * 100.0);
    let [ground, tooth] = [&canvas.ground, &canvas.tooth].map(|name| short(name));
    let per_mm = 1e-3 / canvas.cell_m;
    let (undo, redo) = painting.history_depth();
    let names: Vec<&str> = scene.paints.iter().map(|slot| slot.name.as_str()).collect();
    let versions: Vec<_> = painting
        .named()
        .map(|version| version.name.as_str())
        .collect();
    if options.json {
        let layers: Vec<_> = scene
            .layers
            .iter()
            .map(|layer| json!({"number": layer.number, "name": layer.name, "opacity": layer.opacity}))
            .collect();
        print_json(&json!({
            "file": path.display().to_string(),
            "format": stats.format,
            "bytes": stats.bytes,
            "cells": canvas.cells,
            "size_cm": size_cm,
            "cells_per_mm": per_mm,
            "ground": canvas.ground,
            "tooth": canvas.tooth,
            "model": canvas.model,
            "paints": names,
            "layers": layers,
            "undo": undo,
            "redo": redo,
            "merged": painting.history().merged(),
            "versions": versions,
            "journal": journal,
            "pending": pending,
            "record": record.as_ref().map(|record| record.as_json(painting.record_quota())),
            "tables": stats.tables,
            "checked": options.check,
            "ledger": ledger,
        }))?;
        return Ok(0);
    }
    say!(
        "size      {:.1} × {:.1} cm, {} × {} cells, {per_mm} a mm",
        size_cm[0],
        size_cm[1],
        canvas.cells[0],
        canvas.cells[1]
    );
    say!("ground    {ground}, {tooth} tooth");
    say!("model     {}", canvas.model);
    say!(
        "paints    {}",
        if names.is_empty() {
            "none yet".to_owned()
        } else {
            names.join(", ")
        }
    );
    for layer in &scene.layers {
        say!(
            "layer     {} {}, opacity {}",
            layer.number,
            layer.name,
            layer.opacity
        );
    }
    let merged = match painting.history().merged() {
        0 | 1 => String::new(),
        merged => format!(", the oldest of them {merged} in one"),
    };
    say!("history   {undo} steps to undo, {redo} to redo{merged}");
    say!(
        "versions  {}",
        if versions.is_empty() {
            "none".to_owned()
        } else {
            versions.join(", ")
        }
    );
    match &record {
        Some(record) => say!("record    {}", record.words()),
        None => say!("record    none: no time lapse can be made of it"),
    }
    say!(
        "file      {}, format {}",
        show_bytes(stats.bytes),
        stats.format
    );
    for (table, bytes) in &stats.tables {
        say!("          {table:<8} {}", show_bytes(*bytes));
    }
    if pending > 0 {
        say!("          it was not closed: {pending} things were done again after its last moment");
    }
    if options.check {
        say!("          every tile is whole");
    }
    Ok(0)
}

/// The record of a painting, and how much was done in it.
struct RecordInfo {
    stats: RecordStats,
    /// Strokes and commands; `None` if it is damaged, or of another version of the program.
    counts: Option<[usize; 2]>,
}

impl RecordInfo {
    fn read(stats: RecordStats, document: &Document, opened: &Opened) -> Self {
        let log = opened.beginning().map(|_| painting_log(document, opened));
        let counts = log.and_then(Result::ok).map(|log| {
            let count = |which: fn(&LoggedWhat) -> bool| {
                let lines = log.iter().filter(|line| which(&line.what));
                lines.count()
            };
            [
                count(|what| matches!(what, LoggedWhat::Stroke(_))),
                count(|what| matches!(what, LoggedWhat::Command { .. })),
            ]
        });
        Self { stats, counts }
    }

    fn as_json(&self, quota: u64) -> Value {
        json!({
            "bytes": self.stats.bytes,
            "quota": quota,
            "begun": utc(self.stats.begun_ms),
            "newest": utc(self.stats.newest_ms),
            "strokes": self.counts.map(|[strokes, _]| strokes),
            "commands": self.counts.map(|[_, commands]| commands),
        })
    }

    fn words(&self) -> String {
        let counts = match self.counts {
            Some([strokes, commands]) => format!("{strokes} strokes, {commands} commands"),
            None => "damaged, or of another version of Maulstick".to_owned(),
        };
        let RecordStats {
            bytes,
            begun_ms,
            newest_ms,
        } = self.stats;
        let [from, to] = [begun_ms, newest_ms].map(utc_seconds);
        format!("{counts}, {}, from {from} to {to}", show_bytes(bytes))
    }
}

/// The name of a ground or tooth; of a picture the first digits of its hash.
fn short(name: &str) -> String {
    if let Some(hash) = name.strip_prefix("spectrum:") {
        return format!("spectrum {}", hash.chars().take(8).collect::<String>());
    }
    let Some(picture) = name.strip_prefix("image:") else {
        return name.to_owned();
    };
    let (hash, size) = picture.split_once('@').unwrap_or((picture, ""));
    let size = size.replace(',', ", ");
    let digits: String = hash.chars().take(8).collect();
    format!("picture {digits} {size}").trim_end().to_owned()
}
