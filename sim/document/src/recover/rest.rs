//! All but tiles and steps: files, loads, books, versions, the journal.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use maulstick_brush::BrushFile;
use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_model::brush::load::BrushLoad;
use maulstick_optics::PaintLibrary;
use maulstick_painting::ledger::Ledger;
use maulstick_painting::snapshot::{PaintingSnapshot, SequencerSnapshot};
use maulstick_types::scene::{NamedVersion, WellKind};
use rusqlite::params;

use super::Salvage;
use super::found::Found;
use super::gathering::{Gathered, Standing};
use super::pictures::Pictures;
use super::stock::{Numbers, Stock};
use crate::database::Database;
use crate::error::DocumentError;
use crate::opening::text;
use crate::rows::{KeptRest, unpacked};
use crate::scan::Value;
use crate::schema::Table;
use crate::{journal, loads};

/// True if a library has all paints of a painting.
fn knows_all(library: &PaintLibrary, kept: &PaintingSnapshot) -> bool {
    let scene = &kept.scene;
    let mut slots = scene.paints.iter();
    let mut wells = scene.surfaces.iter().flat_map(|surface| &surface.wells);
    slots.all(|slot| library.find(&slot.name).is_ok())
        && wells.all(|well| match &well.kind {
            WellKind::Paint { mixture } => library.check(mixture).is_ok(),
            _ => true,
        })
}

/// Puts other files in the place of lost ones: the paints of any other paint file that has them, and
/// the round brush.
///
/// # Errors
/// [`DocumentError::Lost`] where paints are known to no file, or what SQLite says.
pub(super) fn files(
    kept: &mut PaintingSnapshot,
    salvage: &mut Salvage,
    database: &Database,
) -> Result<(), DocumentError> {
    let has_all =
        |text: &String| PaintLibrary::parse(text).is_ok_and(|library| knows_all(&library, kept));
    if text(database, &kept.paints).ok().filter(has_all).is_none() {
        let mut statement = database
            .connection
            .prepare("SELECT hash FROM file WHERE kind = 'paints'")?;
        let hashes = statement.query_map(params![], |row| row.get(0))?;
        let hashes: Vec<String> = hashes.collect::<Result<_, _>>()?;
        let others = hashes.iter().filter_map(|hash| text(database, hash).ok());
        let measured = PaintLibrary::measured()
            .ok()
            .map(|library| library.text().to_owned());
        let Some(paints) = others.chain(measured).find(has_all) else {
            let what = "its paints: no file that is left has them all";
            return Err(DocumentError::Lost(what.to_owned()));
        };
        kept.paints = put_file(database, "paints", "paints.csv", &paints)?;
        salvage.files.push("paints.csv".to_owned());
    }
    for (name, brush) in &mut kept.brushes {
        let file = text(database, &brush.file).ok();
        if file.is_none_or(|file| BrushFile::parse(&file).is_err()) {
            let round = BrushFile::library_text("round")
                .map_err(|error| DocumentError::Other(error.to_string()))?;
            brush.file = put_file(database, "brush", name, round)?;
            brush.path = None;
            salvage.files.push(format!("brush '{name}'"));
        }
    }
    Ok(())
}

fn put_file(
    database: &Database,
    kind: &str,
    name: &str,
    data: &str,
) -> Result<String, DocumentError> {
    let hash = maulstick_canvas::assets::hash_of(data.as_bytes());
    let texts = [hash.as_str(), kind, name].map(|text| Value::Text(text.to_owned()));
    let values = texts
        .into_iter()
        .chain([Value::Blob(data.as_bytes().to_vec())]);
    Found::of(Table::File, values.collect()).write(database)?;
    Ok(hash)
}

/// Writes the load of a clean brush and returns its number.
fn clean_load(stock: &mut Stock, database: &Database) -> Result<i64, DocumentError> {
    let id = stock.number();
    let data = loads::encode(&BrushLoad::clean(0), database.level)?;
    Found::of(Table::Load, vec![Value::Int(id), Value::Blob(data)]).write(database)?;
    stock.note_load(id);
    Ok(id)
}

/// Makes brushes clean whose load is not known.
///
/// # Errors
/// The error of SQLite.
pub(super) fn brushes(
    kept: &mut PaintingSnapshot,
    stock: &mut Stock,
    salvage: &mut Salvage,
    database: &Database,
) -> Result<(), DocumentError> {
    for (name, brush) in &mut kept.brushes {
        if stock.load(brush.load).is_none() {
            brush.load = clean_load(stock, database)? as u64;
            salvage.brushes.push(name.clone());
        }
    }
    Ok(())
}

/// Makes books balance where so much paint is found: what is missing counts as washed out by the
/// cleaner, what is too much as squeezed out of the tubes.
pub(super) fn rebase(ledger: &mut Ledger, found: &Counts) {
    let due = ledger.due();
    let off = |slot: usize| due[slot].saturating_sub_unsigned(found[slot]);
    let lost: Counts = std::array::from_fn(|slot| off(slot).max(0).unsigned_abs());
    let more: Counts = std::array::from_fn(|slot| off(slot).min(0).unsigned_abs());
    ledger.to_cleaner(&lost);
    ledger.from_tube(&more);
}

/// The paint of these tiles and loads.
pub(super) fn paint<'a>(
    stock: &Stock,
    tiles: impl Iterator<Item = Numbers>,
    loads: impl Iterator<Item = &'a u64>,
) -> Counts {
    let mut all = [0; SLOTS];
    let tiles = tiles.filter_map(|numbers| stock.held(numbers));
    let loads = loads.filter_map(|id| stock.load(*id));
    tiles.chain(loads).for_each(|counts| add(&mut all, &counts));
    all
}

