//! Staggered (MAC) grid: pressure and paint in the middle of a cell, velocities on its faces, shear on its edges (Harlow
//! and Welch 1965).
//!
//! Every field has the same layout, x fastest, with one more layer below and two above: index [`Grid::at`]`(i, j, k)`
//! is cell (i, j, k), its lower face of an axis, its lower edge and its lower corner. So one flat loop with three
//! strides serves all of them, and values beyond the grid need no special case.

/// Condition at a side of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// A wall that paint sticks to.
    NoSlip,
    /// A plane of symmetry: without flow through it and without shear.
    Slip,
}

/// Both sides of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// Periodic: the last cell is beside the first.
    Periodic,
    /// Lower and upper side.
    Sides([Side; 2]),
}

/// Number of layers beyond the cells of an axis.
const MARGIN_LAYERS: usize = 3;

/// Cells of a window and its sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Number of cells along each axis.
    pub cells: [usize; 3],
    /// Sides of each axis.
    pub ends: [Ends; 3],
}

impl Grid {
    /// A grid of `cells` between no-slip walls.
    #[must_use]
    pub const fn walled(cells: [usize; 3]) -> Self {
        let ends = [Ends::Sides([Side::NoSlip; 2]); 3];
        Self { cells, ends }
    }

    /// Index offset from one cell to the next of an axis.
    #[must_use]
    pub const fn stride(&self, axis: usize) -> usize {
        match axis {
            0 => 1,
            1 => self.cells[0] + MARGIN_LAYERS,
            _ => (self.cells[0] + MARGIN_LAYERS) * (self.cells[1] + MARGIN_LAYERS),
        }
    }

