//! The paint of an area in voxels, from the counts of a window and back.

use maulstick_canvas::window::{Area, Window};
use maulstick_stokes::domain::Solids;
use maulstick_stokes::grid::Grid;
use maulstick_stokes::volume::Volume;

use crate::layer_planes::{place_of, shape_of, value};
use crate::layers::Layers;

/// Number of layers of air over the highest paint.
const AIR: usize = 3;

/// The paint of an area.
#[derive(Clone, Debug)]
pub struct Voxels {
    /// The cells.
    pub area: Area,
    /// Paints in use, in the order of [`slots`](Self::slots).
    pub volume: Volume,
    /// Slot of each paint.
    pub slots: Vec<usize>,
    /// Layers of the surface.
    pub(crate) layers: Layers,
    /// The surface's layer that is the grid's lowest.
    first: usize,
    /// The grid's lowest layer with room in each column.
    pub(crate) lowest: Vec<u16>,
    /// Voxel of each column in that layer.
    bottoms: Vec<usize>,
    /// Height of each column's base, cells of the grid.
    floors: Vec<f32>,
}

impl Voxels {
    /// The paint of an area of a window on which this brush's `slots` may be deposited.
    #[must_use]
    pub fn read(window: &Window, area: Area, layers: Layers, slots: &[usize]) -> Self {
        let cells: Vec<usize> = area.rows(window.width()).flatten().collect();
        let floors: Vec<f32> = cells
            .iter()
            .map(|cell| layers.floor(window, *cell))
            .collect();
        let first = floors
            .iter()
            .fold(f32::INFINITY, |least, floor| least.min(*floor)) as usize
            / layers.side
            * layers.side;
        let lowest: Vec<u16> = floors
            .iter()
            .map(|floor| (layers.lowest(*floor) - first) as u16)
            .collect();
        let columns = Columns {
            window,
            layers,
            cells: &cells,
            lowest: &lowest,
            first,
        };
        let own = columns.own(slots);
        let depth = columns.depth(&own) + AIR.max(layers.side + 1);
        let grid = Grid::walled([area.size[0], area.size[1], depth]);
        let bottom = |(column, lowest): (usize, &u16)| {
            let [x, y] = [column % area.size[0], column / area.size[0]].map(|at| at as isize);
            grid.at([x, y, *lowest as isize])
        };
        let bottoms: Vec<usize> = lowest.iter().enumerate().map(bottom).collect();
        let mut volume = Volume::new(&grid, layers.capacity, slots.len());
        columns.fill(slots, (&own, &bottoms), &mut volume);
        let floors: Vec<f32> = floors.iter().map(|floor| floor - first as f32).collect();
        let mut voxels = Self {
            area,
            volume,
            slots: slots.to_vec(),
            layers,
            first,
            lowest,
            bottoms,
            floors,
        };
        voxels.pack();
        voxels
    }

    /// The column over a cell, which is in the area, of a window of this width.
    #[must_use]
    pub fn column_of(&self, cell: usize, width: usize) -> usize {
        let [x, y] = [
            cell % width - self.area.from[0],
            cell / width - self.area.from[1],
        ];
        y * self.area.size[0] + x
    }

    /// Voxels along the side of a cell of the flow.
    #[must_use]
    pub fn side(&self) -> usize {
        self.layers.side
    }

    /// Height of a column's base, cells of the grid.
    #[must_use]
    pub fn floor_of(&self, column: usize) -> f32 {
        self.floors[column]
    }

    /// Height of the paint's base at a corner between columns, cells of the grid.
    #[must_use]
    pub fn floor_at(&self, [x, y]: [isize; 2]) -> f32 {
        let [width, height] = self.area.size.map(|cells| cells as isize);
        let columns = [[x - 1, y - 1], [x, y - 1], [x - 1, y], [x, y]];
        let floors = columns.map(|[x, y]| {
            self.floors[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize]
        });
        0.25 * ((floors[0] + floors[1]) + (floors[2] + floors[3]))
    }

