//! A painting's surface as a solid, which [`write_stl`](crate::write_stl) and [`write_glb`](crate::write_glb) write.
//!
//! Paint that lies in layers, and may overhang, is shown whole; where it does not, the solid is that of a map of heights.

mod columns;
mod film;
mod grid;
mod mesh;
mod prism;
mod rows;
mod strip;

use maulstick_appearance::bands::Banded;

pub(crate) use self::grid::Grid;
pub(crate) use self::mesh::{Facets, Mesh, Placing};
pub(crate) use self::prism::{Corner, Point};
pub(crate) use self::rows::{Colour, RowSetup, rows};
use crate::ExchangeError;
use crate::surface::Steps;

/// Triangles that most programs still work with.
pub const SOLID_TRIANGLES: u64 = 4_000_000;
/// Thickness of a base, mm.
const BASES_MM: [f64; 2] = [0.01, 1000.0];
/// Factors on heights.
const EXAGGERATIONS: [f64; 2] = [0.0, 1000.0];
/// Thickness below which a piece of paint over air, or the air under it, is left out, m: of the solid, and of the painting.
const THIN_M: [f64; 2] = [1e-6, 1e-8];
/// mm in a metre.
const MM: f64 = 1e3;

/// What a solid is made with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidSetup {
    /// Thickness under the lowest place, mm, .01 to 1000.
    pub base_mm: f64,
    /// Factor on heights, 0 to 1000.
    pub exaggeration: f64,
    /// Cells from vertex to vertex, 1 or more; a vertex is as the highest of its cells.
    pub step: u32,
}

/// What a solid has become.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidSize {
    /// How many triangles it has.
    pub triangles: u64,
    /// Across, up and high, mm.
    pub size_mm: [f64; 3],
}

/// The least step with which a surface of so many cells on which no paint overhangs has at most [`SOLID_TRIANGLES`].
#[must_use]
pub fn solid_step(cells: [u32; 2]) -> u32 {
    let cells = cells.map(|cells| cells as usize);
    let few = |step: &u32| Grid::new(cells, *step as usize).triangles() <= SOLID_TRIANGLES;
    (1..u32::MAX).find(few).unwrap_or(u32::MAX)
}

impl SolidSetup {
    /// # Errors
    /// [`ExchangeError::OutOfRange`].
    pub(crate) fn check(&self) -> Result<(), ExchangeError> {
        within("base in mm", self.base_mm, BASES_MM)?;
        within("relief exaggeration", self.exaggeration, EXAGGERATIONS)?;
        let steps = [1.0, f64::from(u32::MAX)];
        within("step in cells", f64::from(self.step), steps)
    }
}

fn within(what: &'static str, value: f64, [least, most]: [f64; 2]) -> Result<(), ExchangeError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(ExchangeError::OutOfRange {
        what,
        value,
        least,
        most,
    })
}

/// A solid that is measured, and can be made.
pub(crate) struct Solid<'a> {
    banded: &'a Banded<'a>,
    grid: Grid,
    setup: SolidSetup,
    /// From the lowest to the highest place, m.
    range_m: [f64; 2],
    /// Parts of it.
    pub(crate) parts: Parts,
}

/// Counts of the parts of a solid.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Parts {
    /// Vertices of the surface.
    pub(crate) vertices: u64,
    /// Facets of the surface.
    pub(crate) surface: u64,
    /// Facets of walls and bottom.
    pub(crate) walls: u64,
}

impl Facets for Parts {
    fn vertex(&mut self, _at: Point, _colour: Colour) {
        self.vertices += 1;
    }

    fn surface(&mut self, _corners: [Corner; 3]) -> Result<(), ExchangeError> {
        self.surface += 1;
        Ok(())
    }

    fn wall(&mut self, _corners: [Point; 3], _colour: Colour) -> Result<(), ExchangeError> {
        self.walls += 1;
        Ok(())
    }
}

