//! A checkpoint as one transaction.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Instant;

use maulstick_canvas::assets::{hash_of, kind_of};
use maulstick_canvas::page::Page;
use maulstick_canvas::planes::Planes;
use maulstick_model::brush::load::BrushLoad;
use maulstick_painting::history::{Step, TileRef};
use maulstick_painting::snapshot::SequencerSnapshot;
use maulstick_painting::{Checkpoint, Named, Sequencer};
use rusqlite::{OptionalExtension as _, params};

use crate::database::{DEPTH_MAX, Database, load_sum, page_sum, shown_sum};
use crate::error::DocumentError;
use crate::rows::{KeptDeed, KeptRest, numbers, packed, place_number};
use crate::schema::Table;
use crate::sum::Sum;
use crate::{loads, planes};

/// A moment of a painting with its place in the journal, and files that belong to it.
#[derive(Clone, Debug)]
pub struct Moment {
    /// The painting.
    pub painting: Checkpoint,
    /// The sequencer.
    pub sequencer: SequencerSnapshot,
    /// Pictures and spectra of grounds and teeth, by their hash.
    pub pictures: Vec<(String, Arc<[u8]>)>,
}

impl Moment {
    /// A moment of a painting, with the tiles that are newer than the version `since`.
    pub fn of(sequencer: &mut Sequencer, since: u64) -> Self {
        let kept = sequencer.kept();
        let embedded = sequencer.painting().embedded().iter();
        let pictures = embedded.map(|(hash, bytes)| (hash.to_owned(), Arc::clone(bytes)));
        Self {
            pictures: pictures.collect(),
            painting: sequencer.painting_mut().checkpoint(since),
            sequencer: kept,
        }
    }
}

/// A tile as it is shown.
#[derive(Clone, Debug)]
pub struct ShownTile {
    /// Its place, [`crate::rows::shown_number`].
    pub place: i64,
    /// The tile version that it shows.
    pub version: u64,
    /// Look under which it is shown.
    pub look: i64,
    /// Its planes.
    pub bytes: Vec<u8>,
}

/// Suffix of the keys of the second copy of the state: without that copy a single wrong bit would cost all.
pub(crate) const COPY: &str = " copy";

/// Called between two pages: a reader may wait for one.
pub(crate) type Breath<'a> = &'a mut dyn FnMut(&Database);

/// Rows that were written, to be noted once they are committed.
#[derive(Debug, Default)]
pub(crate) struct Stored {
    planes: Vec<(Page<Planes>, usize)>,
    loads: Vec<(Page<BrushLoad>, usize)>,
    stacks: Vec<Arc<maulstick_canvas::dry::DryStack>>,
}

impl Stored {
    /// Notes that the document has it all.
    pub(crate) fn note(self) {
        self.planes
            .iter()
            .for_each(|(page, bytes)| page.note_stored(*bytes));
        self.loads
            .iter()
            .for_each(|(page, bytes)| page.note_stored(*bytes));
        self.stacks.iter().for_each(|stack| stack.note_stored());
    }
}

/// Number, depth and planes of a page that another one is a difference to.
type Base = (i64, i64, Arc<Planes>);

/// Writes inside one transaction.
pub(crate) struct Writer<'a, 'b> {
    database: &'a Database,
    breathe: Breath<'b>,
    stored: Stored,
    written: BTreeSet<u64>,
}

impl<'a, 'b> Writer<'a, 'b> {
    pub(crate) fn new(database: &'a Database, breathe: Breath<'b>) -> Self {
        Self {
            database,
            breathe,
            stored: Stored::default(),
            written: Default::default(),
        }
    }

