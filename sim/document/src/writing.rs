//! Writing of a checkpoint, as one transaction.

mod deletion;

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Instant;

use maulstick_canvas::assets::{hash_of, kind_of};
use maulstick_canvas::page::Page;
use maulstick_canvas::planes::Planes;
use maulstick_model::brush::load::BrushLoad;
use maulstick_painting::Named;
use maulstick_painting::history::{Step, TileRef};
use maulstick_painting::snapshot::PaintingSnapshot;
use rusqlite::{OptionalExtension as _, params};

use crate::checkpoint::Checkpoint;
use crate::error::DocumentError;
use crate::file::database::{DEPTH_MAX, Database};
use crate::tables::checksum::{Checksum, load_checksum, page_checksum, shown_checksum};
use crate::tables::rows::{
    COPY, StoredNonTileState, StoredStepEffects, packed_changes, packed_tiles, page_ids,
    place_number,
};
use crate::tables::schema::Table;
use crate::tables::{loads, planes};

/// Displayed tile.
#[derive(Clone, Debug)]
pub struct ShownTile {
    /// Its place, [`crate::tables::rows::shown_number`].
    pub place: i64,
    /// Tile version that is displayed.
    pub version: u64,
    /// Hash of the look under which it is displayed.
    pub look: i64,
    /// Its planes.
    pub bytes: Vec<u8>,
}

/// Removes the rows that a whole checkpoint writes again, except pages, layers and loads: unreferenced ones are removed
/// on opening.
const CLEARED: &str = "DELETE FROM tile; DELETE FROM step; DELETE FROM version; \
     DELETE FROM journal; DELETE FROM record; DELETE FROM beginning; DELETE FROM shown";

/// Callback between two pages, which serves readers that wait for one.
pub(crate) type YieldHook<'a> = &'a mut dyn FnMut(&Database);

/// Written pages, to be marked as stored after the commit.
#[derive(Debug, Default)]
pub(crate) struct Stored {
    planes: Vec<(Page<Planes>, usize)>,
    loads: Vec<(Page<BrushLoad>, usize)>,
    stacks: Vec<Arc<maulstick_canvas::dry::DryStack>>,
}

impl Stored {
    /// Marks the pages as stored.
    pub(crate) fn mark(self) {
        self.planes
            .iter()
            .for_each(|(page, bytes)| page.note_stored(*bytes));
        self.loads
            .iter()
            .for_each(|(page, bytes)| page.note_stored(*bytes));
        self.stacks.iter().for_each(|stack| stack.note_stored());
    }
}

/// Rows that a writer assumes to be in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Trust {
    /// Those marked as stored.
    #[default]
    Stored,
    /// Only those found there, because the file is another one than before.
    Nothing,
}

/// Number, depth and planes of the base of a difference.
type Base = (i64, i64, Arc<Planes>);

/// Writer of rows inside one transaction.
pub(crate) struct Writer<'a, 'b> {
    pub(crate) database: &'a Database,
    yield_hook: YieldHook<'b>,
    stored: Stored,
    written: BTreeSet<u64>,
    trust: Trust,
}

impl<'a, 'b> Writer<'a, 'b> {
    pub(crate) fn new(database: &'a Database, yield_hook: YieldHook<'b>) -> Self {
        Self {
            database,
            yield_hook,
            stored: Stored::default(),
            written: Default::default(),
            trust: Trust::default(),
        }
    }

    /// This writer with the assumption `trust`.
    pub(crate) fn trusting(self, trust: Trust) -> Self {
        Self { trust, ..self }
    }

    /// Pages that it wrote.
    pub(crate) fn stored(self) -> Stored {
        self.stored
    }

    /// True if a row marked as stored is in the file.
    fn has(&self, table: Table, id: u64, is_stored: bool) -> Result<bool, DocumentError> {
        if self.trust == Trust::Stored || !is_stored {
            return Ok(is_stored);
        }
        let query = format!("SELECT 1 FROM {} WHERE id = ?1", table.name());
        let mut statement = self.database.connection.prepare_cached(&query)?;
        Ok(statement.exists(params![id as i64])?)
    }