    /// Base of the paint.
    #[must_use]
    pub fn solids(&self) -> Solids {
        let grid = self.volume.grid;
        let mut solids = Solids::walls(&grid);
        let plane = grid.stride(2);
        let corner = |place| {
            let [x, y, _] = grid.cell(place);
            self.floor_at([x, y])
        };
        let corners: Vec<f32> = (0..plane).map(corner).collect();
        for (layer, distances) in solids.distance.chunks_exact_mut(plane).enumerate() {
            let height = layer as f32 - 1.0;
            for (distance, corner) in distances.iter_mut().zip(&corners) {
                *distance = distance.min(height - corner);
            }
        }
        solids
    }

    /// Height of a column's surface by its amount of paint, cells of the grid.
    #[must_use]
    pub fn surface(&self, column: usize) -> f32 {
        let sum: u32 = self.column(column).map(|voxel| self.total(voxel)).sum();
        self.floors[column] + sum as f32 / self.layers.capacity as f32
    }

    /// Voxels of a column with room, from the lowest on.
    pub fn column(&self, column: usize) -> impl DoubleEndedIterator<Item = usize> + use<> {
        let (up, bottom) = (self.volume.grid.stride(2), self.bottom(column));
        let layers = self.volume.grid.cells[2] - usize::from(self.lowest[column]);
        (0..layers).map(move |layer| bottom + layer * up)
    }

    /// Voxels of a column including the open part below, which holds [sunk](Self::sink) paint.
    pub(crate) fn open_column(&self, column: usize) -> impl Iterator<Item = usize> + use<> {
        let below = self.floors[column] < f32::from(self.lowest[column]);
        let sunk = below.then(|| self.bottom(column) - self.volume.grid.stride(2));
        sunk.into_iter().chain(self.column(column))
    }

    /// Adds up each paint in a column down to `depth` quanta below its top.
    pub fn reach(&self, column: usize, depth: f32, quanta: &mut [u32]) {
        let mut left = depth;
        for voxel in self.column(column).rev() {
            let total = self.total(voxel) as f32;
            if total == 0.0 {
                continue;
            }
            let share = (left / total).min(1.0);
            for (quanta, paint) in quanta.iter_mut().zip(&self.volume.paints) {
                let all = paint[voxel];
                *quanta += if share < 1.0 {
                    (all as f32 * share) as u32
                } else {
                    all
                };
            }
            left -= total;
            if left <= 0.0 {
                return;
            }
        }
    }

    /// Removes quanta of a paint, which must be present, from the top of a column.
    pub fn take(&mut self, column: usize, paint: usize, quanta: u32) {
        let mut left = quanta;
        for voxel in self.column(column).rev() {
            let counts = &mut self.volume.paints[paint];
            let goes = counts[voxel].min(left);
            counts[voxel] -= goes;
            left -= goes;
        }
    }

    /// Place of a column's lowest voxel with room.
    #[must_use]
    pub fn bottom(&self, column: usize) -> usize {
        self.bottoms[column]
    }

    /// Highest voxel of a column that is at least half full, or its lowest: specks in the air are not its top.
    #[must_use]
    pub fn top(&self, column: usize) -> usize {
        let mut voxels = self.column(column).rev();
        let half = self.layers.capacity / 2;
        voxels
            .find(|voxel| self.total(*voxel) >= half)
            .unwrap_or_else(|| self.bottom(column))
    }

    /// Quanta of all paints in each voxel.
    #[must_use]
    pub fn totals(&self) -> Vec<u32> {
        let mut totals = vec![0; self.volume.grid.len()];
        for paint in &self.volume.paints {
            let sums = totals.iter_mut().zip(paint);
            sums.for_each(|(sum, count)| *sum += count);
        }
        totals
    }

    /// Quanta of all paints in a voxel.
    #[must_use]
    pub fn total(&self, voxel: usize) -> u32 {
        self.volume.paints.iter().map(|paint| paint[voxel]).sum()
    }