    /// Writes a checkpoint and deletes what it replaces. If its pages take longer than `until` only some of these are
    /// written, still unreferenced, and false is returned.
    pub(crate) fn moment(
        mut self,
        moment: &Moment,
        until: Instant,
    ) -> Result<(Stored, bool), DocumentError> {
        let painting = &moment.painting;
        let tiles = painting.tiles.iter().map(|(_, version)| &version.tile);
        let changes = painting.steps.iter().flat_map(|step| step.tiles.values());
        let steps = changes.flat_map(|change| [&change.before, &change.after]);
        let named = painting.named.iter().flat_map(|named| named.tiles.values());
        for held in tiles.chain(steps).chain(named) {
            self.held(held)?;
            if !self.written.is_empty() && Instant::now() > until {
                return Ok((self.stored, false));
            }
        }
        for step in &painting.steps {
            self.step(step)?;
        }
        for version in &painting.named {
            self.version(version)?;
        }
        for page in painting.loads.values() {
            self.load(page)?;
        }
        let connection = &self.database.connection;
        for (place, version) in &painting.tiles {
            let place = place_number(*place);
            let [page, dry] = numbers(&version.tile);
            let ints = [place, version.number as i64, page, dry];
            let sum = ints.into_iter().fold(Sum::of(Table::Tile), Sum::int).done();
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
        self.state(moment)?;
        self.bury(&painting.dead)?;
        connection.execute(
            "DELETE FROM journal WHERE last < ?1",
            params![moment.sequencer.serial as i64],
        )?;
        Ok((self.stored, true))
    }

    fn held(&mut self, held: &TileRef) -> Result<(), DocumentError> {
        let Some(tile) = held else {
            return Ok(());
        };
        if let Some(page) = tile.wet_page() {
            self.page(page)?;
        }
        let mut next = tile.dry();
        while let Some(stack) = next.filter(|stack| !stack.is_stored()) {
            next = stack.below();
            if !self.written.insert(stack.id()) {
                continue;
            }
            self.page(&stack.layer().planes)?;
            let below = stack.below().map_or(0, |below| below.id());
            let ints = [
                stack.id(),
                below,
                u64::from(stack.layer().number),
                stack.layer().planes.id(),
            ]
            .map(|number| number as i64);
            let sum = ints.into_iter().fold(Sum::of(Table::Dry), Sum::int).done();
            self.database
                .connection
                .prepare_cached("INSERT OR REPLACE INTO dry VALUES(4, ?1, ?2, ?3, ?4, ?5)")?
                .execute(params![ints[0], ints[1], ints[2], ints[3], sum])?;
            self.stored.stacks.push(Arc::clone(stack));
        }
        Ok(())
    }

    fn page(&mut self, page: &Page<Planes>) -> Result<(), DocumentError> {
        if page.stored_bytes() > 0 || !self.written.insert(page.id()) {
            return Ok(());
        }
        (self.breathe)(self.database);
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
        let slots = i64::from(planes::mask(&content));
        let sum = page_sum(page.id(), [base, depth, slots], &data);
        self.database
            .connection
            .prepare_cached("INSERT OR REPLACE INTO page VALUES(3, ?1, ?2, ?3, ?4, ?5, ?6)")?
            .execute(params![page.id() as i64, base, depth, slots, data, sum])?;
        self.stored.planes.push((page.clone(), data.len()));
        Ok(())
    }

    /// Number, depth and planes of the page that another one is a difference to; `None` if the chain is long enough.
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
                // Nothing new is to rest on a page that is damaged.
                Err(DocumentError::Damaged(_)) => return Ok(None),
                Err(error) => return Err(error),
            },
        };
        Ok(Some((id, depth, content)))
    }

    fn load(&mut self, page: &Page<BrushLoad>) -> Result<(), DocumentError> {
        if page.stored_bytes() > 0 || !self.written.insert(page.id()) {
            return Ok(());
        }
        let content = page.peek().ok_or_else(|| {
            DocumentError::Other(format!(
                "load {} left memory before it was written",
                page.id()
            ))
        })?;
        let data = loads::encode(&content, self.database.level)?;
        let sum = load_sum(page.id(), &data);
        self.database
            .connection
            .prepare_cached("INSERT OR REPLACE INTO load VALUES(5, ?1, ?2, ?3)")?
            .execute(params![page.id() as i64, data, sum])?;
        self.stored.loads.push((page.clone(), data.len()));
        Ok(())
    }

    fn step(&mut self, step: &Step) -> Result<(), DocumentError> {
        let mut tiles = Vec::with_capacity(step.tiles.len() * 5);
        for (place, change) in &*step.tiles {
            self.held(&change.before)?;
            self.held(&change.after)?;
            tiles.push(place_number(*place));
            tiles.extend(numbers(&change.before));
            tiles.extend(numbers(&change.after));
        }
        for page in step.effects.loads.values().flatten() {
            self.load(page)?;
        }
        let loads = step.effects.loads.iter();
        let effects = KeptDeed {
            loads: loads
                .map(|(name, pages)| (name.clone(), pages.each_ref().map(Page::id)))
                .collect(),
            booked: step.effects.booked.clone(),
            layers: step.effects.layers.clone(),
            makes: step.effects.makes.clone(),
            tops: step.effects.tops.clone(),
        };
        let effects = serde_json::to_string(&effects)?;
        let tiles = packed(tiles);
        let brush = step.brush.as_deref().unwrap_or_default();
        let (id, operations) = (step.id as i64, step.operations as i64);
        let sum = Sum::of(Table::Step)
            .int(id)
            .bytes(step.what.as_bytes())
            .bytes(brush.as_bytes())
            .int(operations)
            .int(i64::from(step.done))
            .bytes(effects.as_bytes())
            .bytes(&tiles)
            .done();
        self.database
            .connection
            .prepare_cached(
                "INSERT OR REPLACE INTO step VALUES(7, ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
            )?
            .execute(params![
                id, step.what, brush, operations, step.done, effects, tiles, sum
            ])?;
        Ok(())
    }

    fn version(&mut self, version: &Named) -> Result<(), DocumentError> {
        let mut tiles = Vec::with_capacity(version.tiles.len() * 3);
        for (place, held) in &*version.tiles {
            self.held(held)?;
            tiles.push(place_number(*place));
            tiles.extend(numbers(held));
        }
        for page in version.rest.loads.values() {
            self.load(page)?;
        }
        let loads = version.rest.loads.iter();
        let rest = KeptRest {
            loads: loads
                .map(|(name, page)| (name.clone(), page.id()))
                .collect(),
            ledger: version.rest.ledger.clone(),
            layers: version.rest.layers.clone(),
            makes: version.rest.makes.clone(),
            tops: version.rest.tops.clone(),
        };
        let rest = serde_json::to_string(&rest)?;
        let tiles = packed(tiles);
        let parent = version.parent.as_deref().unwrap_or_default();
        let sum = Sum::of(Table::Version)
            .bytes(version.name.as_bytes())
            .bytes(parent.as_bytes())
            .bytes(rest.as_bytes())
            .bytes(&tiles)
            .done();
        self.database.connection.execute(
            "INSERT OR REPLACE INTO version VALUES(8, ?1, ?2, ?3, ?4, ?5)",
            params![version.name, parent, rest, tiles, sum],
        )?;
        Ok(())
    }

    /// Writes tiles as they are shown.
    pub(crate) fn shown(self, tiles: &[ShownTile]) -> Result<(), DocumentError> {
        for tile in tiles {
            (self.breathe)(self.database);
            self.show(tile)?;
        }
        Ok(())
    }

    fn show(&self, tile: &ShownTile) -> Result<(), DocumentError> {
        let data = zstd::bulk::compress(&tile.bytes, self.database.level)?;
        let version = tile.version as i64;
        let sum = shown_sum(tile.place, version, tile.look, &data);
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

    fn file(&self, kind: &str, name: &str, data: &[u8]) -> Result<String, DocumentError> {
        let hash = hash_of(data);
        if !self.has_file(&hash)? {
            let sum = Sum::of(Table::File)
                .bytes(hash.as_bytes())
                .bytes(kind.as_bytes())
                .bytes(name.as_bytes())
                .bytes(data)
                .done();
            self.database.connection.execute(
                "INSERT INTO file VALUES(2, ?1, ?2, ?3, ?4, ?5)",
                params![hash, kind, name, data, sum],
            )?;
        }
        Ok(hash)
    }

    fn state(&self, moment: &Moment) -> Result<(), DocumentError> {
        let mut kept = moment.painting.kept.clone();
        kept.paints = self.file("paints", "paints.csv", kept.paints.as_bytes())?;
        for (name, brush) in &mut kept.brushes {
            brush.file = self.file("brush", name, brush.file.as_bytes())?;
        }
        for (hash, data) in &moment.pictures {
            if !self.has_file(hash)? {
                self.file(kind_of(data), hash, data)?;
            }
        }
        let painting = serde_json::to_string(&kept)?;
        let sequencer = serde_json::to_string(&moment.sequencer)?;
        for copy in ["", COPY] {
            self.put_state(&format!("painting{copy}"), &painting)?;
            self.put_state(&format!("sequencer{copy}"), &sequencer)?;
        }
        Ok(())
    }

    fn put_state(&self, key: &str, value: &str) -> Result<(), DocumentError> {
        let sum = Sum::of(Table::State)
            .bytes(key.as_bytes())
            .bytes(value.as_bytes())
            .done();
        self.database
            .connection
            .prepare_cached("INSERT OR REPLACE INTO state VALUES(1, ?1, ?2, ?3)")?
            .execute(params![key, value, sum])?;
        Ok(())
    }

    /// Deletes pages and layers without references. Pages that are differences to one of them are written anew.
    fn bury(&mut self, dead: &[u64]) -> Result<(), DocumentError> {
        let connection = &self.database.connection;
        let gone: BTreeSet<u64> = dead.iter().copied().collect();
        for id in &gone {
            for later in self.differences_to(*id)? {
                if gone.contains(&later) {
                    continue;
                }
                (self.breathe)(self.database);
                match self.database.planes(later) {
                    Ok(content) => self.rebase(later, &content)?,
                    // It is lost with its base or without; what is painted now is not.
                    Err(DocumentError::Damaged(_)) => {}
                    Err(error) => return Err(error),
                }
            }
        }
        for id in &gone {
            for table in ["page", "dry", "load"] {
                connection
                    .prepare_cached(&format!("DELETE FROM {table} WHERE id = ?1"))?
                    .execute(params![*id as i64])?;
            }
        }
        Ok(())
    }

    fn differences_to(&self, id: u64) -> Result<Vec<u64>, DocumentError> {
        let query = "SELECT id FROM page WHERE base = ?1";
        let mut statement = self.database.connection.prepare_cached(query)?;
        let later = statement.query_map(params![id as i64], |row| row.get::<_, i64>(0))?;
        Ok(later
            .map(|id| Ok(id? as u64))
            .collect::<Result<_, rusqlite::Error>>()?)
    }

    /// Writes a page that was a difference so that it needs no other.
    fn rebase(&self, id: u64, content: &Planes) -> Result<(), DocumentError> {
        let data = planes::encode(content, None, self.database.level)?;
        let slots = i64::from(planes::mask(content));
        let sum = page_sum(id, [0, 0, slots], &data);
        let query =
            "UPDATE page SET base = 0, depth = 0, slots = ?2, data = ?3, sum = ?4 WHERE id = ?1";
        self.database
            .connection
            .prepare_cached(query)?
            .execute(params![id as i64, slots, data, sum])?;
        Ok(())
    }
}
