//! Steps of the history that still lead from the current tiles to the earlier ones.

use std::collections::{BTreeMap, HashMap};

use maulstick_canvas::quantum::{Counts, SLOTS};
use maulstick_painting::history::SurfaceMaterial;
use maulstick_painting::snapshot::PaintingSnapshot;
use maulstick_types::scene::{Layer, Scene};

use super::found::Found;
use super::gathering::Gathered;
use super::pictures::Pictures;
use super::stock::{Numbers, Stock};
use crate::database::Database;
use crate::error::DocumentError;
use crate::rows::{KeptDeed, unpacked};

/// A step as its row has it.
struct Known {
    found: Found,
    /// Place number, what was on it before and after.
    tiles: Vec<(i64, [Numbers; 2])>,
    deed: KeptDeed,
}

/// The history: steps by number, without content where their row is not whole.
pub(super) struct Steps {
    /// By whether it is unfinished, for that lies over all others, and number.
    done: BTreeMap<(bool, i64), Option<Known>>,
    /// The last one undone at the end.
    undone: Vec<(i64, Option<Known>)>,
    knows_free: bool,
}

/// Result for the history.
#[derive(Debug, Default)]
pub(super) struct Walked {
    pub(super) kept: u64,
    pub(super) dropped: u64,
    /// Numbers of the steps that are done.
    pub(super) done: Vec<u64>,
    /// Numbers of the steps that were undone, the last one at the end.
    pub(super) undone: Vec<u64>,
}

/// State of a painting while its steps are undone in memory.
pub(super) struct Now {
    pub(super) tiles: HashMap<i64, Numbers>,
    pub(super) loads: BTreeMap<String, Counts>,
    pub(super) layers: Vec<Layer>,
    pub(super) makes: Vec<SurfaceMaterial>,
}

/// Materials of the surfaces of a scene.
pub(super) fn makes(scene: &Scene) -> Vec<SurfaceMaterial> {
    let made = scene.surfaces.iter().map(|surface| SurfaceMaterial {
        surface: surface.id,
        ground: surface.ground.clone(),
        tooth: surface.tooth.clone(),
        tooth_seed: surface.tooth_seed,
    });
    made.collect()
}

impl Steps {
    /// The steps that were found, of a painting saved with them.
    pub(super) fn of(
        gathered: &mut Gathered,
        kept: &PaintingSnapshot,
        pictures: &Pictures,
    ) -> Self {
        let found = std::mem::take(&mut gathered.steps);
        let torn = gathered.torn_steps.iter().map(|id| (*id, Vec::new()));
        let mut all: BTreeMap<i64, Vec<Found>> = torn.collect();
        all.extend(found);
        let mut steps = Self {
            done: BTreeMap::new(),
            undone: Vec::new(),
            knows_free: gathered.knows_free,
        };
        let place = |id: i64| kept.undone.iter().position(|other| *other as i64 == id);
        for (id, copies) in all {
            // Of several copies the one that is as the painting was kept, and the longest.
            let fits = |copy: &Found| (copy.int(4) == 0) == place(id).is_some();
            let best = copies
                .into_iter()
                .max_by_key(|copy| (fits(copy), copy.blob(6).len()));
            let is_done = best
                .as_ref()
                .map_or(place(id).is_none(), |copy| copy.int(4) != 0);
            let known = best.and_then(Known::of);
            let known = known.filter(|known| known.is_made_of(pictures));
            match is_done {
                true => {
                    let is_open = kept.open_steps.iter().any(|open| open.step as i64 == id);
                    drop(steps.done.insert((is_open, id), known));
                }
                false => steps.undone.push((id, known)),
            }
        }
        // Those of which the painting does not know were undone later, the newest step first.
        let last = kept.undone.len();
        steps
            .undone
            .sort_by_key(|(id, _)| (place(*id).unwrap_or(last), -*id));
        steps
    }

    /// Contents of the tiles, the newest first.
    pub(super) fn states(&self) -> HashMap<i64, Vec<Numbers>> {
        let mut states: HashMap<i64, Vec<Numbers>> = HashMap::new();
        for known in self.done.values().rev().flatten() {
            for (place, [before, after]) in &known.tiles {
                states.entry(*place).or_default().extend([*after, *before]);
            }
        }
        for (_, known) in self.undone.iter().rev() {
            for (place, [before, _]) in known.iter().flat_map(|known| &known.tiles) {
                states.entry(*place).or_default().push(*before);
            }
        }
        states
    }