    /// Deposits paint on a column: the excess of its highest voxel goes above it.
    pub fn lay(&mut self, column: usize, paint: usize, quanta: u32) {
        let (up, mut voxel) = (self.volume.grid.stride(2), self.top(column));
        let highest = self.column(column).next_back().unwrap_or(voxel);
        let mut left = quanta;
        while left > 0 {
            let whole = if voxel == self.bottom(column) {
                self.lowest_room(column)
            } else {
                self.layers.capacity
            };
            let room = whole.saturating_sub(self.total(voxel));
            let goes = if voxel >= highest {
                left
            } else {
                left.min(room)
            };
            self.volume.paints[paint][voxel] += goes;
            left -= goes;
            voxel += up;
        }
    }

    /// Applies the changes of a window's counts, from the top of its columns.
    pub fn follow(&mut self, window: &Window) {
        let cells: Vec<usize> = self.area.rows(window.width()).flatten().collect();
        for paint in 0..self.slots.len() {
            let Some(plane) = window.plane(self.slots[paint]) else {
                continue;
            };
            for (column, cell) in cells.iter().enumerate() {
                let counts = &self.volume.paints[paint];
                let before: u32 = self.column(column).map(|voxel| counts[voxel]).sum();
                let now = plane[*cell] as u32;
                if now > before {
                    self.lay(column, paint, now - before);
                } else if now < before {
                    self.take(column, paint, before - now);
                }
            }
        }
    }

    /// Sets aside `quanta` of the lowest voxel of each column, with its mixture, and more of a film thinner than `thin`
    /// voxels, up to all of one half as thick. Returns the amounts set aside, paint by paint.
    #[must_use]
    pub fn set_aside(&mut self, quanta: f32, thin: f32) -> Vec<u32> {
        let thin = thin * self.layers.capacity as f32;
        let columns = self.area.cells();
        let mut aside = vec![0; columns * self.slots.len()];
        for column in 0..columns {
            let bottom = self.bottom(column);
            let film: u32 = self.column(column).map(|voxel| self.total(voxel)).sum();
            let quanta = quanta.max(thin - film as f32);
            let share = (quanta / self.total(bottom).max(1) as f32).min(1.0);
            for (paint, counts) in self.volume.paints.iter_mut().enumerate() {
                let stays = (counts[bottom] as f32 * share) as u32;
                counts[bottom] -= stays;
                aside[paint * columns + column] = stays;
            }
        }
        aside
    }

    /// Returns the amounts set aside.
    pub fn put_back(&mut self, aside: &[u32]) {
        let columns = self.area.cells();
        for column in 0..columns {
            let bottom = self.bottom(column);
            for (paint, counts) in self.volume.paints.iter_mut().enumerate() {
                counts[bottom] += aside[paint * columns + column];
            }
        }
    }

    /// Writes the paint back.
    pub fn write(&self, window: &mut Window) {
        let grid = self.volume.grid;
        let width = self.area.size[0];
        let starts: Vec<usize> = self
            .area
            .rows(window.width())
            .map(|row| row.start)
            .collect();
        let mut sums = vec![0; width];
        for (paint, slot) in self.slots.iter().enumerate() {
            let counts = &self.volume.paints[paint];
            let row = |y: usize, layer: usize| {
                let first = grid.at([0, y as isize, layer as isize]);
                let lowest = &self.lowest[y * width..(y + 1) * width];
                counts[first..first + width].iter().zip(lowest)
            };
            let plane = window.plane_mut(*slot);
            for (y, start) in starts.iter().enumerate() {
                sums.fill(0);
                for layer in 0..grid.cells[2] {
                    for (sum, (count, lowest)) in sums.iter_mut().zip(row(y, layer)) {
                        *sum += if layer >= usize::from(*lowest) {
                            *count
                        } else {
                            0
                        };
                    }
                }
                let cells = &mut plane[*start..start + width];
                let cells = cells.iter_mut().zip(&sums);
                cells.for_each(|(cell, sum)| *cell = *sum as f32);
            }
            for layer in 0..grid.cells[2] {
                let shape = shape_of(*slot, self.first + layer);
                let above = |(count, lowest): (&u32, &u16)| {
                    if layer > usize::from(*lowest) {
                        *count
                    } else {
                        0
                    }
                };
                let has_any = (0..starts.len()).any(|y| row(y, layer).any(|cell| above(cell) > 0));
                if !has_any && window.own(shape).is_none() {
                    continue;
                }
                let bytes = window.own_mut(shape);
                for (y, start) in starts.iter().enumerate() {
                    let (cells, _) = bytes[4 * start..4 * (start + width)].as_chunks_mut::<4>();
                    for (cell, from) in cells.iter_mut().zip(row(y, layer)) {
                        *cell = (above(from) as f32).to_le_bytes();
                    }
                }
            }
        }
    }
}