/// Writes the versions of which every tile is there, with plain surfaces for lost pictures; what was painted from another one counts as
/// painted from what that was painted from.
///
/// # Errors
/// What SQLite says.
pub(super) fn versions(
    gathered: &Gathered,
    kept: &mut PaintingSnapshot,
    (stock, pictures): (&mut Stock, &Pictures),
    salvage: &mut Salvage,
    database: &Database,
) -> Result<(), DocumentError> {
    let listed = std::mem::take(&mut kept.scene.versions);
    let is_listed = |name: &str| listed.iter().any(|version| version.name == name);
    let mut parents: HashMap<&str, &str> = HashMap::new();
    for version in &listed {
        parents.insert(&version.name, &version.parent);
    }
    let mut whole = BTreeMap::new();
    for (name, (found, standing)) in &gathered.versions {
        // One that was forgotten is not to come back.
        if *standing == Standing::Older && !is_listed(name) {
            continue;
        }
        parents.insert(name, found.text(1));
        if let Some(rest) = version(found, stock, pictures, database)? {
            whole.insert(name.as_str(), (found, rest));
        }
    }
    let names: BTreeSet<&str> = whole.keys().copied().collect();
    let mut gone: BTreeSet<&str> = parents.keys().copied().collect();
    gone.retain(|name| !names.contains(name));
    salvage.lost_versions = gone.into_iter().map(str::to_owned).collect();
    let parent_of = |name: &str| {
        let mut parent = parents.get(name).copied().unwrap_or_default();
        // Damage cannot make a ring of them, but nothing here shall wait for ever.
        for _ in 0..parents.len() {
            if names.contains(parent) {
                return parent.to_owned();
            }
            parent = parents.get(parent).copied().unwrap_or_default();
        }
        String::new()
    };
    if let Some(line) = kept.line.take() {
        let line = match names.contains(line.as_str()) {
            true => line,
            false => parent_of(&line),
        };
        kept.line = (!line.is_empty()).then_some(line);
    }
    for (name, (found, rest)) in whole {
        let parent = parent_of(name);
        let texts = [name, &parent, &rest].map(|text| Value::Text(text.to_owned()));
        let values = texts
            .into_iter()
            .chain([Value::Blob(found.blob(3).to_vec())]);
        Found::of(Table::Version, values.collect()).write(database)?;
        salvage.versions += 1;
        kept.scene.versions.push(NamedVersion {
            name: name.to_owned(),
            parent,
            here: kept.line.as_deref() == Some(name),
        });
    }
    Ok(())
}

/// The rest of a version, with its ledger made to balance; `None` if a tile of it is gone.
fn version(
    found: &Found,
    stock: &mut Stock,
    pictures: &Pictures,
    database: &Database,
) -> Result<Option<String>, DocumentError> {
    let tiles = unpacked::<3>(found.blob(3));
    let rest = serde_json::from_str::<KeptRest>(found.text(2));
    let (Some(tiles), Ok(mut rest)) = (tiles, rest) else {
        return Ok(None);
    };
    let mut numbers = tiles.iter().map(|[_, page, dry]| [*page, *dry]);
    if numbers.any(|numbers| stock.held(numbers).is_none()) {
        return Ok(None);
    }
    let mut changed = pictures.mend_makes(&mut rest.makes);
    for id in rest.loads.values_mut() {
        if stock.load(*id).is_none() {
            *id = clean_load(stock, database)? as u64;
            changed = true;
        }
    }
    let numbers = tiles.iter().map(|[_, page, dry]| [*page, *dry]);
    let before = rest.ledger.clone();
    let there = paint(stock, numbers, rest.loads.values());
    rebase(&mut rest.ledger, &there);
    Ok(Some(match changed || rest.ledger != before {
        true => serde_json::to_string(&rest)?,
        false => found.text(2).to_owned(),
    }))
}

/// Writes the journal as far as it follows, without a gap, what `sequencer` has. Where the state is
/// an older one, `base`, none of it does: the tiles may hold already what it says.
///
/// # Errors
/// What SQLite says.
pub(super) fn journal(
    gathered: &Gathered,
    sequencer: &mut SequencerSnapshot,
    base: Standing,
    salvage: &mut Salvage,
    database: &Database,
) -> Result<(), DocumentError> {
    let from = sequencer.serial;
    let mut next = from;
    let mut is_broken = base == Standing::Older;
    for (first, found) in &gathered.journal {
        let (first, last) = (*first as u64, found.int(1) as u64);
        if last < from {
            continue;
        }
        let records = journal::read(first, found.blob(2)).unwrap_or_default();
        let is_whole = records.last().is_some_and(|record| record.serial == last);
        let follows = first == next || (first < next && next == from);
        is_broken |= !(is_whole && follows);
        if base == Standing::Older {
            // What comes is not to have the number of what was.
            sequencer.serial = sequencer.serial.max(last.saturating_add(1));
            let index = records.last().map_or(0, |record| record.next());
            sequencer.next = sequencer.next.max(index);
        }
        let count = last.saturating_sub(first.max(next)).saturating_add(1);
        match is_broken {
            true => salvage.lost_records += count,
            false => {
                found.write(database)?;
                salvage.records += count;
                next = last + 1;
            }
        }
    }
    Ok(())
}
