//! A painting as a closed solid: what fills its columns, from their tops down to z = 0.
//!
//! The top is the whole surface of ground and paint, with vertices in the middles of cells; walls go down around it, and the
//! bottom is a fan around its middle. Each edge has two facets that run along it in opposite directions, and all look out.

use super::grid::Grid;
use super::prism::{Corner, Point, Side, Stand, Take, cusp, facets};
use super::rows::{Colour, Row};
use super::strip::{CUSP, Strip, WALL_CUSP};
use crate::ExchangeError;

/// Takes the parts of a solid, as they are made.
pub(crate) trait Facets {
    /// The next vertex of the surface, numbered from 0 on.
    fn vertex(&mut self, _at: Point, _colour: Colour) {}

    /// A facet of the surface, counterclockwise from outside.
    fn surface(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError>;

    /// A facet of walls or bottom.
    fn wall(&mut self, corners: [Point; 3], colour: Colour) -> Result<(), ExchangeError>;

    /// Vertices up to this number have all their facets.
    fn finished(&mut self, _before: u32) -> Result<(), ExchangeError> {
        Ok(())
    }
}

/// How lengths become those of the file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placing {
    /// Side of a cell.
    pub(crate) cell: f64,
    /// Height that lies on the base, m.
    pub(crate) least_m: f64,
    /// Thickness of the base.
    pub(crate) base: f64,
    /// Height of a metre.
    pub(crate) metre: f64,
}

impl Placing {
    pub(crate) fn z(&self, height_m: f64) -> f64 {
        self.base + (height_m - self.least_m) * self.metre
    }
}

/// A row of vertices, in place.
#[derive(Default)]
struct Placed {
    row: Row,
    y: f32,
    z: Vec<Vec<f32>>,
    /// Number of the lowest vertex of each column.
    firsts: Vec<u32>,
    across: Strips,
}

/// Strips, with the numbers of their first cusps.
#[derive(Default)]
struct Strips(Vec<(Strip, u32)>);

impl Strips {
    fn side(&self, place: usize, is_reversed: bool) -> Side<'_> {
        let (strip, first) = &self.0[place];
        Side {
            strip,
            first: *first,
            reach: CUSP,
            is_reversed,
        }
    }
}

/// A solid that is made from its highest row of vertices down.
pub(crate) struct Mesh<F> {
    grid: Grid,
    placing: Placing,
    xs: Vec<f32>,
    above: Placed,
    /// Number of the next vertex.
    next: u32,
    /// What takes it.
    pub(crate) to: F,
}

impl<F: Facets> Mesh<F> {
    /// Nothing of it yet.
    pub(crate) fn new(grid: Grid, placing: Placing, to: F) -> Self {
        let place = |i| (grid.at(0, i) * placing.cell) as f32;
        Self {
            grid,
            placing,
            xs: (0..=grid.spaces()[0]).map(place).collect(),
            above: Placed::default(),
            next: 0,
            to,
        }
    }

    /// The next row of vertices, with what lies between it and the one above it.
    ///
    /// # Errors
    /// Those of the taker.
    pub(crate) fn row(&mut self, number: usize, row: Row) -> Result<(), ExchangeError> {
        let [across, up] = self.grid.spaces();
        let above = std::mem::take(&mut self.above);
        let mut own = Placed {
            y: (self.grid.at(1, number) * self.placing.cell) as f32,
            z: row.columns.iter().map(|ends| self.heights(ends)).collect(),
            row,
            ..Placed::default()
        };
        let (mut upright, mut slanting) = (Strips::default(), Strips::default());
        if number < up {
            for i in 0..=across {
                self.strip([(&own, i), (&above, i)], &mut upright);
                if i < across {
                    self.strip([(&own, i), (&above, i + 1)], &mut slanting);
                }
            }
        }
        let finished = self.next;
        for i in 0..=across {
            own.firsts.push(self.next);
            for end in 0..own.z[i].len() {
                self.vertex(self.stand(&own, i).corner(end).at, own.row.colours.get(i));
            }
        }
        let mut level = Strips::default();
        for i in 0..across {
            self.strip([(&own, i), (&own, i + 1)], &mut level);
        }
        own.across = level;
        if number < up {
            self.between(&own, &above, [&upright, &slanting])?;
        }
        for i in 0..across {
            if number == 0 {
                self.wall([(&own, i), (&own, i + 1)], own.across.side(i, false))?;
            }
            if number == up {
                self.wall([(&own, i + 1), (&own, i)], own.across.side(i, true))?;
            }
        }
        self.to
            .finished(if number == 0 { self.next } else { finished })?;
        self.above = own;
        Ok(())
    }

    fn heights(&self, ends: &[f32]) -> Vec<f32> {
        ends.iter()
            .map(|end| self.placing.z(f64::from(*end)) as f32)
            .collect()
    }