    /// Writes a checkpoint and deletes the rows that it replaces. If its pages are not written by `until`, only some of
    /// them are written, still unreferenced, and false is returned.
    pub(crate) fn checkpoint(
        &mut self,
        checkpoint: &Checkpoint,
        until: Instant,
    ) -> Result<bool, DocumentError> {
        if self.trust == Trust::Nothing {
            self.database.connection.execute_batch(CLEARED)?;
        }
        let painting = &checkpoint.painting;
        let tiles = painting.tiles.iter().map(|(_, version)| &version.tile);
        let changes = painting.steps.iter().flat_map(|step| step.tiles.values());
        let steps = changes.flat_map(|change| [&change.before, &change.after]);
        let named = painting.named.iter().flat_map(|named| named.tiles.values());
        for tile in tiles.chain(steps).chain(named) {
            self.write_tile(tile)?;
            if !self.written.is_empty() && Instant::now() > until {
                return Ok(false);
            }
        }
        for step in &painting.steps {
            self.write_step(step)?;
        }
        for version in &painting.named {
            self.write_version(version)?;
        }
        for page in painting.loads.values() {
            self.write_load(page)?;
        }
        let connection = &self.database.connection;
        for (place, version) in &painting.tiles {
            let place = place_number(*place);
            let [page, dry] = page_ids(&version.tile);
            let ints = [place, version.number as i64, page, dry];
            let sum = Checksum::of_ints(Table::Tile, &ints);
            connection
                .prepare_cached("INSERT OR REPLACE INTO tile VALUES(6, ?1, ?2, ?3, ?4, ?5)")?
                .execute(params![ints[0], ints[1], ints[2], ints[3], sum])?;
        }
        for step in &painting.gone_steps {
            connection
                .prepare_cached("DELETE FROM step WHERE id = ?1")?
                .execute(params![*step as i64])?;
        }
        for name in &painting.gone_named {
            connection.execute("DELETE FROM version WHERE name = ?1", params![name])?;
        }
        self.write_state(checkpoint)?;
        self.delete_unreferenced(&painting.dead)?;
        Ok(true)
    }

    pub(crate) fn write_tile(&mut self, tile: &TileRef) -> Result<(), DocumentError> {
        let Some(tile) = tile else {
            return Ok(());
        };
        if let Some(page) = tile.wet_page() {
            self.write_page(page)?;
        }
        let mut next = tile.dry();
        while let Some(stack) = next {
            // Those below were written with it, or before.
            if self.written.contains(&stack.id())
                || self.has(Table::Dry, stack.id(), stack.is_stored())?
            {
                break;
            }
            next = stack.below();
            self.written.insert(stack.id());
            self.write_page(&stack.layer().planes)?;
            let below = stack.below().map_or(0, |below| below.id());
            let ints = [
                stack.id(),
                below,
                u64::from(stack.layer().number),
                stack.layer().planes.id(),
            ]
            .map(|number| number as i64);
            let sum = Checksum::of_ints(Table::Dry, &ints);
            self.database
                .connection
                .prepare_cached("INSERT OR REPLACE INTO dry VALUES(4, ?1, ?2, ?3, ?4, ?5)")?
                .execute(params![ints[0], ints[1], ints[2], ints[3], sum])?;
            self.stored.stacks.push(Arc::clone(stack));
        }
        Ok(())
    }

