//! Steps of the history that can still be undone from the recovered tiles.

use std::collections::{BTreeMap, HashMap};

use maulstick_canvas::quantum::{Counts, SLOTS};
use maulstick_document::DocumentError;
use maulstick_document::file::database::Database;
use maulstick_document::rows::{StoredStepEffects, unpacked};
use maulstick_painting::history::SurfaceMaterial;
use maulstick_painting::snapshot::PaintingSnapshot;
use maulstick_types::scene::{Layer, Scene};

use super::intact_rows::IntactRows;
use super::inventory::{Inventory, TileIds};
use super::materials::MaterialSources;
use super::painting_row::PaintingRow;

/// Row of a step, decoded.
struct StepRow {
    row: PaintingRow,
    /// Tiles by place number, before and after the step.
    tiles: Vec<(i64, [TileIds; 2])>,
    effects: StoredStepEffects,
}

/// History: steps by number, without content if their row is damaged.
pub(super) struct Steps {
    /// By whether it is open, since an open step is above all others, and number.
    done: BTreeMap<(bool, i64), Option<StepRow>>,
    /// In the order in which they were undone.
    undone: Vec<(i64, Option<StepRow>)>,
    knows_free: bool,
}

/// Steps that were written, and how many were dropped.
#[derive(Debug, Default)]
pub(super) struct WrittenSteps {
    pub(super) count: u64,
    pub(super) dropped: u64,
    /// Numbers of the steps that can be undone.
    pub(super) done: Vec<u64>,
    /// Numbers of the undone steps, in the order in which they were undone.
    pub(super) undone: Vec<u64>,
}

/// State of a painting while its steps are undone in memory.
pub(super) struct UndoState {
    pub(super) tiles: HashMap<i64, TileIds>,
    pub(super) loads: BTreeMap<String, Counts>,
    pub(super) layers: Vec<Layer>,
    pub(super) materials: Vec<SurfaceMaterial>,
}

/// Materials of the surfaces of a scene.
pub(super) fn materials(scene: &Scene) -> Vec<SurfaceMaterial> {
    let materials = scene.surfaces.iter().map(|surface| SurfaceMaterial {
        surface: surface.id,
        ground: surface.ground.clone(),
        tooth: surface.tooth.clone(),
        tooth_seed: surface.tooth_seed,
        wells: surface.wells.clone(),
        model: surface.model.clone(),
    });
    materials.collect()
}

impl Steps {
    /// Extracts the steps from the intact rows; `snapshot` is the state of the painting.
    pub(super) fn take(
        rows: &mut IntactRows,
        snapshot: &PaintingSnapshot,
        sources: &MaterialSources,
    ) -> Self {
        let intact = std::mem::take(&mut rows.steps);
        let damaged = rows.damaged_steps.iter().map(|id| (*id, Vec::new()));
        let mut all: BTreeMap<i64, Vec<PaintingRow>> = damaged.collect();
        all.extend(intact);
        let mut steps = Self {
            done: BTreeMap::new(),
            undone: Vec::new(),
            knows_free: rows.knows_free,
        };
        let place = |id: i64| snapshot.undone.iter().position(|other| *other as i64 == id);
        for (id, copies) in all {
            // The copy that agrees with the state of the painting, and the longest of those.
            let fits = |copy: &PaintingRow| (copy.int(4) == 0) == place(id).is_some();
            let best = copies
                .into_iter()
                .max_by_key(|copy| (fits(copy), copy.blob(6).len()));
            let is_done = best
                .as_ref()
                .map_or(place(id).is_none(), |copy| copy.int(4) != 0);
            let step = best.and_then(StepRow::decode);
            let step = step.filter(|step| step.has_sources(sources));
            if is_done {
                let is_open = snapshot
                    .open_steps
                    .iter()
                    .any(|open| open.step as i64 == id);
                drop(steps.done.insert((is_open, id), step));
            } else {
                steps.undone.push((id, step))
            }
        }
        // Steps missing in the state were undone later, the newest first.
        let last = snapshot.undone.len();
        steps
            .undone
            .sort_by_key(|(id, _)| (place(*id).unwrap_or(last), -*id));
        steps
    }