    fn stand<'a>(&self, row: &'a Placed, i: usize) -> Stand<'a> {
        Stand {
            at: [self.xs[i], row.y],
            z: &row.z[i],
            first: row.firsts.get(i).copied().unwrap_or_default(),
        }
    }

    fn vertex(&mut self, at: Point, colour: Option<&Colour>) {
        self.to.vertex(at, colour.copied().unwrap_or_default());
        self.next = self.next.wrapping_add(1);
    }

    /// Adds the strip between two columns, and its cusps as vertices.
    fn strip(&mut self, ends: [(&Placed, usize); 2], into: &mut Strips) {
        let [a, b] = ends.map(|(row, i)| &row.row.columns[i][..]);
        let (strip, first) = (Strip::between(a, b), self.next);
        let [from, to] = ends.map(|(row, i)| self.stand(row, i));
        let side = Side {
            strip: &strip,
            first,
            reach: CUSP,
            is_reversed: false,
        };
        for (number, turn) in strip.turns.iter().enumerate() {
            let (row, i) = ends[usize::from(turn.is_second)];
            let corner = cusp(&side, number, [&from, &to]);
            self.vertex(corner.at, row.row.colours.get(i));
        }
        into.0.push((strip, first));
    }

    /// The surface between two rows, and the walls at its ends.
    fn between(
        &mut self,
        own: &Placed,
        above: &Placed,
        [upright, slanting]: [&Strips; 2],
    ) -> Result<(), ExchangeError> {
        let across = self.grid.spaces()[0];
        for i in 0..across {
            let [a, b] = [0, 1].map(|k| self.stand(own, i + k));
            let [d, c] = [0, 1].map(|k| self.stand(above, i + k));
            let mut surface = Surface {
                colour: own.row.colours.get(i).copied().unwrap_or_default(),
                next: &mut self.next,
                to: &mut self.to,
            };
            let right = [
                own.across.side(i, false),
                upright.side(i + 1, false),
                slanting.side(i, true),
            ];
            facets(&[a, b, c], &right, &mut surface)?;
            let left = [
                slanting.side(i, false),
                above.across.side(i, true),
                upright.side(i, true),
            ];
            facets(&[a, c, d], &left, &mut surface)?;
        }
        self.wall([(above, 0), (own, 0)], upright.side(0, true))?;
        self.wall(
            [(own, across), (above, across)],
            upright.side(across, false),
        )
    }

    /// The wall under the surface's edge from a column to the next, counterclockwise around it, and the bottom from there to
    /// its middle.
    fn wall(&mut self, ends: [(&Placed, usize); 2], along: Side<'_>) -> Result<(), ExchangeError> {
        let nothing = Strip::default();
        let colour = ends[0]
            .0
            .row
            .colours
            .get(ends[0].1)
            .copied()
            .unwrap_or_default();
        let [from, to] = ends.map(|(row, i)| self.stand(row, i));
        let [under_from, under_to] = [from, to].map(|stand| Stand { z: &[0.0], ..stand });
        // Beyond the edge there is nothing down to the bottom.
        let down = ends.map(|(row, i)| Strip::between(&row.row.columns[i], &[f32::NEG_INFINITY]));
        let side = |strip, is_reversed| Side {
            strip,
            first: 0,
            reach: WALL_CUSP,
            is_reversed,
        };
        let mut take = Wall {
            colour,
            to: &mut self.to,
        };
        let first = [
            side(&down[0], false),
            side(&nothing, false),
            side(&down[0], true),
        ];
        facets(&[from, under_from, under_to], &first, &mut take)?;
        let along = Side {
            is_reversed: !along.is_reversed,
            ..along
        };
        let second = [side(&down[0], false), side(&down[1], true), along];
        facets(&[from, under_to, to], &second, &mut take)?;
        let foot = |stand: &Stand<'_>| [stand.at[0], stand.at[1], 0.0];
        let [width, height] = self.grid.spaces();
        let y = (self.grid.at(1, height) * self.placing.cell) as f32;
        let middle = [0.5 * self.xs[width], 0.5 * y, 0.0];
        self.to.wall([foot(&from), middle, foot(&to)], colour)
    }
}

/// Takes facets of the surface, whose vertices are numbered.
struct Surface<'a, F> {
    colour: Colour,
    next: &'a mut u32,
    to: &'a mut F,
}

impl<F: Facets> Take for Surface<'_, F> {
    const IS_WALL: bool = false;

    fn vertex(&mut self, at: Point) -> Corner {
        let id = *self.next;
        self.to.vertex(at, self.colour);
        *self.next = id.wrapping_add(1);
        Corner { at, id }
    }

    fn facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError> {
        self.to.surface(corners)
    }
}

/// Takes facets of walls, whose vertices have no numbers.
struct Wall<'a, F> {
    colour: Colour,
    to: &'a mut F,
}

impl<F: Facets> Take for Wall<'_, F> {
    const IS_WALL: bool = true;

    fn vertex(&mut self, at: Point) -> Corner {
        Corner { at, id: 0 }
    }

    fn facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError> {
        self.to.wall(corners.map(|corner| corner.at), self.colour)
    }
}
