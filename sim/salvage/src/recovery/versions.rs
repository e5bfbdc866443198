//! Named versions of which every tile is intact.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use maulstick_document::DocumentError;
use maulstick_document::file::database::Database;
use maulstick_document::rows::{StoredNonTileState, unpacked};
use maulstick_document::tables::schema::Table;
use maulstick_painting::snapshot::PaintingSnapshot;
use maulstick_types::scene::NamedVersion;

use super::files::write_clean_load;
use super::intact_rows::{IntactRows, RowAge};
use super::inventory::Inventory;
use super::ledger;
use super::materials::MaterialSources;
use super::painting_row::PaintingRow;
use super::report::SalvageReport;
use crate::sqlite::Value;

/// Writes the intact versions, with default materials in the place of lost ones. A version whose parent is lost gets the
/// nearest intact ancestor as its parent.
///
/// # Errors
/// The error of SQLite.
pub(super) fn write(
    rows: &IntactRows,
    snapshot: &mut PaintingSnapshot,
    (inventory, sources): (&mut Inventory, &MaterialSources),
    report: &mut SalvageReport,
    database: &Database,
) -> Result<(), DocumentError> {
    let listed = std::mem::take(&mut snapshot.scene.versions);
    let is_listed = |name: &str| listed.iter().any(|version| version.name == name);
    let mut parents: HashMap<&str, &str> = HashMap::new();
    for version in &listed {
        parents.insert(&version.name, &version.parent);
    }
    let mut intact = BTreeMap::new();
    for (name, (row, age)) in &rows.versions {
        // A version that was forgotten must not come back.
        if *age == RowAge::Older && !is_listed(name) {
            continue;
        }
        parents.insert(name, row.text(1));
        if let Some(state) = state(row, inventory, sources, database)? {
            intact.insert(name.as_str(), (row, state));
        }
    }
    let names: BTreeSet<&str> = intact.keys().copied().collect();
    let mut lost: BTreeSet<&str> = parents.keys().copied().collect();
    lost.retain(|name| !names.contains(name));
    report.lost_versions = lost.into_iter().map(str::to_owned).collect();
    let parent_of = |name: &str| {
        let mut parent = parents.get(name).copied().unwrap_or_default();
        // Limited, so that a ring of parents in a damaged file ends as well.
        for _ in 0..parents.len() {
            if names.contains(parent) {
                return parent.to_owned();
            }
            parent = parents.get(parent).copied().unwrap_or_default();
        }
        String::new()
    };
    if let Some(line) = snapshot.line.take() {
        let is_there = names.contains(line.as_str());
        let line = if is_there { line } else { parent_of(&line) };
        snapshot.line = (!line.is_empty()).then_some(line);
    }
    for (name, (row, state)) in intact {
        let parent = parent_of(name);
        let texts = [name, &parent, &state].map(|text| Value::Text(text.to_owned()));
        let values = texts.into_iter().chain([Value::Blob(row.blob(3).to_vec())]);
        PaintingRow::new(Table::Version, values.collect()).write(database)?;
        report.versions += 1;
        snapshot.scene.versions.push(NamedVersion {
            name: name.to_owned(),
            parent,
            here: snapshot.line.as_deref() == Some(name),
        });
    }
    Ok(())
}

/// State of a version besides its tiles as JSON, with a balanced ledger; `None` if a tile of it is lost.
fn state(
    row: &PaintingRow,
    inventory: &mut Inventory,
    sources: &MaterialSources,
    database: &Database,
) -> Result<Option<String>, DocumentError> {
    let tiles = unpacked::<3>(row.blob(3));
    let state = serde_json::from_str::<StoredNonTileState>(row.text(2));
    let (Some(tiles), Ok(mut state)) = (tiles, state) else {
        return Ok(None);
    };
    let mut ids = tiles.iter().map(|[_, page, dry]| [*page, *dry]);
    if ids.any(|ids| inventory.tile(ids).is_none()) {
        return Ok(None);
    }
    let mut changed = sources.replace_lost_in_version(&mut state.materials);
    for id in state.loads.values_mut() {
        if inventory.load(*id).is_none() {
            *id = write_clean_load(inventory, database)? as u64;
            changed = true;
        }
    }
    let ids = tiles.iter().map(|[_, page, dry]| [*page, *dry]);
    let before = state.ledger.clone();
    let there = ledger::paint(inventory, ids, state.loads.values());
    ledger::balance(&mut state.ledger, &there);
    Ok(Some(if changed || state.ledger != before {
        serde_json::to_string(&state)?
    } else {
        row.text(2).to_owned()
    }))
}
