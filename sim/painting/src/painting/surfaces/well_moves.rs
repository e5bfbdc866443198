//! Wells that move take their wet paint along.
//!
//! Each cell gets the wet paint of at most one earlier cell, and no two get that of the same: so no quantum is created.
//! Paint without a new cell is scraped off.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec2;
use maulstick_brush::palette_place::{mirrored, size_m};
use maulstick_canvas::own_plane::{OwnPlane, OwnShape};
use maulstick_canvas::page::Pager;
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::store::TileStore;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::paint::TILE;
use maulstick_types::scene::{Surface, Well};

use super::{Changed, SurfaceState};

/// Wells nearer to each other than this are at the same place, m.
const SAME_M: f64 = 1e-9;
/// Number of cells by which a heap may exceed its well's edge, because its path is rounded to whole cells.
const ROUNDED: f64 = 1.0;

/// Column and row of a cell of a surface.
type Cell = [i64; 2];

/// A round part of a surface, in cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    center: DVec2,
    radius: f64,
}

impl Disc {
    fn of(well: &Well, cell_m: f64) -> Self {
        Self {
            center: DVec2::from_array(well.center_m) / cell_m,
            radius: well.radius_m / cell_m,
        }
    }

    /// True if the middle of a cell is in it, or within `beyond` of its edge.
    fn holds(&self, [x, y]: Cell, beyond: f64) -> bool {
        let middle = DVec2::new(x as f64, y as f64) + 0.5;
        let radius = self.radius + beyond;
        middle.distance_squared(self.center) < radius * radius
    }

    /// The tiles under it, grown by `ROUNDED`.
    fn tiles(&self) -> impl Iterator<Item = TileId> {
        let reach = DVec2::splat(self.radius + ROUNDED);
        let tile = |cell: f64| (cell / TILE as f64).floor().max(0.0) as u32;
        let (low, high) = (self.center - reach, self.center + reach);
        let across = tile(low.x)..=tile(high.x);
        (tile(low.y)..=tile(high.y)).flat_map(move |y| across.clone().map(move |x| TileId { x, y }))
    }
}

/// An earlier well with its new place, and its path, cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WellMove {
    from: Disc,
    to: Option<(Disc, Cell)>,
}

/// Motion of the wet paint of a surface whose wells change.
#[derive(Debug)]
pub(crate) enum WellMoves {
    /// All of it changes sides.
    Mirror {
        /// Cells across.
        across: i64,
    },
    /// Paint on wells moves with them.
    Wells {
        /// The wells of before.
        ways: Vec<WellMove>,
        /// Wells that are where none of their kind was.
        come: Vec<Disc>,
    },
}

impl WellMoves {
    /// The moves from the wells of `before` to those of `now` on a surface. A well is matched with the nearest earlier
    /// one with the same function.
    pub(crate) fn between((before, now): (&[Well], &[Well]), surface: &Surface) -> Self {
        let cell_m = surface.cell_m;
        let far = |one: &Well, other: &Well| {
            DVec2::from_array(one.center_m).distance(DVec2::from_array(other.center_m))
        };
        let is_same = |(one, other): (&Well, &Well)| {
            let rounding = far(one, other).max((one.radius_m - other.radius_m).abs());
            one.kind == other.kind && rounding < SAME_M
        };
        let other_side = mirrored(before, size_m(surface));
        if now.len() == before.len() && now.iter().zip(&other_side).all(is_same) {
            return Self::Mirror {
                across: i64::from(surface.cells[0]),
            };
        }
        let mut ways: Vec<WellMove> = before
            .iter()
            .map(|well| WellMove {
                from: Disc::of(well, cell_m),
                to: None,
            })
            .collect();
        // Unmoved ones are matched first, because a twin could take their place.
        let mut found: Vec<Option<usize>> = vec![None; now.len()];
        for (own, well) in found.iter_mut().zip(now) {
            *own = (0..before.len())
                .find(|at| is_same((&before[*at], well)) && ways[*at].to.is_none());
            if let Some(at) = *own {
                ways[at].to = Some((ways[at].from, [0, 0]));
            }
        }
        let mut come = Vec::new();
        for (own, well) in found.iter().zip(now) {
            if own.is_some() {
                continue;
            }
            let disc = Disc::of(well, cell_m);
            come.push(disc);
            let free = (0..before.len())
                .filter(|at| ways[*at].to.is_none() && before[*at].kind == well.kind);
            let nearest =
                free.min_by(|a, b| far(&before[*a], well).total_cmp(&far(&before[*b], well)));
            if let Some(at) = nearest {
                let way = (disc.center - ways[at].from.center).round();
                ways[at].to = Some((disc, [way.x as i64, way.y as i64]));
            }
        }
        Self::Wells { ways, come }
    }

