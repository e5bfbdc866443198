//! Balance of a ledger after a loss.

use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_painting::ledger::Ledger;

use super::inventory::{Inventory, TileIds};

/// Balances a ledger for the existing paint: missing paint counts as removed by the cleaner, surplus paint as from the
/// tubes.
pub(super) fn balance(ledger: &mut Ledger, there: &Counts) {
    let due = ledger.due();
    let off = |slot: usize| due[slot].saturating_sub_unsigned(there[slot]);
    let missing: Counts = std::array::from_fn(|slot| off(slot).max(0).unsigned_abs());
    let surplus: Counts = std::array::from_fn(|slot| off(slot).min(0).unsigned_abs());
    ledger.to_cleaner(&missing);
    ledger.from_tube(&surplus);
}

/// Sum of the paint of tiles and loads.
pub(super) fn paint<'a>(
    inventory: &Inventory,
    tiles: impl Iterator<Item = TileIds>,
    loads: impl Iterator<Item = &'a u64>,
) -> Counts {
    let mut all = [0; SLOTS];
    let tiles = tiles.filter_map(|ids| inventory.tile(ids));
    let loads = loads.filter_map(|id| inventory.load(*id));
    tiles.chain(loads).for_each(|counts| add(&mut all, &counts));
    all
}
