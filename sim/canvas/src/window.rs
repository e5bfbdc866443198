//! A window: leased tiles copied into contiguous planes, on which the kernels work.

mod area;

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_types::paint::TILE;

use crate::dry::DryStack;
use crate::own_plane::{OwnPlane, OwnShape};
use crate::planes::{Planes, painted};
use crate::quantum::{QUANTUM_M, SLOTS};
use crate::relief::Relief;
use crate::relief::ride::ride;
use crate::sheet;
use crate::store::{TileRect, TileStore};
use crate::tile::{Tile, TileId, Version};

pub use area::Area;

/// Planes of a rectangle of tiles, row by row from the bottom.
#[derive(Debug)]
pub struct Window {
    rect: TileRect,
    width: usize,
    height: usize,
    limit: [usize; 2],
    /// True where the surface ends: left and right, below and above.
    borders: [[bool; 2]; 2],
    wet: [Option<Vec<f32>>; SLOTS],
    /// What of it is in the upper sheet.
    upper: [Option<Vec<f32>>; SLOTS],
    /// The paint model's own planes, by their shape.
    own: BTreeMap<OwnShape, Vec<u8>>,
    base: Vec<f32>,
    ride: Vec<f32>,
    ride_below: f32,
    /// Dried paint of each tile.
    dry: Vec<Option<Arc<DryStack>>>,
    top: f32,
    dirty: Vec<bool>,
}

impl Window {
    /// Leases `rect` and copies its tiles; `None` if one is leased already. `relief` has the heights that catch paint,
    /// m.
    pub fn open(store: &mut TileStore, rect: TileRect, relief: &Relief) -> Option<Self> {
        if !store.lease(&rect) {
            return None;
        }
        let [width, height] = rect.cells();
        let tiles = rect.tiles().count();
        let surface = store.cells().map(|cells| cells as usize);
        let left = [0, 1].map(|i| surface[i] - rect.from[i] as usize * TILE);
        let limit = [0, 1].map(|i| rect.cells()[i].min(left[i]));
        let mut window = Self {
            rect,
            width,
            height,
            limit,
            borders: [0, 1].map(|i| [rect.from[i] == 0, limit[i] == left[i]]),
            wet: [const { None }; SLOTS],
            upper: [const { None }; SLOTS],
            own: BTreeMap::new(),
            base: vec![0.0; width * height],
            ride: Vec::new(),
            ride_below: relief.depth_m() as f32 * relief.cells_per_m(),
            dry: rect
                .tiles()
                .map(|id| store.version(id).tile.as_ref()?.dry().cloned())
                .collect(),
            top: 0.0,
            dirty: vec![false; tiles],
        };
        for id in rect.tiles() {
            let start = window.corner(id);
            let heights = relief.tile(id);
            for (row, heights) in heights.chunks_exact(TILE).enumerate() {
                let to = &mut window.base[start + row * width..][..TILE];
                to.iter_mut()
                    .zip(heights)
                    .for_each(|(base, m)| *base = m * relief.cells_per_m());
            }
        }
        window.lay_dry(relief.cells_per_m() * QUANTUM_M as f32);
        window.ride = ride(&window.base, width, f64::from(relief.cells_per_m()));
        for id in rect.tiles() {
            if let Some(tile) = &store.version(id).tile {
                window.read(id, &tile.wet());
            }
        }
        Some(window)
    }

    /// Copies the wet planes of a tile.
    fn read(&mut self, id: TileId, wet: &Planes) {
        let (start, width) = (self.corner(id), self.width);
        let cells = self.width * self.height;
        let new = || vec![0.0; cells];
        for (slot, plane) in wet {
            let to = self.wet[*slot].get_or_insert_with(new);
            for (row, cells) in plane.chunks_exact(TILE).enumerate() {
                to[start + row * width..][..TILE].copy_from_slice(cells);
            }
        }
        for plane in wet.own() {
            if let Some(slot) = sheet::slot_of(plane.shape) {
                let to = self.upper[slot].get_or_insert_with(new);
                for (at, quanta) in sheet::quanta(&plane.bytes).enumerate() {
                    to[start + at / TILE * width + at % TILE] = quanta;
                }
                continue;
            }
            let cell = plane.shape.cell_bytes();
            let to = self.own_mut(plane.shape);
            for (row, cells) in plane.bytes.chunks_exact(TILE * cell).enumerate() {
                to[(start + row * width) * cell..][..TILE * cell].copy_from_slice(cells);
            }
        }
    }