    /// The tiles whose wet paint may change: of `wet` ones, those they lead to and those on which wells come.
    fn tiles(&self, wet: &BTreeSet<TileId>, grid: [u32; 2]) -> BTreeSet<TileId> {
        let tiles: BTreeSet<TileId> = match self {
            Self::Mirror { across } => {
                let mirrored = |id: &TileId| {
                    let y = id.y;
                    let first = i64::from(id.x) * TILE as i64;
                    let last = first + TILE as i64 - 1;
                    let tile = |x: i64| ((across - 1 - x).max(0) / TILE as i64) as u32;
                    (tile(last)..=tile(first)).map(move |x| TileId { x, y })
                };
                wet.iter()
                    .flat_map(mirrored)
                    .chain(wet.iter().copied())
                    .collect()
            }
            Self::Wells { ways, come } => {
                let moves = |way: &&WellMove| {
                    let other =
                        |(to, by): (Disc, [i64; 2])| by != [0, 0] || to.radius != way.from.radius;
                    way.to.is_none_or(other)
                };
                let from = ways.iter().filter(moves).map(|way| way.from);
                from.chain(come.iter().copied())
                    .flat_map(|disc| disc.tiles().collect::<Vec<_>>())
                    .collect()
            }
        };
        let within = |id: &TileId| id.x < grid[0] && id.y < grid[1];
        tiles.into_iter().filter(within).collect()
    }

    /// The cell of before whose wet paint a cell gets, if any.
    fn source(&self, cell: Cell) -> Option<Cell> {
        let (ways, come) = match self {
            Self::Mirror { across } => return Some([across - 1 - cell[0], cell[1]]),
            Self::Wells { ways, come } => (ways, come),
        };
        // Where wells overlap, the first one has the paint.
        let owner = |cell: Cell| ways.iter().position(|way| way.from.holds(cell, 0.0));
        let brought = ways.iter().enumerate().find_map(|(own, way)| {
            let (to, by) = way.to?;
            let from = [cell[0] - by[0], cell[1] - by[1]];
            (to.holds(cell, ROUNDED) && owner(from) == Some(own)).then_some(from)
        });
        let stays = || {
            let is_free = !come.iter().any(|disc| disc.holds(cell, 0.0));
            (is_free && owner(cell).is_none()).then_some(cell)
        };
        brought.or_else(stays)
    }
}

/// The cells of a tile, in order.
fn cells_of(id: TileId) -> impl Iterator<Item = Cell> {
    let corner = [id.x, id.y].map(|tile| i64::from(tile) * TILE as i64);
    (0..TILE_CELLS).map(move |at| {
        [
            corner[0] + (at % TILE) as i64,
            corner[1] + (at / TILE) as i64,
        ]
    })
}

/// The tile of a cell of a surface with `cells`, and the cell's index in it.
fn place([x, y]: Cell, cells: [u32; 2]) -> Option<(TileId, usize)> {
    let (x, y) = (u32::try_from(x).ok()?, u32::try_from(y).ok()?);
    let side = TILE as u32;
    let tile = TileId {
        x: x / side,
        y: y / side,
    };
    let at = (y % side) as usize * TILE + (x % side) as usize;
    (x < cells[0] && y < cells[1]).then_some((tile, at))
}

/// The wet planes of the tiles of before.
struct Before(BTreeMap<TileId, Arc<Planes>>);

impl Before {
    fn of(store: &TileStore) -> Self {
        let wet = store.iter().filter_map(|(id, version)| {
            let tile = version.tile.as_ref()?;
            tile.wet_page().is_some().then(|| (id, tile.wet()))
        });
        Self(wet.collect())
    }

    /// Planes with the values of these earlier cells; a cell without one is empty.
    fn gathered(&self, from: &[Option<(TileId, usize)>]) -> Planes {
        let mut counts: BTreeMap<usize, Vec<f32>> = BTreeMap::new();
        let mut own: BTreeMap<OwnShape, Vec<u8>> = BTreeMap::new();
        let sources: BTreeSet<TileId> = from.iter().flatten().map(|(id, _)| *id).collect();
        let wet = sources.iter().filter_map(|id| Some((id, self.0.get(id)?)));
        for (id, planes) in wet {
            let cells = || {
                let cells = from.iter().enumerate();
                cells.filter_map(|(to, from)| from.filter(|from| from.0 == *id).map(|f| (to, f.1)))
            };
            for (slot, plane) in planes.iter() {
                let into = counts.entry(*slot).or_insert_with(|| vec![0.0; TILE_CELLS]);
                cells().for_each(|(to, from)| into[to] = plane[from]);
            }
            for plane in planes.own() {
                let width = plane.shape.cell_bytes();
                let into = own
                    .entry(plane.shape)
                    .or_insert_with(|| vec![0; plane.bytes.len()]);
                for (to, from) in cells() {
                    let bytes = &plane.bytes[from * width..(from + 1) * width];
                    into[to * width..(to + 1) * width].copy_from_slice(bytes);
                }
            }
        }
        let held = |plane: &Vec<f32>| plane.iter().any(|count| *count > 0.0);
        let counts = counts.into_iter().filter(|(_, plane)| held(plane));
        let own = own.into_iter().map(|(shape, bytes)| OwnPlane {
            shape,
            bytes: bytes.into(),
        });
        let counts = counts.map(|(slot, plane)| (slot, plane.into()));
        Planes::from_iter(counts).with_own(own)
    }
}