    fn write_page(&mut self, page: &Page<Planes>) -> Result<(), DocumentError> {
        if self.has(Table::Page, page.id(), page.stored_bytes() > 0)?
            || !self.written.insert(page.id())
        {
            return Ok(());
        }
        (self.yield_hook)(self.database);
        let content = page.peek().ok_or_else(|| {
            DocumentError::Other(format!(
                "page {} left memory before it was written",
                page.id()
            ))
        })?;
        let base = page.base().filter(|base| base.stored_bytes() > 0);
        let base = match base {
            Some(base) => self.base_of(&base)?,
            None => None,
        };
        let level = self.database.level;
        let data = planes::encode(
            &content,
            base.as_ref().map(|(_, _, content)| &**content),
            level,
        )?;
        let (base, depth) = base.map_or((0, 0), |(id, depth, _)| (id, depth + 1));
        let slots = planes::mask(&content) as i64;
        let sum = page_checksum(page.id(), [base, depth, slots], &data);
        self.database
            .connection
            .prepare_cached("INSERT OR REPLACE INTO page VALUES(3, ?1, ?2, ?3, ?4, ?5, ?6)")?
            .execute(params![page.id() as i64, base, depth, slots, data, sum])?;
        self.stored.planes.push((page.clone(), data.len()));
        Ok(())
    }

    /// Base for a difference from `base`; `None` if its chain has the largest depth already.
    fn base_of(&self, base: &Page<Planes>) -> Result<Option<Base>, DocumentError> {
        let id = base.id() as i64;
        let depth: Option<i64> = self
            .database
            .connection
            .prepare_cached("SELECT depth FROM page WHERE id = ?1")?
            .query_row(params![id], |row| row.get(0))
            .optional()?;
        let Some(depth) = depth.filter(|depth| *depth < DEPTH_MAX) else {
            return Ok(None);
        };
        let content = match base.peek() {
            Some(content) => content,
            None => match self.database.planes(base.id()) {
                Ok(planes) => Arc::new(planes),
                // Nothing new may depend on a damaged page.
                Err(DocumentError::Damaged(_)) => return Ok(None),
                Err(error) => return Err(error),
            },
        };
        Ok(Some((id, depth, content)))
    }

    pub(crate) fn write_load(&mut self, page: &Page<BrushLoad>) -> Result<(), DocumentError> {
        if self.has(Table::Load, page.id(), page.stored_bytes() > 0)?
            || !self.written.insert(page.id())
        {
            return Ok(());
        }
        let content = page.peek().ok_or_else(|| {
            DocumentError::Other(format!(
                "load {} left memory before it was written",
                page.id()
            ))
        })?;
        let data = loads::encode(&content, self.database.level)?;
        let sum = load_checksum(page.id(), &data);
        self.database
            .connection
            .prepare_cached("INSERT OR REPLACE INTO load VALUES(5, ?1, ?2, ?3)")?
            .execute(params![page.id() as i64, data, sum])?;
        self.stored.loads.push((page.clone(), data.len()));
        Ok(())
    }

    fn write_step(&mut self, step: &Step) -> Result<(), DocumentError> {
        for change in step.tiles.values() {
            self.write_tile(&change.before)?;
            self.write_tile(&change.after)?;
        }
        for page in step.effects.loads.values().flatten() {
            self.write_load(page)?;
        }
        let what = serde_json::to_string(&step.what)?;
        let effects = serde_json::to_string(&StoredStepEffects::from(&*step.effects))?;
        let tiles = packed_changes(&step.tiles);
        let brush = step.brush.as_deref().unwrap_or_default();
        let (id, operations) = (step.id as i64, step.operations as i64);
        let sum = Checksum::new(Table::Step)
            .int(id)
            .bytes(what.as_bytes())
            .bytes(brush.as_bytes())
            .int(operations)
            .int(i64::from(step.done))
            .bytes(effects.as_bytes())
            .bytes(&tiles)
            .finish();
        self.database
            .connection
            .prepare_cached(
                "INSERT OR REPLACE INTO step VALUES(7, ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
            )?
            .execute(params![
                id, what, brush, operations, step.done, effects, tiles, sum
            ])?;
        Ok(())
    }