    /// Raises the surface that catches paint by its dried paint.
    fn lay_dry(&mut self, cells_per_quantum: f32) {
        for (place, id) in self.rect.tiles().enumerate() {
            let Some(stack) = self.dry[place].clone() else {
                continue;
            };
            let start = self.corner(id);
            for (row, dry) in stack.height().chunks_exact(TILE).enumerate() {
                let to = &mut self.base[start + row * self.width..][..TILE];
                for (base, quanta) in to.iter_mut().zip(dry) {
                    *base += quanta * cells_per_quantum;
                }
            }
        }
    }

    /// Columns and rows on the surface, from the lower left corner.
    #[must_use]
    pub fn limit(&self) -> [usize; 2] {
        self.limit
    }

    /// True where the surface ends with it, or in it: left and right, below and above.
    #[must_use]
    pub fn borders(&self) -> [[bool; 2]; 2] {
        self.borders
    }

    /// Height of the surface that catches paint, tooth and dry relief, cells; at most 0 where nothing is dry.
    #[must_use]
    pub fn base(&self) -> &[f32] {
        &self.base
    }

    /// Height of a pressed bristle on the relief ([`ride`]), cells.
    #[must_use]
    pub fn ride(&self) -> &[f32] {
        &self.ride
    }

    /// Lowest ride anywhere on the surface, cells below 0, so that a step is independent of its window.
    #[must_use]
    pub fn ride_below(&self) -> f32 {
        self.ride_below
    }

    /// The greatest height at which brushes have met paint in the window, wet on dry, quanta.
    #[must_use]
    pub fn top(&self) -> f32 {
        self.top
    }

    /// Records a height of paint, quanta.
    pub fn note_top(&mut self, quanta: f32) {
        self.top = self.top.max(quanta);
    }

    /// The tiles.
    #[must_use]
    pub fn rect(&self) -> TileRect {
        self.rect
    }

    /// Cells across.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Cells up.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The surface's cell at the window's lower left corner.
    #[must_use]
    pub fn origin(&self) -> [i64; 2] {
        self.rect.from.map(|tile| i64::from(tile) * TILE as i64)
    }

    /// The plane of a slot, created if absent.
    pub fn plane_mut(&mut self, slot: usize) -> &mut Vec<f32> {
        let cells = self.width * self.height;
        self.wet[slot].get_or_insert_with(|| vec![0.0; cells])
    }

    /// The plane of a slot, if it is in use.
    #[must_use]
    pub fn plane(&self, slot: usize) -> Option<&[f32]> {
        self.wet[slot].as_deref()
    }

    /// Bytes of one of the paint model's own planes, cell by cell; zeros if it is new.
    pub fn own_mut(&mut self, shape: OwnShape) -> &mut Vec<u8> {
        let bytes = self.width * self.height * shape.cell_bytes();
        self.own.entry(shape).or_insert_with(|| vec![0; bytes])
    }

    /// Bytes of one of the paint model's own planes, if it is in use.
    #[must_use]
    pub fn own(&self, shape: OwnShape) -> Option<&[u8]> {
        self.own.get(&shape).map(Vec::as_slice)
    }

    /// The paint model's own planes, in order of their shapes.
    pub fn own_planes(&self) -> impl Iterator<Item = (OwnShape, &[u8])> {
        self.own.iter().map(|(shape, bytes)| (*shape, &bytes[..]))
    }

    /// The planes in use, in order of slot.
    pub fn planes(&self) -> impl Iterator<Item = (usize, &[f32])> {
        self.wet
            .iter()
            .enumerate()
            .filter_map(|(slot, plane)| Some((slot, plane.as_deref()?)))
    }

    /// The planes in use, in order of slot, for writing.
    pub fn planes_mut(&mut self) -> impl Iterator<Item = (usize, &mut Vec<f32>)> {
        self.wet
            .iter_mut()
            .enumerate()
            .filter_map(|(slot, plane)| Some((slot, plane.as_mut()?)))
    }

    /// Heights of [`base`](Self::base) and [`ride`](Self::ride), and the planes in use, in order of slot.
    pub fn ground_and_planes_mut(
        &mut self,
    ) -> ([&[f32]; 2], impl Iterator<Item = (usize, &mut Vec<f32>)>) {
        let planes = self.wet.iter_mut().enumerate();
        let planes = planes.filter_map(|(slot, plane)| Some((slot, plane.as_mut()?)));
        ([&self.base[..], &self.ride[..]], planes)
    }

