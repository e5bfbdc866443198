//! Files and loads of a painting: lost ones are replaced by others.

use maulstick_brush::BrushFile;
use maulstick_canvas::assets::hash_of;
use maulstick_document::DocumentError;
use maulstick_document::file::database::Database;
use maulstick_document::opening::text;
use maulstick_document::tables::loads;
use maulstick_document::tables::schema::Table;
use maulstick_model::brush::load::BrushLoad;
use maulstick_optics::PaintLibrary;
use maulstick_painting::snapshot::PaintingSnapshot;
use maulstick_types::scene::WellKind;
use rusqlite::params;

use super::error::SalvageError;
use super::inventory::Inventory;
use super::painting_row::PaintingRow;
use super::report::SalvageReport;
use crate::sqlite::Value;

/// True if a library has all paints of a painting.
fn knows_all(library: &PaintLibrary, snapshot: &PaintingSnapshot) -> bool {
    let scene = &snapshot.scene;
    let mut slots = scene.paints.iter();
    let mut wells = scene.surfaces.iter().flat_map(|surface| &surface.wells);
    slots.all(|slot| library.find(&slot.name).is_ok())
        && wells.all(|well| match &well.kind {
            WellKind::Paint { mixture } => library.check(mixture).is_ok(),
            _ => true,
        })
}

/// Replaces lost files: the paints by any other paint file that has them all, a brush by the round one.
///
/// # Errors
/// [`SalvageError::Lost`] if no file has all paints, or the error of SQLite.
pub(super) fn replace_lost(
    snapshot: &mut PaintingSnapshot,
    report: &mut SalvageReport,
    database: &Database,
) -> Result<(), SalvageError> {
    let has_all = |text: &String| {
        PaintLibrary::parse(text).is_ok_and(|library| knows_all(&library, snapshot))
    };
    let paints = text(database, &snapshot.paints).ok();
    if paints.filter(has_all).is_none() {
        let mut statement = database
            .connection()
            .prepare("SELECT hash FROM file WHERE kind = 'paints'")?;
        let hashes = statement.query_map(params![], |row| row.get(0))?;
        let hashes: Vec<String> = hashes.collect::<Result<_, _>>()?;
        let others = hashes.iter().filter_map(|hash| text(database, hash).ok());
        let measured = PaintLibrary::measured()
            .ok()
            .map(|library| library.text().to_owned());
        let Some(paints) = others.chain(measured).find(has_all) else {
            let what = "its paints: no file that is left has them all";
            return Err(SalvageError::Lost(what.to_owned()));
        };
        snapshot.paints = write_file(database, "paints", "paints.csv", &paints)?;
        report.files.push("paints.csv".to_owned());
    }
    for (name, brush) in &mut snapshot.brushes {
        let file = text(database, &brush.file).ok();
        if file.is_none_or(|file| BrushFile::parse(&file).is_err()) {
            let round = BrushFile::library_text("round")
                .map_err(|error| DocumentError::Other(error.to_string()))?;
            brush.file = write_file(database, "brush", name, round)?;
            brush.path = None;
            report.files.push(format!("brush '{name}'"));
        }
    }
    Ok(())
}

fn write_file(
    database: &Database,
    kind: &str,
    name: &str,
    data: &str,
) -> Result<String, DocumentError> {
    let hash = hash_of(data.as_bytes());
    let texts = [hash.as_str(), kind, name].map(|text| Value::Text(text.to_owned()));
    let values = texts
        .into_iter()
        .chain([Value::Blob(data.as_bytes().to_vec())]);
    PaintingRow::new(Table::File, values.collect()).write(database)?;
    Ok(hash)
}

/// Writes the load of a clean brush and returns its number.
///
/// # Errors
/// The error of SQLite.
pub(super) fn write_clean_load(
    inventory: &mut Inventory,
    database: &Database,
) -> Result<i64, DocumentError> {
    let id = inventory.new_number();
    let data = loads::encode(&BrushLoad::clean(0), database.level())?;
    PaintingRow::new(Table::Load, vec![Value::Int(id), Value::Blob(data)]).write(database)?;
    inventory.add_empty_load(id);
    Ok(id)
}

/// Cleans the brushes whose load is lost.
///
/// # Errors
/// The error of SQLite.
pub(super) fn clean_brushes(
    snapshot: &mut PaintingSnapshot,
    inventory: &mut Inventory,
    report: &mut SalvageReport,
    database: &Database,
) -> Result<(), DocumentError> {
    for (name, brush) in &mut snapshot.brushes {
        if inventory.load(brush.load).is_none() {
            brush.load = write_clean_load(inventory, database)? as u64;
            report.brushes.push(name.clone());
        }
    }
    Ok(())
}
