//! Layout of a window's fields in the device's memory, with the same numbers as `common/window.wgsl`.

use bytemuck::{Pod, Zeroable};
use maulstick_stokes::grid::{Ends, Grid, Side};

use maulstick_gpu::device::GpuError;

/// Greatest number of levels of a hierarchy.
pub(crate) const MOST_LEVELS: usize = 12;
/// Number of fields of the finest grid before the directions.
pub(crate) const DIRECTIONS: u32 = 56;
/// Greatest number of directions, and of their stored squares and answers.
pub(crate) const MOST_DIRECTIONS: usize = 24;
/// Number of fields of a component on the finest level and on the others.
const OF_COMPONENT: [u64; 2] = [9, 11];
/// Greatest number of parts of a step of transport.
const MOST_PARTS: usize = 40;
/// Number of values summed by a workgroup.
pub(crate) const SUMMED: u32 = 2048;
/// Number of rows of partial sums, and of scalars.
const ROWS: u64 = 32;
const SCALARS: u64 = 768;
/// Greatest number of cells along an axis of the coarsest grid, if it can be halved down to that.
const COARSEST_CELLS: usize = 4;

/// `Level` of window.wgsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Level {
    cells: [u32; 3],
    pub(crate) len: u32,
    halved: [u32; 3],
    base: u32,
}

/// Paint transported in a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paints {
    /// Number of paints.
    pub count: usize,
    /// Quanta that fill a cell; below 2²².
    pub capacity: u32,
    /// Number of parts of a step; in each, paint moves by at most half a cell.
    pub parts: usize,
}

impl Default for Paints {
    fn default() -> Self {
        Self {
            count: 0,
            capacity: 1,
            parts: 1,
        }
    }
}

/// Layout of a window.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) grid: Grid,
    pub(crate) levels: Vec<Level>,
    /// First level of those that one workgroup does together.
    pub(crate) rest: usize,
    /// Number of directions that fit.
    pub(crate) memory: usize,
    pub(crate) paints: Paints,
    pub(crate) partials: u32,
    pub(crate) scalars: u32,
    /// Size of all fields, words.
    pub(crate) words: u64,
}

/// A grid half as fine along each axis that can be halved, and a mask of those axes.
fn halved(grid: &Grid) -> (Grid, [u32; 3]) {
    let can = [0, 1, 2].map(|axis| {
        let cells = grid.cells[axis];
        cells > 1 && (cells.is_multiple_of(2) || !grid.is_periodic(axis))
    });
    let mut coarse = *grid;
    for axis in (0..3).filter(|axis| can[*axis]) {
        coarse.cells[axis] = grid.cells[axis].div_ceil(2);
    }
    (coarse, can.map(u32::from))
}

/// Conditions of the lower and the upper sides, by window.wgsl's numbers.
pub(crate) fn sides(grid: &Grid) -> [[u32; 3]; 2] {
    let number = |side: Side| match side {
        Side::NoSlip => 0,
        Side::Slip => 1,
    };
    [0, 1].map(|end| {
        grid.ends.map(|ends| match ends {
            Ends::Periodic => 2,
            Ends::Sides(sides) => number(sides[end]),
        })
    })
}

/// Levels of a window, whose words are added; `None` where they are too many.
fn levels(finest: &Grid, words: &mut u64) -> Option<Vec<Level>> {
    let mut levels = Vec::new();
    let mut next = Some(*finest);
    while let Some(grid) = next {
        let (coarse, can) = halved(&grid);
        let is_coarsest = levels.len() + 1 == MOST_LEVELS
            || grid.cells.iter().all(|cells| *cells <= COARSEST_CELLS)
            || can == [0; 3];
        levels.push(Level {
            cells: grid.cells.map(|cells| cells as u32),
            len: grid.len() as u32,
            halved: if is_coarsest { [0; 3] } else { can },
            base: *words as u32,
        });
        *words += 4 * OF_COMPONENT[usize::from(levels.len() > 1)] * grid.len() as u64;
        if *words > u64::from(u32::MAX) {
            return None;
        }
        next = (!is_coarsest).then_some(coarse);
    }
    Some(levels)
}