    /// The planes in use, of all paint and of the upper sheet, split into at most `count` parts of nearly equal size.
    pub fn planes_in_parts(&mut self, count: usize) -> Vec<Vec<&mut Vec<f32>>> {
        let mut parts = Vec::new();
        for (place, plane) in (self.wet.iter_mut().chain(&mut self.upper).flatten()).enumerate() {
            if place < count {
                parts.push(Vec::new());
            }
            parts[place % count].push(plane);
        }
        parts
    }

    /// Counts of all paints in a cell.
    #[must_use]
    pub fn total(&self, cell: usize) -> f32 {
        self.wet.iter().flatten().map(|plane| plane[cell]).sum()
    }

    /// The cells `from`..`to` of the surface, clipped to the window and the surface.
    #[must_use]
    pub fn area(&self, from: [i64; 2], to: [i64; 2]) -> Area {
        let origin = self.origin();
        let inside =
            |value: i64, i: usize| (value - origin[i]).clamp(0, self.limit[i] as i64) as usize;
        let from = [0, 1].map(|i| inside(from[i], i));
        Area {
            from,
            size: [0, 1].map(|i| inside(to[i], i).saturating_sub(from[i])),
        }
    }

    /// Wet quanta of all paints on each cell of an area, row after row.
    pub fn weigh(&self, area: &Area, totals: &mut [f32]) {
        totals.fill(0.0);
        for plane in self.wet.iter().flatten() {
            let sums = totals.chunks_exact_mut(area.size[0].max(1));
            for (sums, row) in sums.zip(area.rows(self.width)) {
                let counts = sums.iter_mut().zip(&plane[row]);
                counts.for_each(|(sum, count)| *sum += count);
            }
        }
    }

    /// Wet quanta of all paints on each of these cells.
    pub fn totals(&self, cells: &[u32], totals: &mut Vec<f32>) {
        totals.clear();
        totals.resize(cells.len(), 0.0);
        for plane in self.wet.iter().flatten() {
            for (total, cell) in totals.iter_mut().zip(cells) {
                *total += plane[*cell as usize];
            }
        }
    }

    /// True if there may be two sheets somewhere.
    #[must_use]
    pub fn has_sheets(&self) -> bool {
        self.upper.iter().any(Option::is_some)
    }

    /// What of a paint is in the upper sheet, if any may be.
    #[must_use]
    pub fn upper(&self, slot: usize) -> Option<&[f32]> {
        self.upper[slot].as_deref()
    }

    /// The plane of a slot, and what of it is in the upper sheet; created if absent.
    pub fn sheets_mut(&mut self, slot: usize) -> [&mut Vec<f32>; 2] {
        let cells = self.width * self.height;
        [&mut self.wet[slot], &mut self.upper[slot]]
            .map(|plane| plane.get_or_insert_with(|| vec![0.0; cells]))
    }

    /// True if the window may contain any of a paint.
    #[must_use]
    pub fn has(&self, slot: usize) -> bool {
        self.wet[slot].is_some()
    }

    /// Marks single cells as changed.
    pub fn touch_cells(&mut self, cells: &[usize]) {
        let across = self.width / TILE;
        for cell in cells {
            self.dirty[cell / self.width / TILE * across + cell % self.width / TILE] = true;
        }
    }

    /// Marks the cells `from`..`to` of the window as changed.
    pub fn touch(&mut self, (from, to): ([usize; 2], [usize; 2])) {
        let across = self.width / TILE;
        let to = [to[0].min(self.width), to[1].min(self.height)];
        for y in from[1] / TILE..to[1].div_ceil(TILE) {
            for x in from[0] / TILE..to[0].div_ceil(TILE) {
                self.dirty[y * across + x] = true;
            }
        }
    }