    fn write_version(&mut self, version: &Named) -> Result<(), DocumentError> {
        for tile in version.tiles.values() {
            self.write_tile(tile)?;
        }
        for page in version.rest.loads.values() {
            self.write_load(page)?;
        }
        let rest = serde_json::to_string(&StoredNonTileState::from(&version.rest))?;
        let tiles = packed_tiles(&version.tiles);
        let parent = version.parent.as_deref().unwrap_or_default();
        let sum = Checksum::new(Table::Version)
            .bytes(version.name.as_bytes())
            .bytes(parent.as_bytes())
            .bytes(rest.as_bytes())
            .bytes(&tiles)
            .finish();
        self.database.connection.execute(
            "INSERT OR REPLACE INTO version VALUES(8, ?1, ?2, ?3, ?4, ?5)",
            params![version.name, parent, rest, tiles, sum],
        )?;
        Ok(())
    }

    /// Writes tiles as they are displayed.
    pub(crate) fn write_shown(self, tiles: &[ShownTile]) -> Result<(), DocumentError> {
        for tile in tiles {
            (self.yield_hook)(self.database);
            self.write_shown_tile(tile)?;
        }
        Ok(())
    }

    fn write_shown_tile(&self, tile: &ShownTile) -> Result<(), DocumentError> {
        let data = zstd::bulk::compress(&tile.bytes, self.database.level)?;
        let version = tile.version as i64;
        let sum = shown_checksum(tile.place, version, tile.look, &data);
        self.database
            .connection
            .prepare_cached("INSERT OR REPLACE INTO shown VALUES(10, ?1, ?2, ?3, ?4, ?5)")?
            .execute(params![tile.place, version, tile.look, data, sum])?;
        Ok(())
    }

    fn has_file(&self, hash: &str) -> Result<bool, DocumentError> {
        let known: Option<i64> = self
            .database
            .connection
            .prepare_cached("SELECT 1 FROM file WHERE hash = ?1")?
            .query_row(params![hash], |row| row.get(0))
            .optional()?;
        Ok(known.is_some())
    }

    fn write_file(&self, kind: &str, name: &str, data: &[u8]) -> Result<String, DocumentError> {
        let hash = hash_of(data);
        if !self.has_file(&hash)? {
            let sum = Checksum::new(Table::File)
                .bytes(hash.as_bytes())
                .bytes(kind.as_bytes())
                .bytes(name.as_bytes())
                .bytes(data)
                .finish();
            self.database.connection.execute(
                "INSERT INTO file VALUES(2, ?1, ?2, ?3, ?4, ?5)",
                params![hash, kind, name, data, sum],
            )?;
        }
        Ok(hash)
    }

    /// Writes the paints and brushes of a snapshot; returns the snapshot with their hashes instead.
    pub(crate) fn with_files(
        &self,
        snapshot: &PaintingSnapshot,
    ) -> Result<PaintingSnapshot, DocumentError> {
        let mut snapshot = snapshot.clone();
        snapshot.paints = self.write_file("paints", "paints.csv", snapshot.paints.as_bytes())?;
        for (name, brush) in &mut snapshot.brushes {
            brush.file = self.write_file("brush", name, brush.file.as_bytes())?;
        }
        Ok(snapshot)
    }

    fn write_state(&self, checkpoint: &Checkpoint) -> Result<(), DocumentError> {
        let snapshot = self.with_files(&checkpoint.painting.kept)?;
        for (hash, data) in &checkpoint.pictures {
            if !self.has_file(hash)? {
                self.write_file(kind_of(data), hash, data)?;
            }
        }
        let painting = serde_json::to_string(&snapshot)?;
        let sequencer = serde_json::to_string(&checkpoint.sequencer)?;
        for copy in ["", COPY] {
            self.write_state_row(&format!("painting{copy}"), &painting)?;
            self.write_state_row(&format!("sequencer{copy}"), &sequencer)?;
        }
        Ok(())
    }

    fn write_state_row(&self, key: &str, value: &str) -> Result<(), DocumentError> {
        let sum = Checksum::new(Table::State)
            .bytes(key.as_bytes())
            .bytes(value.as_bytes())
            .finish();
        self.database
            .connection
            .prepare_cached("INSERT OR REPLACE INTO state VALUES(1, ?1, ?2, ?3)")?
            .execute(params![key, value, sum])?;
        Ok(())
    }
}
