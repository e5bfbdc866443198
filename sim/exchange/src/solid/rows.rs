//! The columns at the vertices of a grid, row after row from the highest.

use maulstick_appearance::Bakery;
use maulstick_appearance::bands::{Banded, in_order};

use super::columns::Columns;
use super::grid::Grid;
use crate::ExchangeError;
use crate::surface::Steps;

/// Linear red, green, blue.
pub(crate) type Colour = [f32; 3];

/// A row of vertices from rim to rim.
#[derive(Clone, Debug, Default)]
pub(crate) struct Row {
    /// Ends of each column, m, for [`ColumnPairing`](super::pairing::ColumnPairing).
    pub(crate) columns: Vec<Vec<f32>>,
    /// Unlit colours seen from above; empty if not requested.
    pub(crate) colours: Vec<Colour>,
}

/// A row of blocks, from the rows of cells so far.
#[derive(Clone, Debug)]
struct Blocks {
    columns: Vec<Vec<f32>>,
    colours: Vec<Colour>,
    /// Cells whose colours are in the sum of each block.
    cells: Vec<f32>,
}

fn top(ends: &[f32]) -> f32 {
    ends.last().copied().unwrap_or(f32::NEG_INFINITY)
}

impl Blocks {
    fn new(count: usize) -> Self {
        Self {
            columns: vec![Vec::new(); count],
            colours: vec![[0.0; 3]; count],
            cells: vec![0.0; count],
        }
    }

    /// Keeps the higher of the column of a block and this one.
    fn keep_highest(&mut self, block: usize, ends: &[f32]) {
        let kept = &mut self.columns[block];
        if top(ends) > top(kept) {
            kept.clear();
            kept.extend_from_slice(ends);
        }
    }

    fn add_colour(&mut self, block: usize, colour: Colour, cells: f32) {
        let sums = self.colours[block].iter_mut().zip(colour);
        sums.for_each(|(sum, channel)| *sum += channel);
        self.cells[block] += cells;
    }

    fn merge(&mut self, row: &Self) {
        for block in 0..self.columns.len() {
            self.keep_highest(block, &row.columns[block]);
            self.add_colour(block, row.colours[block], row.cells[block]);
        }
    }

    /// The row of vertices, with those on the surface's rim.
    fn row(&self) -> Row {
        let mean = self.colours.iter().zip(&self.cells);
        let colours: Vec<Colour> = mean
            .map(|(sum, cells)| sum.map(|channel| channel / cells.max(1.0)))
            .collect();
        Row {
            columns: with_edges(&self.columns),
            colours: with_edges(&colours),
        }
    }
}

fn with_edges<T: Clone>(row: &[T]) -> Vec<T> {
    [&row[..1], row, &row[row.len() - 1..]].concat()
}

/// Settings of the rows of a solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowSetup {
    pub(crate) grid: Grid,
    /// Thickness below which pieces and gaps are left out, m.
    pub(crate) thin_m: f64,
    /// True for rows with colours.
    pub(crate) is_coloured: bool,
}

/// Calls `each` with the rows of vertices and their numbers, from the highest.
pub(crate) fn rows(
    banded: &Banded<'_>,
    setup: RowSetup,
    steps: &mut Steps<'_>,
    mut each: impl FnMut(usize, Row) -> Result<(), ExchangeError>,
) -> Result<(), ExchangeError> {
    let RowSetup {
        grid,
        thin_m,
        is_coloured,
    } = setup;
    let (width, step) = (grid.width(), grid.step());
    let blocks = width.div_ceil(step);
    let job = |band: usize| -> Vec<(usize, Blocks)> {
        let columns = Columns::of(banded, band, thin_m);
        let colours = if is_coloured {
            colours(banded, band)
        } else {
            Default::default()
        };
        let rows = banded.rows(band).enumerate().rev();
        rows.map(|(row, y)| {
            let mut own = Blocks::new(blocks);
            for x in 0..width {
                let cell = row * width + x;
                own.keep_highest(x / step, columns.ends(cell));
                if is_coloured {
                    own.add_colour(x / step, colours.each_ref().map(|plane| plane[cell]), 1.0);
                }
            }
            (y, own)
        })
        .collect()
    };
    let up = grid.spaces()[1];
    let mut sum = Blocks::new(blocks);
    in_order(banded.bands(), job, |_, rows| {
        for (y, row) in rows {
            sum.merge(&row);
            if y % step > 0 {
                continue;
            }
            let row = sum.row();
            sum = Blocks::new(blocks);
            let vertex = y / step + 1;
            if vertex + 1 == up {
                each(up, row.clone())?;
            }
            if vertex > 1 {
                each(vertex, row)?;
            } else {
                each(vertex, row.clone())?;
                each(0, row)?;
            }
        }
        steps.step();
        Ok(())
    })
}

/// Unlit colours of a band, row after row from its lowest.
fn colours(banded: &Banded<'_>, band: usize) -> [Vec<f32>; 3] {
    let cells = banded.rows(band).len() * banded.cells()[0];
    let mut planes = [const { Vec::new() }; 3];
    planes.iter_mut().for_each(|plane| plane.resize(cells, 0.0));
    let mut bakery = Bakery::default();
    for (id, tile) in banded.tiles(band) {
        let shown = banded.shown(id, tile, &mut bakery);
        for (plane, own) in planes.iter_mut().zip(&shown.rgb) {
            banded.spread(id, own, plane);
        }
    }
    planes
}