    /// Writes the changed tiles back as new versions, numbered from `next` on, and reports each with the version that
    /// it replaced.
    pub fn commit(
        &mut self,
        store: &mut TileStore,
        next: &mut u64,
        mut replaced: impl FnMut(TileId, Version),
    ) {
        for (place, id) in self.rect.tiles().enumerate() {
            if !std::mem::take(&mut self.dirty[place]) {
                continue;
            }
            let start = self.corner(id);
            let cells = |plane: &Vec<f32>| {
                let mut cells = Vec::with_capacity(TILE * TILE);
                for row in 0..TILE {
                    cells.extend_from_slice(&plane[start + row * self.width..][..TILE]);
                }
                cells
            };
            let planes = self
                .wet
                .iter()
                .enumerate()
                .filter_map(|(slot, plane)| Some((slot, Arc::from(cells(plane.as_ref()?)))));
            let upper = self.upper.iter().enumerate().filter_map(|(slot, plane)| {
                Some(sheet::note(slot, cells(plane.as_ref()?).into_iter()))
            });
            let own = self.own.iter().map(|(shape, plane)| {
                let cell = shape.cell_bytes();
                let mut bytes = Vec::with_capacity(shape.tile_bytes());
                for row in 0..TILE {
                    let first = (start + row * self.width) * cell;
                    bytes.extend_from_slice(&plane[first..][..TILE * cell]);
                }
                OwnPlane {
                    shape: *shape,
                    bytes: bytes.into(),
                }
            });
            let planes = painted(planes).with_own(own.chain(upper));
            let before = store.version(id).tile.as_deref();
            let dry = self.dry[place].clone();
            let tile = Some(Arc::new(Tile::paged(store.pager(), planes, dry, before)));
            *next += 1;
            replaced(
                id,
                store.replace(
                    id,
                    Version {
                        number: *next,
                        tile,
                    },
                ),
            );
        }
    }

    /// Returns the tiles; uncommitted changes are lost.
    pub fn close(self, store: &mut TileStore) {
        store.release(&self.rect);
    }

    fn corner(&self, id: TileId) -> usize {
        let x = (id.x - self.rect.from[0]) as usize * TILE;
        let y = (id.y - self.rect.from[1]) as usize * TILE;
        y * self.width + x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::own_plane::ValueType;

    #[test]
    fn planes_of_the_models_own_are_cut_into_tiles_and_come_back() {
        let mut store = TileStore::new([200, 200]);
        let relief = Relief::flat(2.5e-4);
        let mut next = 0;
        let rect = TileRect {
            from: [0, 0],
            to: [3, 2],
        };
        let shape = OwnShape {
            kind: 5,
            values: ValueType::U16,
            per_cell: 3,
        };
        let mut window = Window::open(&mut store, rect, &relief).expect("free");
        assert_eq!(window.own(shape), None);
        let bytes = window.own_mut(shape);
        (0..bytes.len()).for_each(|i| bytes[i] = (i % 251) as u8);
        let written = bytes.clone();
        let [width, height] = rect.cells();
        window.touch(([0, 0], [width, height]));
        window.commit(&mut store, &mut next, |_, _| ());
        window.close(&mut store);
        let window = Window::open(&mut store, rect, &relief).expect("free again");
        assert_eq!(window.own(shape), Some(&written[..]));
        let part = store.version(TileId { x: 1, y: 1 }).tile.as_ref();
        let own = part.expect("stored").wet().own()[0].clone();
        let at = |x: usize, y: usize| (y * width + x) * shape.cell_bytes();
        assert_eq!(own.bytes[..6], written[at(64, 64)..][..6]);
    }

    #[test]
    fn what_is_written_through_a_window_is_read_through_another() {
        let mut store = TileStore::new([200, 200]);
        let relief = Relief::flat(2.5e-4);
        let mut next = 0;
        let rect = TileRect {
            from: [1, 0],
            to: [3, 2],
        };
        let mut window = Window::open(&mut store, rect, &relief).expect("free");
        let cell = 70 * window.width() + 65;
        window.plane_mut(3)[cell] = 5.0;
        window.touch(([65, 70], [66, 71]));
        let mut changed = Vec::new();
        window.commit(&mut store, &mut next, |id, _| changed.push(id));
        assert_eq!(changed, vec![TileId { x: 2, y: 1 }]);
        window.close(&mut store);
        assert_eq!(store.counts()[3], 5);
        let whole = TileRect {
            from: [0, 0],
            to: [4, 4],
        };
        let window = Window::open(&mut store, whole, &relief).expect("free again");
        let (slot, plane) = window.planes().next().expect("one plane");
        assert_eq!((slot, plane[70 * window.width() + 64 + 65]), (3, 5.0));
        assert_eq!(store.version(TileId { x: 2, y: 1 }).number, next);
        assert!(
            Window::open(&mut store, whole, &relief).is_none(),
            "leases are exclusive"
        );
    }
}
