//! Tiles, steps and versions as rows.

use std::collections::BTreeMap;

use maulstick_canvas::tile::{Tile, TileId};
use maulstick_painting::history::{Booked, SurfaceMaterial, TilePlace, TileRef};
use maulstick_painting::ledger::Ledger;
use maulstick_types::scene::Layer;
use serde::{Deserialize, Serialize};

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

/// The numbers of a tile's page and of its newest dry layer; 0 if absent.
#[must_use]
pub fn numbers(held: &TileRef) -> [i64; 2] {
    let tile: Option<&Tile> = held.as_deref();
    let page = tile.and_then(Tile::wet_page).map_or(0, |page| page.id());
    let dry = tile.and_then(Tile::dry).map_or(0, |stack| stack.id());
    [page as i64, dry as i64]
}

/// Numbers of 64 bits, little endian, as bytes.
#[must_use]
pub fn packed(numbers: impl IntoIterator<Item = i64>) -> Vec<u8> {
    numbers.into_iter().flat_map(i64::to_le_bytes).collect()
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

/// Changes of a step besides tiles: the numbers of loads before and after it, the paint it booked, and layers and
/// surfaces before and after it where it changed them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct KeptDeed {
    /// Loads by brush.
    pub loads: BTreeMap<String, [u64; 2]>,
    /// Booked.
    pub booked: Booked,
    /// Dry layers.
    pub layers: Option<[Vec<Layer>; 2]>,
    /// Surfaces.
    pub makes: Option<[Vec<SurfaceMaterial>; 2]>,
    /// Most quanta that a cell of a surface ever had.
    pub tops: [BTreeMap<u32, f32>; 2],
}

/// State of a painting in a version besides tiles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct KeptRest {
    /// Loads by brush.
    pub loads: BTreeMap<String, u64>,
    /// The books.
    pub ledger: Ledger,
    /// Dry layers.
    pub layers: Vec<Layer>,
    /// Surfaces.
    pub makes: Vec<SurfaceMaterial>,
    /// Most quanta that a cell of a surface ever had.
    pub tops: BTreeMap<u32, f32>,
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