    /// Length of a field.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.stride(2) * (self.cells[2] + MARGIN_LAYERS)
    }

    /// True if it has no cells.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cells.contains(&0)
    }

    /// A field of zeros.
    #[must_use]
    pub fn field(&self) -> Vec<f32> {
        vec![0.0; self.len()]
    }

    /// Index of a cell, its lower faces, edges and corner; −1 is the layer below.
    #[must_use]
    pub const fn at(&self, cell: [isize; 3]) -> usize {
        let [x, y, z] = cell;
        (x + 1) as usize + (y + 1) as usize * self.stride(1) + (z + 1) as usize * self.stride(2)
    }

    /// The lowest layers, rounded up to an even number; their fields are the beginning of this grid's. Where layers are
    /// left out, nothing flows through the upper side.
    #[must_use]
    pub fn below(&self, layers: usize) -> Self {
        let layers = layers.next_multiple_of(2);
        let mut grid = *self;
        if let Ends::Sides([low, _]) = self.ends[2]
            && layers < self.cells[2]
        {
            grid.cells[2] = layers;
            grid.ends[2] = Ends::Sides([low, Side::Slip]);
        }
        grid
    }

    /// Indices of all cells, row by row.
    pub fn places(&self) -> impl Iterator<Item = usize> + use<> {
        self.block([0; 3], self.cells.map(|cells| cells as isize))
    }

    /// Indices of a half-open block of cells.
    pub fn block(&self, from: [isize; 3], to: [isize; 3]) -> impl Iterator<Item = usize> + use<> {
        let grid = *self;
        let row = move |y, z| (from[0]..to[0]).map(move |x| grid.at([x, y, z]));
        (from[2]..to[2]).flat_map(move |z| (from[1]..to[1]).flat_map(move |y| row(y, z)))
    }

    /// Cell of an index.
    #[must_use]
    pub const fn cell(&self, place: usize) -> [isize; 3] {
        let (row, plane) = (self.stride(1), self.stride(2));
        let x = place % row;
        let y = place % plane / row;
        let z = place / plane;
        [x as isize - 1, y as isize - 1, z as isize - 1]
    }

    /// True if the axis is periodic.
    #[must_use]
    pub fn is_periodic(&self, axis: usize) -> bool {
        self.ends[axis] == Ends::Periodic
    }

    /// Index range of flat loops: all cells and the faces above them; one stride before or after any of them is still
    /// in the field.
    #[must_use]
    pub const fn range(&self) -> std::ops::Range<usize> {
        let reach = self.stride(2);
        reach..self.len() - reach
    }

    /// Fills the values beyond the periodic sides from the opposite side.
    pub fn wrap<T: Copy>(&self, field: &mut [T]) {
        for axis in (0..3).filter(|axis| self.is_periodic(*axis)) {
            let cells = self.cells[axis];
            for (to, from) in [(0, cells), (cells + 1, 1), (cells + 2, 1 + 1 % cells)] {
                self.layer(axis, |start| {
                    field[start + to * self.stride(axis)] = field[start + from * self.stride(axis)];
                });
            }
        }
    }

    /// Index of the cell that an index beyond a periodic side stands for.
    #[must_use]
    pub fn wrapped(&self, place: usize) -> usize {
        let mut cell = self.cell(place);
        for axis in (0..3).filter(|axis| self.is_periodic(*axis)) {
            cell[axis] = cell[axis].rem_euclid(self.cells[axis] as isize);
        }
        self.at(cell)
    }

    /// Lower faces across an axis, each once: including the upper side unless that is the lower one.
    pub fn faces(&self, axis: usize) -> impl Iterator<Item = usize> + use<> {
        let mut to = self.cells.map(|cells| cells as isize);
        to[axis] += isize::from(!self.is_periodic(axis));
        self.block([0; 3], to)
    }

    /// Index of the cell before a face of [`faces`](Self::faces).
    #[must_use]
    pub fn before(&self, axis: usize, face: usize) -> usize {
        let before = face - self.stride(axis);
        if self.is_periodic(axis) {
            self.wrapped(before)
        } else {
            before
        }
    }

    /// Sets the values beyond the periodic sides to 0, where a flat loop has left meaningless ones.
    pub fn clear(&self, field: &mut [f32]) {
        for axis in (0..3).filter(|axis| self.is_periodic(*axis)) {
            let cells = self.cells[axis];
            for to in [0, cells + 1, cells + 2] {
                self.layer(axis, |start| field[start + to * self.stride(axis)] = 0.0);
            }
        }
    }

    /// Writes a layer across an axis, including its values beyond the sides; −1 is the layer below the first.
    pub fn fill_layer(&self, field: &mut [f32], axis: usize, layer: isize, value: f32) {
        let start = (layer + 1) as usize * self.stride(axis);
        match axis {
            0 => {
                let row = self.stride(1);
                field[start..]
                    .iter_mut()
                    .step_by(row)
                    .for_each(|each| *each = value);
            }
            1 => {
                for plane in field.chunks_mut(self.stride(2)) {
                    plane[start..start + self.stride(1)].fill(value);
                }
            }
            _ => field[start..start + self.stride(2)].fill(value),
        }
    }

    /// Sets the values beyond the cells on all sides to 0.
    pub fn clear_beyond(&self, field: &mut [f32]) {
        for axis in 0..3 {
            let cells = self.cells[axis] as isize;
            for layer in [-1, cells, cells + 1] {
                self.fill_layer(field, axis, layer, 0.0);
            }
        }
    }

    /// Calls for each index of the lowest layer across an axis.
    fn layer(&self, axis: usize, mut each: impl FnMut(usize)) {
        let [a, b] = others(axis);
        for i in 0..self.cells[b] + MARGIN_LAYERS {
            for j in 0..self.cells[a] + MARGIN_LAYERS {
                each(i * self.stride(b) + j * self.stride(a));
            }
        }
    }
}

/// The two other axes, in order.
#[must_use]
pub const fn others(axis: usize) -> [usize; 2] {
    match axis {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_one_cell() {
        let grid = Grid::walled([4, 3, 2]);
        for (number, place) in grid.places().enumerate() {
            let [x, y, z] = grid.cell(place);
            assert_eq!(grid.at([x, y, z]), place);
            assert_eq!(x + 4 * (y + 3 * z), number as isize);
            assert!(grid.range().contains(&place));
        }
    }

    #[test]
    fn what_lies_beyond_a_periodic_side_is_the_opposite_cell() {
        let ends = [Ends::Periodic, Ends::Sides([Side::Slip; 2]), Ends::Periodic];
        let cells = [4, 3, 1];
        let grid = Grid { cells, ends };
        let mut field = grid.field();
        for place in grid.places() {
            field[place] = place as f32;
        }
        grid.wrap(&mut field);
        assert_eq!(field[grid.at([-1, 1, 0])], field[grid.at([3, 1, 0])]);
        assert_eq!(field[grid.at([4, 2, 1])], field[grid.at([0, 2, 0])]);
        assert_eq!(field[grid.at([5, 2, 2])], field[grid.at([1, 2, 0])]);
        assert_eq!(field[grid.at([1, -1, 0])], 0.0);
        grid.clear(&mut field);
        assert_eq!(field[grid.at([-1, 1, 0])], 0.0);
        assert_eq!(field[grid.at([3, 1, 0])], grid.at([3, 1, 0]) as f32);
    }
}