impl Plan {
    /// The layout for `memory` directions; one workgroup does all levels of at most `rest` cells.
    ///
    /// # Errors
    /// [`GpuError::Window`] for a window without cells or beyond the range of the shaders' indices.
    pub(crate) fn new(
        grid: &Grid,
        memory: usize,
        rest: u32,
        paints: Paints,
    ) -> Result<Self, GpuError> {
        let too_large = |words: u64| GpuError::Window {
            cells: grid.cells,
            needs: words.saturating_mul(4),
            most: 4 * u64::from(u32::MAX),
        };
        let numbers = grid.cells.iter().map(|cells| *cells as u64 + 3);
        let len = numbers.fold(1u64, u64::saturating_mul);
        let paints = Paints {
            parts: paints.parts.clamp(1, MOST_PARTS),
            ..paints
        };
        // Fields of directions also hold counts.
        let memory = memory
            .max(paints.count.div_ceil(8))
            .clamp(1, MOST_DIRECTIONS);
        let mut words =
            len.saturating_mul(u64::from(DIRECTIONS) + 8 * memory as u64 + 1 + paints.count as u64);
        if grid.is_empty() || words > u64::from(u32::MAX) {
            return Err(too_large(words));
        }
        let Some(levels) = levels(grid, &mut words) else {
            return Err(too_large(words));
        };
        let partials = words;
        let mut plan = Self {
            grid: *grid,
            levels,
            rest: 0,
            memory,
            paints,
            partials: partials as u32,
            scalars: 0,
            words,
        };
        let groups = (4 * plan.inner(0)).div_ceil(SUMMED);
        let columns = (grid.cells[0] * grid.cells[1]) as u32;
        let groups = groups.max(columns.div_ceil(SUMMED));
        let scalars = partials + ROWS * u64::from(groups);
        plan.words = scalars + SCALARS;
        if plan.words > u64::from(u32::MAX) {
            return Err(too_large(plan.words));
        }
        plan.scalars = scalars as u32;
        let last = plan.levels.len() - 1;
        plan.rest = (0..last)
            .find(|level| plan.inner(*level) <= rest)
            .unwrap_or(last);
        Ok(plan)
    }

    /// Size of the window, bytes.
    pub(crate) const fn bytes(&self) -> u64 {
        4 * self.words
    }

    /// Checks that the window has at most `most` bytes.
    ///
    /// # Errors
    /// [`GpuError::Window`].
    pub(crate) const fn check(&self, most: u64) -> Result<(), GpuError> {
        if self.bytes() <= most {
            return Ok(());
        }
        Err(GpuError::Window {
            cells: self.grid.cells,
            needs: self.bytes(),
            most,
        })
    }

    /// Number of invocations of most stages on a level: its cells, and the copies beyond periodic sides.
    pub(crate) fn inner(&self, level: usize) -> u32 {
        let beyond = [0, 1, 2].map(|axis| if self.grid.is_periodic(axis) { 3 } else { 0 });
        let cells = self.levels[level].cells;
        (0..3).map(|axis| cells[axis] + beyond[axis]).product()
    }

    /// Number of the field of a paint's counts.
    pub(crate) const fn paint(&self, paint: usize) -> u32 {
        DIRECTIONS + 8 * self.memory as u32 + 1 + paint as u32
    }

    /// Offset of a field of the finest grid.
    pub(crate) fn field(&self, number: u32) -> u32 {
        number * self.levels[0].len
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_is_laid_out_as_far_as_indices_reach() {
        let plan =
            Plan::new(&Grid::walled([32, 32, 16]), 8, 2048, Paints::default()).expect("laid out");
        let cells: Vec<_> = plan.levels.iter().map(|level| level.cells).collect();
        assert_eq!(cells, [[32, 32, 16], [16, 16, 8], [8, 8, 4], [4, 4, 2]]);
        assert_eq!(plan.rest, 1);
        for pair in plan.levels.windows(2) {
            assert!(pair[0].base + 36 * pair[0].len <= pair[1].base);
        }
        for cells in [[0, 4, 4], [4096; 3], [usize::MAX >> 8; 3]] {
            let refusal =
                Plan::new(&Grid::walled(cells), 8, 2048, Paints::default()).map(|plan| plan.words);
            assert!(matches!(refusal, Err(GpuError::Window { .. })), "{cells:?}");
        }
    }
}
