//! A painting as a watertight mesh: its columns of ground and paint, extruded down to z = 0.
//!
//! The top is the whole surface of ground and paint, with vertices in the middles of cells; walls go down around it, and the
//! bottom is a fan around its middle. Each edge has two opposite half-edges, and all normals point outward.

use super::grid::Grid;
use super::pairing::{CUSP, ColumnPairing, WALL_CUSP};
use super::prism::{Corner, FacetSink, PlacedColumn, Point, Side, cusp, triangulate_prism};
use super::rows::{Colour, Row};
use crate::ExchangeError;

/// Receiver of the vertices and facets of a solid.
pub(crate) trait MeshSink {
    /// Adds the next vertex of the surface, with indices from 0.
    fn add_vertex(&mut self, _at: Point, _colour: Colour) {}

    /// Adds a facet of the surface, counterclockwise from outside.
    fn add_surface_facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError>;

    /// Adds a facet of a wall or the bottom, whose vertices have no indices.
    fn add_wall_facet(&mut self, corners: [Point; 3], colour: Colour) -> Result<(), ExchangeError>;

    /// Vertices of lower indices have all their facets.
    fn complete_vertices(&mut self, _end: u32) -> Result<(), ExchangeError> {
        Ok(())
    }
}

/// Conversion of lengths to the file's unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FileScale {
    /// Side of a cell.
    pub(crate) cell: f64,
    /// Height of the base's upper side, m.
    pub(crate) lowest_m: f64,
    /// Thickness of the base.
    pub(crate) base: f64,
    /// Units of a metre of height: unit and exaggeration in one.
    pub(crate) metre: f64,
}

impl FileScale {
    /// z of a height.
    pub(crate) fn z(&self, height_m: f64) -> f64 {
        self.base + (height_m - self.lowest_m) * self.metre
    }
}

/// A row of columns at its place in the file.
#[derive(Default)]
struct PlacedRow {
    row: Row,
    y: f32,
    z: Vec<Vec<f32>>,
    /// Index of the lowest vertex of each column.
    firsts: Vec<u32>,
    along: Pairings,
}

/// Pairings, with the vertex indices of their first cusps.
#[derive(Default)]
struct Pairings(Vec<(ColumnPairing, u32)>);

impl Pairings {
    fn side(&self, place: usize, is_reversed: bool) -> Side<'_> {
        let (pairing, first) = &self.0[place];
        Side {
            pairing,
            first: *first,
            reach: CUSP,
            is_reversed,
        }
    }
}

/// Builder of a solid from its highest row of columns down.
pub(crate) struct MeshBuilder<F> {
    grid: Grid,
    scale: FileScale,
    xs: Vec<f32>,
    above: PlacedRow,
    /// Index of the next vertex.
    next: u32,
    /// Receives vertices and facets.
    pub(crate) sink: F,
}

impl<F: MeshSink> MeshBuilder<F> {
    /// A mesh without any row.
    pub(crate) fn new(grid: Grid, scale: FileScale, sink: F) -> Self {
        let place = |i| (grid.at(0, i) * scale.cell) as f32;
        Self {
            grid,
            scale,
            xs: (0..=grid.spaces()[0]).map(place).collect(),
            above: PlacedRow::default(),
            next: 0,
            sink,
        }
    }

    /// Adds the next row, and the facets between it and the one above it.
    ///
    /// # Errors
    /// Those of the sink.
    pub(crate) fn add_row(&mut self, number: usize, row: Row) -> Result<(), ExchangeError> {
        let [across, up] = self.grid.spaces();
        let above = std::mem::take(&mut self.above);
        let mut own = PlacedRow {
            y: (self.grid.at(1, number) * self.scale.cell) as f32,
            z: row.columns.iter().map(|ends| self.heights(ends)).collect(),
            row,
            ..PlacedRow::default()
        };
        let (mut upright, mut slanting) = (Pairings::default(), Pairings::default());
        if number < up {
            for i in 0..=across {
                self.pair([(&own, i), (&above, i)], &mut upright);
                if i < across {
                    self.pair([(&own, i), (&above, i + 1)], &mut slanting);
                }
            }
        }
        let complete = self.next;
        for i in 0..=across {
            own.firsts.push(self.next);
            for end in 0..own.z[i].len() {
                self.add_vertex(self.column(&own, i).corner(end).at, own.row.colours.get(i));
            }
        }
        let mut level = Pairings::default();
        for i in 0..across {
            self.pair([(&own, i), (&own, i + 1)], &mut level);
        }
        own.along = level;
        if number < up {
            self.add_surface(&own, &above, [&upright, &slanting])?;
        }
        for i in 0..across {
            if number == 0 {
                self.add_wall([(&own, i), (&own, i + 1)], own.along.side(i, false))?;
            }
            if number == up {
                self.add_wall([(&own, i + 1), (&own, i)], own.along.side(i, true))?;
            }
        }
        self.sink
            .complete_vertices(if number == 0 { self.next } else { complete })?;
        self.above = own;
        Ok(())
    }

    fn heights(&self, ends: &[f32]) -> Vec<f32> {
        ends.iter()
            .map(|end| self.scale.z(f64::from(*end)) as f32)
            .collect()
    }