    /// Writes the steps that still lead back from `now`, each by itself from the newest on; one that does not goes with
    /// all older ones.
    ///
    /// # Errors
    /// The error of SQLite.
    pub(super) fn write(
        self,
        mut now: Now,
        stock: &Stock,
        database: &Database,
    ) -> Result<Walked, DocumentError> {
        let mut walked = Walked::default();
        let mut is_broken = false;
        for ((_, id), known) in self.done.into_iter().rev() {
            let leads = known.filter(|known| !is_broken && known.leads_from(&now, stock));
            match leads {
                Some(known) => {
                    known.found.write(database)?;
                    now.take_back(known, stock);
                    walked.kept += 1;
                    walked.done.push(id as u64);
                }
                None => {
                    walked.dropped += 1;
                    // It may have been deleted long ago.
                    is_broken |= self.knows_free;
                }
            }
        }
        let mut is_broken = false;
        for (id, known) in self.undone.into_iter().rev() {
            let whole = known.filter(|known| !is_broken && known.balances(stock));
            match whole {
                Some(known) => {
                    known.found.write(database)?;
                    walked.kept += 1;
                    walked.undone.push(id as u64);
                }
                None => {
                    walked.dropped += 1;
                    is_broken = true;
                }
            }
        }
        walked.undone.reverse();
        Ok(walked)
    }
}

impl Known {
    fn of(found: Found) -> Option<Self> {
        let groups = unpacked::<5>(found.blob(6))?;
        let tiles = groups
            .into_iter()
            .map(|[place, a, b, c, d]| (place, [[a, b], [c, d]]));
        Some(Self {
            tiles: tiles.collect(),
            deed: serde_json::from_str(found.text(5)).ok()?,
            found,
        })
    }

    fn is_made_of(&self, pictures: &Pictures) -> bool {
        let mut makes = self.deed.makes.iter().flatten();
        makes.all(|makes| pictures.has_all(makes))
    }

    /// True if all paint that it names is there, and it books just the paint that it brings.
    fn balances(&self, stock: &Stock) -> bool {
        let mut brought = [0i64; SLOTS];
        let mut bring = |ends: [Option<Counts>; 2]| {
            let [Some(before), Some(after)] = ends else {
                return false;
            };
            for slot in 0..SLOTS {
                brought[slot] += after[slot] as i64 - before[slot] as i64;
            }
            true
        };
        let mut tiles = self.tiles.iter();
        let mut loads = self.deed.loads.values();
        tiles.all(|(_, ends)| bring(ends.map(|numbers| stock.held(numbers))))
            && loads.all(|ends| bring(ends.map(|id| stock.load(id))))
            && brought == self.deed.booked.due()
    }

    /// True if it can be undone in the state `now`.
    fn leads_from(&self, now: &Now, stock: &Stock) -> bool {
        let there = |place: &i64| now.tiles.get(place).copied().unwrap_or_default();
        let mut tiles = self.tiles.iter();
        let mut loads = self.deed.loads.iter();
        let layers = self.deed.layers.as_ref();
        let makes = self.deed.makes.as_ref();
        self.balances(stock)
            && tiles.all(|(place, [_, after])| there(place) == *after)
            && loads.all(|(name, [_, after])| {
                let carried = now.loads.get(name);
                carried.is_none_or(|carried| stock.load(*after).as_ref() == Some(carried))
            })
            && layers.is_none_or(|[_, after]| *after == now.layers)
            && makes.is_none_or(|[_, after]| *after == now.makes)
    }
}

impl Now {
    fn take_back(&mut self, step: Known, stock: &Stock) {
        let before = step
            .tiles
            .into_iter()
            .map(|(place, [before, _])| (place, before));
        self.tiles.extend(before);
        for (name, [before, _]) in step.deed.loads {
            self.loads
                .insert(name, stock.load(before).unwrap_or_default());
        }
        if let Some([before, _]) = step.deed.layers {
            self.layers = before;
        }
        if let Some([before, _]) = step.deed.makes {
            self.makes = before;
        }
    }
}