impl<'a> Solid<'a> {
    /// Measures the solid of a surface, for a file that has room for `most` triangles.
    pub(crate) fn of(
        banded: &'a Banded<'a>,
        setup: SolidSetup,
        most: u64,
        steps: &mut Steps<'_>,
    ) -> Result<Self, ExchangeError> {
        let grid = Grid::new(banded.cells(), setup.step as usize);
        let few = |triangles: u64| match triangles <= most {
            true => Ok(()),
            false => Err(ExchangeError::TooManyTriangles {
                triangles,
                step: coarser(banded, setup),
            }),
        };
        few(grid.triangles())?;
        let mut solid = Self {
            banded,
            grid,
            setup,
            range_m: [0.0; 2],
            parts: Parts::default(),
        };
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let mut mesh = Mesh::new(grid, solid.placing(MM), Parts::default());
        rows(banded, solid.rows(false), steps, |number, row| {
            let ends = |column: &Vec<f32>| [column[0], column[column.len() - 1]].map(f64::from);
            for [low, high] in row.columns.iter().map(ends) {
                range = [range[0].min(low), range[1].max(high)];
            }
            mesh.row(number, row)
        })?;
        (solid.parts, solid.range_m) = (mesh.to, range);
        few(solid.triangles())?;
        Ok(solid)
    }

    /// Makes it in units of which a metre has so many; rows with colours if they are needed.
    pub(crate) fn make<F: Facets>(
        &self,
        metre: f64,
        is_coloured: bool,
        steps: &mut Steps<'_>,
        to: F,
    ) -> Result<F, ExchangeError> {
        let mut mesh = Mesh::new(self.grid, self.placing(metre), to);
        rows(self.banded, self.rows(is_coloured), steps, |number, row| {
            mesh.row(number, row)
        })?;
        Ok(mesh.to)
    }

    fn rows(&self, is_coloured: bool) -> RowSetup {
        let [made, painted] = THIN_M;
        RowSetup {
            grid: self.grid,
            thin_m: (made / self.setup.exaggeration).max(painted),
            is_coloured,
        }
    }

    fn placing(&self, metre: f64) -> Placing {
        Placing {
            cell: self.banded.cell_m() * metre,
            least_m: self.range_m[0],
            base: self.setup.base_mm * metre / MM,
            metre: self.setup.exaggeration * metre,
        }
    }

    /// A step with which it has fewer triangles.
    pub(crate) fn coarser(&self) -> u32 {
        coarser(self.banded, self.setup)
    }

    /// Triangles in all.
    pub(crate) fn triangles(&self) -> u64 {
        self.parts.surface + self.parts.walls
    }

    /// Its size in units of which a metre has so many.
    pub(crate) fn size(&self, metre: f64) -> [f64; 3] {
        let placing = self.placing(metre);
        let [across, up] = self.banded.cells().map(|cells| cells as f64 * placing.cell);
        [across, up, placing.z(self.range_m[1])]
    }

    /// Its triangles, and its size in mm.
    pub(crate) fn extent(&self) -> SolidSize {
        SolidSize {
            triangles: self.triangles(),
            size_mm: self.size(MM),
        }
    }
}

fn coarser(banded: &Banded<'_>, setup: SolidSetup) -> u32 {
    solid_step(banded.store().cells()).max(setup.step.saturating_add(1))
}

/// The unit normal of a triangle whose corners are counterclockwise; nothing if it has no area.
pub(crate) fn normal(corners: &[Point; 3]) -> Point {
    let n = area(corners);
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    if length > 0.0 {
        n.map(|part| (part / length) as f32)
    } else {
        [0.0; 3]
    }
}

/// The normal of a triangle, as long as twice its area.
pub(crate) fn area([a, b, c]: &[Point; 3]) -> [f64; 3] {
    let side = |to: &Point| [0, 1, 2].map(|i| f64::from(to[i]) - f64::from(a[i]));
    let (u, v) = (side(b), side(c));
    [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ]
}

#[cfg(test)]
mod tests;