    /// Contents of the tiles, newest first.
    pub(super) fn states(&self) -> HashMap<i64, Vec<TileIds>> {
        let mut states: HashMap<i64, Vec<TileIds>> = HashMap::new();
        for step in self.done.values().rev().flatten() {
            for (place, [before, after]) in &step.tiles {
                states.entry(*place).or_default().extend([*after, *before]);
            }
        }
        for (_, step) in self.undone.iter().rev() {
            for (place, [before, _]) in step.iter().flat_map(|step| &step.tiles) {
                states.entry(*place).or_default().push(*before);
            }
        }
        states
    }

    /// Writes the steps that can be undone from `now`, from the newest on. A step that cannot is dropped with all older
    /// ones.
    ///
    /// # Errors
    /// The error of SQLite.
    pub(super) fn write(
        self,
        mut now: UndoState,
        inventory: &Inventory,
        database: &Database,
    ) -> Result<WrittenSteps, DocumentError> {
        let mut written = WrittenSteps::default();
        let mut is_broken = false;
        for ((_, id), step) in self.done.into_iter().rev() {
            let step = step.filter(|step| !is_broken && step.can_be_undone(&now, inventory));
            match step {
                Some(step) => {
                    step.row.write(database)?;
                    now.undo(step, inventory);
                    written.count += 1;
                    written.done.push(id as u64);
                }
                None => {
                    written.dropped += 1;
                    // Without the list of free pages it may have been deleted long ago.
                    is_broken |= self.knows_free;
                }
            }
        }
        let mut is_broken = false;
        for (id, step) in self.undone.into_iter().rev() {
            let step = step.filter(|step| !is_broken && step.balances(inventory));
            match step {
                Some(step) => {
                    step.row.write(database)?;
                    written.count += 1;
                    written.undone.push(id as u64);
                }
                None => {
                    written.dropped += 1;
                    is_broken = true;
                }
            }
        }
        written.undone.reverse();
        Ok(written)
    }
}

impl StepRow {
    fn decode(row: PaintingRow) -> Option<Self> {
        let groups = unpacked::<5>(row.blob(6))?;
        let tiles = groups
            .into_iter()
            .map(|[place, a, b, c, d]| (place, [[a, b], [c, d]]));
        Some(Self {
            tiles: tiles.collect(),
            effects: serde_json::from_str(row.text(5)).ok()?,
            row,
        })
    }

    fn has_sources(&self, sources: &MaterialSources) -> bool {
        let mut materials = self.effects.materials.iter().flatten();
        materials.all(|materials| sources.has_all(materials))
    }

    /// True if all paint that it refers to is intact, and its change equals its bookings.
    fn balances(&self, inventory: &Inventory) -> bool {
        let mut change = [0i64; SLOTS];
        let mut add_change = |ends: [Option<Counts>; 2]| {
            let [Some(before), Some(after)] = ends else {
                return false;
            };
            for slot in 0..SLOTS {
                change[slot] += after[slot] as i64 - before[slot] as i64;
            }
            true
        };
        let mut tiles = self.tiles.iter();
        let mut loads = self.effects.loads.values();
        tiles.all(|(_, ends)| add_change(ends.map(|ids| inventory.tile(ids))))
            && loads.all(|ends| add_change(ends.map(|id| inventory.load(id))))
            && change == self.effects.booked.due()
    }

    /// True if it can be undone in the state `now`.
    fn can_be_undone(&self, now: &UndoState, inventory: &Inventory) -> bool {
        let content = |place: &i64| now.tiles.get(place).copied().unwrap_or_default();
        let mut tiles = self.tiles.iter();
        let mut loads = self.effects.loads.iter();
        let layers = self.effects.layers.as_ref();
        let materials = self.effects.materials.as_ref();
        self.balances(inventory)
            && tiles.all(|(place, [_, after])| content(place) == *after)
            && loads.all(|(name, [_, after])| {
                let carried = now.loads.get(name);
                carried.is_none_or(|carried| inventory.load(*after).as_ref() == Some(carried))
            })
            && layers.is_none_or(|[_, after]| *after == now.layers)
            && materials.is_none_or(|[_, after]| *after == now.materials)
    }
}

impl UndoState {
    fn undo(&mut self, step: StepRow, inventory: &Inventory) {
        let before = step
            .tiles
            .into_iter()
            .map(|(place, [before, _])| (place, before));
        self.tiles.extend(before);
        for (name, [before, _]) in step.effects.loads {
            self.loads
                .insert(name, inventory.load(before).unwrap_or([0; SLOTS]));
        }
        if let Some([before, _]) = step.effects.layers {
            self.layers = before;
        }
        if let Some([before, _]) = step.effects.materials {
            self.materials = before;
        }
    }
}