impl SurfaceState {
    /// The tiles changed by the motion of its wells.
    pub(crate) fn with_moved_paint(&self, moves: &WellMoves, pager: &Arc<Pager>) -> Changed {
        let before = Before::of(&self.store);
        let wet: BTreeSet<TileId> = before.0.keys().copied().collect();
        if wet.is_empty() {
            return Changed::new();
        }
        let cells = self.store.cells();
        let tiles = moves.tiles(&wet, self.store.grid()).into_iter();
        let changed = tiles.filter_map(|id| {
            let from: Vec<_> = cells_of(id)
                .map(|cell| place(cell, cells).and_then(|_| place(moves.source(cell)?, cells)))
                .collect();
            let planes = before.gathered(&from);
            let is_same = match before.0.get(&id) {
                Some(held) => **held == planes,
                None => planes.is_empty(),
            };
            let own = self.store.version(id).tile.as_deref();
            let dry = own.and_then(Tile::dry).cloned();
            let tile = || Tile::paged(pager, planes, dry, own);
            (!is_same).then(|| (id, Arc::new(tile())))
        });
        changed.collect()
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::Mixture;
    use maulstick_types::scene::WellKind;

    use super::*;
    use crate::setup::{PaintingSetup, wells_of};

    fn palette() -> Surface {
        PaintingSetup::default().scene().surfaces[1].clone()
    }

    /// Sources of the cells, each at most once.
    fn sources(moves: &WellMoves, cells: [u32; 2]) -> BTreeMap<Cell, Cell> {
        let [across, up] = cells.map(i64::from);
        let mut taken = BTreeMap::new();
        for cell in (0..up).flat_map(|y| (0..across).map(move |x| [x, y])) {
            if let Some(from) = moves.source(cell) {
                assert_eq!(taken.insert(from, cell), None, "{from:?} would be doubled");
            }
        }
        taken
    }

    #[test]
    fn each_cell_of_a_heap_goes_its_wells_way_and_none_is_doubled() {
        let palette = palette();
        let mixtures: Vec<Mixture> = palette
            .wells
            .iter()
            .filter_map(|well| match &well.kind {
                WellKind::Paint { mixture } => Some(mixture.clone()),
                _ => None,
            })
            .collect();
        let mut more = mixtures.clone();
        more.insert(3, Mixture::pure("Cobalt Blue"));
        let now = wells_of(&more, palette.cells, palette.cell_m);
        let moves = WellMoves::between((&palette.wells, &now), &palette);
        let moved = sources(&moves, palette.cells);
        let cell = |well: &Well| well.center_m.map(|m| (m / palette.cell_m).floor() as i64);
        for (at, well) in palette.wells[..10].iter().enumerate() {
            let to = &now[at + usize::from(at >= 3)];
            let disc = Disc::of(well, palette.cell_m);
            let all = (-40..40).flat_map(|y| (-40..40).map(move |x| [x, y]));
            let middle = cell(well);
            let cells = all.map(|[x, y]| [middle[0] + x, middle[1] + y]);
            let on_it: Vec<Cell> = cells.filter(|cell| disc.holds(*cell, 0.0)).collect();
            assert!(on_it.len() > 3900, "{}", on_it.len());
            let gone = on_it.iter().filter(|cell| !moved.contains_key(*cell));
            assert_eq!(gone.count(), 0, "well {at} loses none");
            let [x, y] = moved[&middle];
            let [to_x, to_y] = cell(to);
            assert!((x - to_x).abs() <= 1 && (y - to_y).abs() <= 1, "{at}");
        }
    }

    #[test]
    fn mirrored_wells_mirror_all_and_a_swap_swaps() {
        let palette = palette();
        let now = mirrored(&palette.wells, size_m(&palette));
        let moves = WellMoves::between((&palette.wells, &now), &palette);
        assert!(matches!(moves, WellMoves::Mirror { across: 512 }));
        assert_eq!(sources(&moves, palette.cells).len(), 512 * 1024);
        let mut swapped = palette.wells.clone();
        (swapped[1].kind, swapped[2].kind) = (swapped[2].kind.clone(), swapped[1].kind.clone());
        let moves = WellMoves::between((&palette.wells, &swapped), &palette);
        let moved = sources(&moves, palette.cells);
        let cell = |at: usize| {
            palette.wells[at]
                .center_m
                .map(|m| (m / palette.cell_m) as i64)
        };
        assert_eq!(moved[&cell(1)][1] - cell(2)[1], 0);
        assert_eq!(moved[&cell(2)][1] - cell(1)[1], 0);
        assert_eq!(moved[&[100, 500]], [100, 500], "the rest stays");
    }
}
