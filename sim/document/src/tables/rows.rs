//! Tiles, steps and versions as rows.

use std::collections::BTreeMap;

use maulstick_canvas::page::Page;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_painting::history::{
    Booked, Change, NonTileState, StepEffects, SurfaceMaterial, TilePlace, TileRef,
};
use maulstick_painting::ledger::Ledger;
use maulstick_types::paint::StepName;
use maulstick_types::scene::Layer;
use maulstick_types::wire::worded::Worded as _;
use serde::{Deserialize, Serialize};

/// Key suffix of the second copy of the state: a single wrong bit in the only copy would cost the painting.
pub const COPY: &str = " copy";

/// Name of a step, JSON; rows before schema 7 have it in words.
pub(crate) fn step_name(text: &str) -> StepName {
    serde_json::from_str(text).unwrap_or_else(|_| StepName::of_words(text))
}

/// A tile's place as one number: surface · 2⁴⁰ + row · 2²⁰ + column.
#[must_use]
pub fn place_number((surface, id): TilePlace) -> i64 {
    i64::from(surface) << 40 | i64::from(id.y) << 20 | i64::from(id.x)
}

/// Reads [`place_number`].
#[must_use]
pub fn place_of(number: i64) -> TilePlace {
    let part = |shift: u32| (number >> shift) as u32 & 0xf_ffff;
    let id = TileId {
        y: part(20),
        x: part(0),
    };
    ((number >> 40) as u32, id)
}

/// A shown tile's place as one number: surface · 2⁵⁶ + level · 2⁴⁸ + row · 2²⁴ + column.
#[must_use]
pub fn shown_number(surface: u32, level: u32, id: TileId) -> i64 {
    i64::from(surface) << 56 | i64::from(level) << 48 | i64::from(id.y) << 24 | i64::from(id.x)
}

/// Numbers of a tile's wet page and of its newest dry layer; 0 if absent.
#[must_use]
pub fn page_ids(tile: &TileRef) -> [i64; 2] {
    let tile: Option<&Tile> = tile.as_deref();
    let page = tile.and_then(Tile::wet_page).map_or(0, |page| page.id());
    let dry = tile.and_then(Tile::dry).map_or(0, |stack| stack.id());
    [page as i64, dry as i64]
}

/// Numbers of 64 bits, little endian, as bytes.
#[must_use]
pub fn packed(numbers: impl IntoIterator<Item = i64>) -> Vec<u8> {
    numbers.into_iter().flat_map(i64::to_le_bytes).collect()
}

/// Place, page and dry layer of each tile, packed.
#[must_use]
pub fn packed_tiles(tiles: &BTreeMap<TilePlace, TileRef>) -> Vec<u8> {
    let numbers = tiles.iter().flat_map(|(place, tile)| {
        let place = place_number(*place);
        [place].into_iter().chain(page_ids(tile))
    });
    packed(numbers)
}

/// Place of each tile, page and dry layer before and after a change, packed.
#[must_use]
pub fn packed_changes(tiles: &BTreeMap<TilePlace, Change>) -> Vec<u8> {
    let numbers = tiles.iter().flat_map(|(place, change)| {
        let place = [place_number(*place)].into_iter();
        let ends = [&change.before, &change.after].map(page_ids);
        place.chain(ends.into_iter().flatten())
    });
    packed(numbers)
}

/// Reads [`packed`] in groups of `N`; `None` if bytes are left over.
#[must_use]
pub fn unpacked<const N: usize>(bytes: &[u8]) -> Option<Vec<[i64; N]>> {
    let (numbers, rest) = bytes.as_chunks::<8>();
    let (groups, over) = numbers.as_chunks::<N>();
    let whole = rest.is_empty() && over.is_empty();
    whole.then(|| {
        groups
            .iter()
            .map(|group| group.map(i64::from_le_bytes))
            .collect()
    })
}

/// Effects of a step besides tiles, as JSON: loads by number, dry layers and changed surfaces, each before and after
/// it, and the booked paint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StoredStepEffects {
    /// Loads by brush.
    pub loads: BTreeMap<String, [u64; 2]>,
    /// Paint for the ledger.
    pub booked: Booked,
    /// Dry layers.
    pub layers: Option<[Vec<Layer>; 2]>,
    /// Materials of the surfaces.
    pub materials: Option<[Vec<SurfaceMaterial>; 2]>,
    /// Greatest quanta of a cell of each surface so far, before and after.
    pub tops: [BTreeMap<u32, f32>; 2],
}

/// State of a version besides tiles, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredNonTileState {
    /// Loads by brush.
    pub loads: BTreeMap<String, u64>,
    /// Ledger of the version.
    pub ledger: Ledger,
    /// Dry layers.
    pub layers: Vec<Layer>,
    /// Materials of the surfaces.
    pub materials: Vec<SurfaceMaterial>,
    /// Greatest quanta of a cell of each surface so far.
    pub tops: BTreeMap<u32, f32>,
}

impl From<&StepEffects> for StoredStepEffects {
    fn from(effects: &StepEffects) -> Self {
        let loads = effects.loads.iter();
        Self {
            loads: loads
                .map(|(name, pages)| (name.clone(), pages.each_ref().map(Page::id)))
                .collect(),
            booked: effects.booked.clone(),
            layers: effects.layers.clone(),
            materials: effects.materials.clone(),
            tops: effects.tops.clone(),
        }
    }
}

impl From<&NonTileState> for StoredNonTileState {
    fn from(state: &NonTileState) -> Self {
        let loads = state.loads.iter();
        Self {
            loads: loads
                .map(|(name, page)| (name.clone(), page.id()))
                .collect(),
            ledger: state.ledger.clone(),
            layers: state.layers.clone(),
            materials: state.materials.clone(),
            tops: state.tops.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_numbers_come_back() {
        let place = (1, TileId { y: 1023, x: 77 });
        assert_eq!(place_of(place_number(place)), place);
        let groups = vec![[1, -2], [3, i64::MAX]];
        let bytes = packed(groups.iter().flatten().copied());
        assert_eq!(unpacked::<2>(&bytes), Some(groups));
        assert_eq!(unpacked::<2>(&bytes[1..]), None);
        assert_eq!(unpacked::<2>(&bytes[8..]), None);
    }
}