/// Columns of a window while they are read.
struct Columns<'a> {
    window: &'a Window,
    layers: Layers,
    cells: &'a [usize],
    lowest: &'a [u16],
    first: usize,
}

/// One of the model's own planes: index of the paint, layer of the grid, bytes.
type Own<'a> = (usize, usize, &'a [u8]);

impl Columns<'_> {
    /// The planes of the paints, from the lowest layer on.
    fn own(&self, slots: &[usize]) -> Vec<Own<'_>> {
        let planes = self.window.own_planes();
        let known = planes.filter_map(|(shape, bytes)| {
            let (slot, layer) = place_of(shape)?;
            let paint = slots.iter().position(|known| *known == slot)?;
            Some((paint, layer.checked_sub(self.first)?, bytes))
        });
        known.collect()
    }

    /// Layers up to the highest paint of the area.
    fn depth(&self, own: &[Own<'_>]) -> usize {
        let mut depth = 1;
        for (column, cell) in self.cells.iter().enumerate() {
            let stacked = self.window.total(*cell) / self.layers.capacity as f32;
            depth = depth.max(usize::from(self.lowest[column]) + 1 + stacked as usize);
        }
        for (_, layer, bytes) in own {
            if *layer >= depth && self.cells.iter().any(|cell| value(bytes, *cell) > 0) {
                depth = layer + 1;
            }
        }
        depth
    }

    fn fill(&self, slots: &[usize], (own, bottoms): (&[Own<'_>], &[usize]), volume: &mut Volume) {
        let grid = volume.grid;
        let width = grid.cells[0].max(1);
        for (paint, slot) in slots.iter().enumerate() {
            let counts = &mut volume.paints[paint];
            let plane = self.window.plane(*slot);
            let lies = |cell: &usize| plane.map_or(0, |plane| plane[*cell] as u32);
            let mut left: Vec<u32> = self.cells.iter().map(lies).collect();
            // From the lowest on: quanta that the counts lack were taken from the top.
            for (of, layer, bytes) in own {
                if *of != paint || *layer >= grid.cells[2] {
                    continue;
                }
                let rows = self
                    .cells
                    .chunks_exact(width)
                    .zip(self.lowest.chunks_exact(width));
                for (y, (row, left)) in rows.zip(left.chunks_exact_mut(width)).enumerate() {
                    let (cells, lowest) = row;
                    let (held, _) = bytes[4 * cells[0]..4 * (cells[0] + width)].as_chunks::<4>();
                    let first = grid.at([0, y as isize, *layer as isize]);
                    let columns = counts[first..first + width].iter_mut().zip(left);
                    for ((count, left), (held, lowest)) in columns.zip(held.iter().zip(lowest)) {
                        if *held != [0; 4] && *layer > usize::from(*lowest) {
                            *count = (f32::from_le_bytes(*held) as u32).min(*left);
                            *left -= *count;
                        }
                    }
                }
            }
            let columns = bottoms.iter().zip(left);
            columns.for_each(|(bottom, left)| counts[*bottom] = left);
        }
    }
}
