//! Parts of surfaces, and their wet and dry paint.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::error::{EditError, SurfaceError};

use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::Region;
use maulstick_types::paint::TILE;

use super::{SurfaceState, Surfaces};

/// A part of a surface.
pub(crate) struct Part {
    /// Its cells: the first column and row, and one past the last.
    cells: [[u32; 2]; 2],
}

/// Tiles after some of their paint dried, or became wet.
pub(crate) type Changed = Vec<(TileId, Arc<Tile>)>;

impl Surfaces {
    /// The index of a surface, and a part of it, or all of it.
    pub(crate) fn part(
        &self,
        surface: u32,
        region: Option<&Region>,
    ) -> Result<(usize, Part), EditError> {
        let on = self.at(surface)?;
        Ok((on, self[on].part(region)?))
    }
}

/// True if any of the cells that `within` says holds counted paint.
fn holds_paint(planes: &Planes, within: &[bool]) -> bool {
    planes.iter().any(|(_, plane)| {
        let mut cells = plane.iter().zip(within);
        cells.any(|(count, within)| *within && *count > 0.0)
    })
}

impl SurfaceState {
    /// A part of it, or all of it.
    pub(crate) fn part(&self, region: Option<&Region>) -> Result<Part, EditError> {
        let cells = self.store.cells();
        let Some(region) = region else {
            return Ok(Part {
                cells: [[0, 0], cells],
            });
        };
        region.check()?;
        let within = region.cells(cells, self.cell_m);
        let cells = within.ok_or_else(|| SurfaceError::NoCell {
            region: region.clone(),
            surface_mm: cells.map(|cells| f64::from(cells) * self.cell_m * 1e3),
        })?;
        Ok(Part { cells })
    }

    /// The cells of a tile outside a part or in a well, whose paint is always fresh from the tube; `None` if the whole
    /// tile is outside.
    pub(crate) fn staying(&self, part: &Part, id: TileId) -> Option<Vec<usize>> {
        let side = TILE as u32;
        let [from, to] = part.cells;
        let corner = [id.x * side, id.y * side];
        if (0..2).any(|i| corner[i] + side <= from[i] || to[i] <= corner[i]) {
            return None;
        }
        let mut stays: Vec<usize> = self.bare.cells_in_wells(id).collect();
        let cells = self.store.cells();
        // Nothing is beyond the surface's edge.
        let holds = |i: usize| from[i] <= corner[i] && (corner[i] + side).min(cells[i]) <= to[i];
        if !(holds(0) && holds(1)) {
            let within = |i: usize, at: u32| (from[i]..to[i]).contains(&(corner[i] + at));
            let beside = |cell: &usize| {
                let at = [(cell % TILE) as u32, (cell / TILE) as u32];
                !(within(0, at[0]) && within(1, at[1]))
            };
            stays.extend((0..TILE_CELLS).filter(beside));
        }
        Some(stays)
    }

    /// For each cell of a tile, true if it is in a part and in no well; `None` if the whole tile is outside.
    pub(super) fn within(&self, part: &Part, id: TileId) -> Option<Vec<bool>> {
        let mut within = vec![true; TILE_CELLS];
        for cell in self.staying(part, id)? {
            within[cell] = false;
        }
        Some(within)
    }

    /// Its tiles with wet paint.
    pub(crate) fn wet_tiles(&self) -> impl Iterator<Item = (TileId, &Arc<Tile>)> {
        self.wet_tiles_from(0)
    }

    /// Its tiles with wet paint, from the one with a number on, row by row from the bottom.
    pub(crate) fn wet_tiles_from(&self, first: u32) -> impl Iterator<Item = (TileId, &Arc<Tile>)> {
        let tiles = self.store.iter().skip(first as usize);
        tiles.filter_map(|(id, version)| {
            let tile = version.tile.as_ref()?;
            tile.wet_page().is_some().then_some((id, tile))
        })
    }

    /// True if any paint of a part is wet.
    pub(crate) fn is_wet(&self, part: &Part) -> bool {
        self.wet_tiles().any(|(id, tile)| {
            let within = self.within(part, id);
            within.is_some_and(|within| holds_paint(&tile.wet(), &within))
        })
    }

    /// The tiles of a part after the lower `share` of their wet paint has dried into the layer `number`.
    pub(crate) fn dried(&self, part: &Part, number: u32, share: f32) -> Changed {
        let tiles = self.wet_tiles();
        let dried = tiles.filter_map(|(id, tile)| {
            let tile = self.dried_tile(tile, (number, share), &self.staying(part, id)?)?;
            Some((id, Arc::new(tile)))
        });
        dried.collect()
    }

    /// As [`dried`](Self::dried), `most` tiles from the one with number `first` on, and which is next.
    pub(crate) fn some_dried(
        &self,
        part: &Part,
        (number, share): (u32, f32),
        most: usize,
        first: u32,
    ) -> (Changed, Option<u32>) {
        let mut dried = Vec::new();
        let mut seen = 0;
        for (id, tile) in self.wet_tiles_from(first) {
            let Some(stays) = self.staying(part, id) else {
                continue;
            };
            if seen == most {
                return (dried, Some(id.y * self.store.grid()[0] + id.x));
            }
            seen += 1;
            if let Some(tile) = self.dried_tile(tile, (number, share), &stays) {
                dried.push((id, Arc::new(tile)));
            }
        }
        (dried, None)
    }

    /// Its tiles without their wet paint, but for that of the cells that `stay` of a tile has (a tile without stays
    /// whole).
    pub(crate) fn scraped(&self, stay: impl Fn(TileId) -> Option<Vec<usize>>) -> Changed {
        let scraped = self.wet_tiles().filter_map(|(id, tile)| {
            let tile = tile.scraped(&stay(id)?)?;
            Some((id, tile.into()))
        });
        scraped.collect()
    }

    /// A tile after the lower share of its wet paint, but for the cells of `stays`, has dried into the layer of this
    /// number; none where nothing dries.
    pub(crate) fn dried_tile(
        &self,
        tile: &Tile,
        (number, share): (u32, f32),
        stays: &[usize],
    ) -> Option<Tile> {
        let dried = tile.dried(number, share, stays)?;
        Some(self.bare.shown.dried(dried))
    }

    /// The tiles of a part on which something has dried, with the cells that are of the part.
    pub(crate) fn dried_tiles(
        &self,
        part: &Part,
    ) -> impl Iterator<Item = (TileId, &Arc<Tile>, Vec<bool>)> {
        self.store.iter().filter_map(|(id, version)| {
            let tile = version.tile.as_ref().filter(|tile| tile.dry().is_some())?;
            Some((id, tile, self.within(part, id)?))
        })
    }

    /// Numbers of the newest layers, `count` of them or all, that have paint in a part.
    pub(crate) fn newest_on(&self, part: &Part, count: Option<u32>) -> BTreeSet<u32> {
        let most = count.map_or(usize::MAX, |count| count as usize);
        let mut found = BTreeSet::new();
        for (_, tile, within) in self.dried_tiles(part) {
            let layers = tile.dry().into_iter().flat_map(|stack| stack.layers());
            for layer in layers {
                if found.len() == most && found.first().is_some_and(|least| layer.number < *least) {
                    break;
                }
                let planes = layer.planes.get();
                if !found.contains(&layer.number) && holds_paint(&planes, &within) {
                    found.insert(layer.number);
                    if found.len() > most {
                        found.pop_first();
                    }
                }
            }
        }
        found
    }
}
