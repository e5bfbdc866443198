//! `maulstick painting info`: contents of a painting.

use std::path::PathBuf;

use clap::Args;
use maulstick_document::{Document, DocumentError, DocumentStats, Opened, RecordStats};
use maulstick_painting::Painting;
use maulstick_painting::ledger::LedgerReport;
use maulstick_rig::UserError;
use maulstick_rig::size::show_bytes;
use maulstick_session::{LoggedWhat, painting_log};
use maulstick_types::scene::{Layer, Surface};
use serde_json::{Value, json};

use maulstick_painting_setup::document::{read, wrong};
use maulstick_painting_setup::refused;

use super::wall_time::{utc, utc_seconds};
use crate::commands::{print_json, progress, progress_bar, say};

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

/// Shows the contents of a painting.
///
/// # Errors
/// A [`UserError`] where it cannot be read, or is damaged.
pub(super) fn run(options: &InfoOptions) -> Result<i32, UserError> {
    let path = &options.file;
    let mut stats = DocumentStats::read(path).map_err(|error| wrong(path, &error))?;
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
    let record = stats.record.take();
    let record = record.map(|stats| RecordInfo::read(stats, &document, &opened));
    let mut sequencer = opened.sequencer().map_err(refused)?;
    let journal = sequencer.journal_next();
    let ledger = sequencer.painting_mut().report();
    if let Some(what) = document.pager().fault() {
        return Err(wrong(path, &DocumentError::Damaged(what.to_owned())));
    }
    let info = Info {
        stats,
        record,
        pending,
        journal,
        ledger,
        painting: sequencer.painting(),
    };
    if options.json {
        print_json(&info.as_json(options))?;
    } else {
        info.show(options)?;
    }
    Ok(0)
}

/// Contents of a painting.
struct Info<'a> {
    stats: DocumentStats,
    record: Option<RecordInfo>,
    /// Records of the journal that were done again.
    pending: usize,
    journal: u64,
    ledger: LedgerReport,
    painting: &'a Painting,
}

impl Info<'_> {
    fn versions(&self) -> Vec<&str> {
        let named = self.painting.named();
        named.map(|version| version.name.as_str()).collect()
    }

    fn as_json(&self, options: &InfoOptions) -> Value {
        let scene = self.painting.scene();
        let canvas = &scene.surfaces[0];
        let layer = |layer: &Layer| json!({"number": layer.number, "name": layer.name, "opacity": layer.opacity});
        let (undo, redo) = self.painting.history_depth();
        let record = self.record.as_ref();
        json!({
            "file": options.file.display().to_string(),
            "format": self.stats.format,
            "bytes": self.stats.bytes,
            "cells": canvas.cells,
            "size_cm": size_cm(canvas),
            "cells_per_mm": 1e-3 / canvas.cell_m,
            "ground": canvas.ground,
            "tooth": canvas.tooth,
            "model": canvas.model,
            "paints": scene.paints.iter().map(|slot| &slot.name).collect::<Vec<_>>(),
            "layers": scene.layers.iter().map(layer).collect::<Vec<_>>(),
            "undo": undo,
            "redo": redo,
            "merged": self.painting.history().merged(),
            "versions": self.versions(),
            "journal": self.journal,
            "pending": self.pending,
            "record": record.map(|record| record.as_json(self.painting.record_quota())),
            "tables": self.stats.tables,
            "checked": options.check,
            "ledger": self.ledger,
        })
    }

    fn show(&self, options: &InfoOptions) -> Result<(), UserError> {
        let scene = self.painting.scene();
        let canvas = &scene.surfaces[0];
        let ([width, height], [across, up]) = (size_cm(canvas), canvas.cells);
        let per_mm = 1e-3 / canvas.cell_m;
        say!("size      {width:.1} × {height:.1} cm, {across} × {up} cells, {per_mm} a mm");
        let [ground, tooth] = [&canvas.ground, &canvas.tooth].map(|name| short(name));
        say!("ground    {ground}, {tooth} tooth");
        say!("model     {}", canvas.model);
        let paints: Vec<_> = scene.paints.iter().map(|slot| slot.name.as_str()).collect();
        say!("paints    {}", list(&paints, "none yet"));
        for Layer {
            number,
            name,
            opacity,
        } in &scene.layers
        {
            say!("layer     {number} {name}, opacity {opacity}");
        }
        let merged = match self.painting.history().merged() {
            0 | 1 => String::new(),
            merged => format!(", the {merged} oldest merged into one"),
        };
        let (undo, redo) = self.painting.history_depth();
        say!("history   {undo} steps to undo, {redo} to redo{merged}");
        say!("versions  {}", list(&self.versions(), "none"));
        match &self.record {
            Some(record) => say!("record    {}", record.words()),
            None => say!("record    none: no time lapse can be made of it"),
        }
        let DocumentStats {
            bytes,
            format,
            tables,
            ..
        } = &self.stats;
        say!("file      {}, format {format}", show_bytes(*bytes));
        for (table, bytes) in tables {
            say!("          {table:<8} {}", show_bytes(*bytes));
        }
        let pending = self.pending;
        if pending > 0 {
            say!(
                "          it was not closed: {pending} things were done again after its last moment"
            );
        }
        if options.check {
            say!("          every tile is whole");
        }
        Ok(())
    }
}

/// Width and height of a surface, cm.
fn size_cm(surface: &Surface) -> [f64; 2] {
    (surface.cells).map(|cells| f64::from(cells) * surface.cell_m * 100.0)
}

/// Names in a row, or the word where there are none.
fn list(names: &[&str], none: &str) -> String {
    if names.is_empty() {
        return none.to_owned();
    }
    names.join(", ")
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