    fn column<'a>(&self, row: &'a PlacedRow, i: usize) -> PlacedColumn<'a> {
        PlacedColumn {
            at: [self.xs[i], row.y],
            z: &row.z[i],
            first: row.firsts.get(i).copied().unwrap_or_default(),
        }
    }

    fn add_vertex(&mut self, at: Point, colour: Option<&Colour>) {
        self.sink
            .add_vertex(at, colour.copied().unwrap_or_default());
        self.next = self.next.wrapping_add(1);
    }

    /// Pairs two columns, and adds the cusps between them as vertices.
    fn pair(&mut self, ends: [(&PlacedRow, usize); 2], into: &mut Pairings) {
        let [a, b] = ends.map(|(row, i)| &row.row.columns[i][..]);
        let (pairing, first) = (ColumnPairing::between(a, b), self.next);
        let [from, to] = ends.map(|(row, i)| self.column(row, i));
        let side = Side {
            pairing: &pairing,
            first,
            reach: CUSP,
            is_reversed: false,
        };
        for (number, cap) in pairing.caps.iter().enumerate() {
            let (row, i) = ends[usize::from(cap.is_second)];
            let corner = cusp(&side, number, [&from, &to]);
            self.add_vertex(corner.at, row.row.colours.get(i));
        }
        into.0.push((pairing, first));
    }

    /// Adds the surface between two rows, and the walls at its ends.
    fn add_surface(
        &mut self,
        own: &PlacedRow,
        above: &PlacedRow,
        [upright, slanting]: [&Pairings; 2],
    ) -> Result<(), ExchangeError> {
        let across = self.grid.spaces()[0];
        for i in 0..across {
            let [a, b] = [0, 1].map(|k| self.column(own, i + k));
            let [d, c] = [0, 1].map(|k| self.column(above, i + k));
            let mut surface = SurfaceSink {
                colour: own.row.colours.get(i).copied().unwrap_or_default(),
                next: &mut self.next,
                sink: &mut self.sink,
            };
            let right = [
                own.along.side(i, false),
                upright.side(i + 1, false),
                slanting.side(i, true),
            ];
            triangulate_prism(&[a, b, c], &right, &mut surface)?;
            let left = [
                slanting.side(i, false),
                above.along.side(i, true),
                upright.side(i, true),
            ];
            triangulate_prism(&[a, c, d], &left, &mut surface)?;
        }
        self.add_wall([(above, 0), (own, 0)], upright.side(0, true))?;
        self.add_wall(
            [(own, across), (above, across)],
            upright.side(across, false),
        )
    }

    /// Adds the wall under the surface's rim from a column to the next, counterclockwise around it, and the bottom from there
    /// to its middle.
    fn add_wall(
        &mut self,
        ends: [(&PlacedRow, usize); 2],
        along: Side<'_>,
    ) -> Result<(), ExchangeError> {
        let joined = ColumnPairing::default();
        let colour = ends[0]
            .0
            .row
            .colours
            .get(ends[0].1)
            .copied()
            .unwrap_or_default();
        let [from, to] = ends.map(|(row, i)| self.column(row, i));
        let [under_from, under_to] = [from, to].map(|column| PlacedColumn {
            z: &[0.0],
            ..column
        });
        // Outside the rim there is air down to the bottom.
        let down =
            ends.map(|(row, i)| ColumnPairing::between(&row.row.columns[i], &[f32::NEG_INFINITY]));
        let side = |pairing, is_reversed| Side {
            pairing,
            first: 0,
            reach: WALL_CUSP,
            is_reversed,
        };
        let mut wall = WallSink {
            colour,
            sink: &mut self.sink,
        };
        let first = [
            side(&down[0], false),
            side(&joined, false),
            side(&down[0], true),
        ];
        triangulate_prism(&[from, under_from, under_to], &first, &mut wall)?;
        let along = Side {
            is_reversed: !along.is_reversed,
            ..along
        };
        let second = [side(&down[0], false), side(&down[1], true), along];
        triangulate_prism(&[from, under_to, to], &second, &mut wall)?;
        let foot = |column: &PlacedColumn<'_>| [column.at[0], column.at[1], 0.0];
        let [width, height] = self.grid.spaces();
        let y = (self.grid.at(1, height) * self.scale.cell) as f32;
        let middle = [0.5 * self.xs[width], 0.5 * y, 0.0];
        self.sink
            .add_wall_facet([foot(&from), middle, foot(&to)], colour)
    }
}

/// Passes on facets of the surface, whose vertices have indices.
struct SurfaceSink<'a, F> {
    colour: Colour,
    next: &'a mut u32,
    sink: &'a mut F,
}

impl<F: MeshSink> FacetSink for SurfaceSink<'_, F> {
    const IS_WALL: bool = false;

    fn add_vertex(&mut self, at: Point) -> Corner {
        let id = *self.next;
        self.sink.add_vertex(at, self.colour);
        *self.next = id.wrapping_add(1);
        Corner { at, id }
    }

    fn add_facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError> {
        self.sink.add_surface_facet(corners)
    }
}

/// Passes on facets of walls, whose vertices have no indices.
struct WallSink<'a, F> {
    colour: Colour,
    sink: &'a mut F,
}

impl<F: MeshSink> FacetSink for WallSink<'_, F> {
    const IS_WALL: bool = true;

    fn add_vertex(&mut self, at: Point) -> Corner {
        Corner { at, id: 0 }
    }

    fn add_facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError> {
        self.sink
            .add_wall_facet(corners.map(|corner| corner.at), self.colour)
    }
}
