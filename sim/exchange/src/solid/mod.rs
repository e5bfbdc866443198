//! A painting's surface as a watertight solid, which [`write_stl`](crate::write_stl) and [`write_glb`](crate::write_glb) write.
//!
//! Paint in layers is complete, with its overhangs; elsewhere the solid is that of a height map.

mod columns;
mod grid;
mod mesh;
mod pairing;
mod prism;
mod rows;

use maulstick_appearance::bands::Banded;
use maulstick_painting::Painting;

pub(crate) use self::grid::Grid;
pub(crate) use self::mesh::{FileScale, MeshBuilder, MeshSink};
pub(crate) use self::prism::{Corner, Point};
pub(crate) use self::rows::{Colour, Row, RowSetup, rows};
use crate::ExchangeError;
use crate::surface::{Progress, Steps, banded, check_whole};

/// Triangles that most programs still work with.
pub const SOLID_TRIANGLES: u64 = 4_000_000;
/// mm in a metre.
pub(crate) const MM: f64 = 1e3;
/// Range of the thickness of a base, mm.
const BASES_MM: [f64; 2] = [0.01, 1000.0];
/// Range of factors on heights.
const EXAGGERATIONS: [f64; 2] = [0.0, 1000.0];
/// Thickness below which a piece of paint over air, or the air under it, is left out, m: in the solid, and in the
/// painting.
const THIN_M: [f64; 2] = [1e-6, 1e-8];

/// Settings of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidSetup {
    /// Thickness under the lowest place, mm, .01 to 1000.
    pub base_mm: f64,
    /// Factor on heights, 0 to 1000.
    pub exaggeration: f64,
    /// Cells from vertex to vertex, 1 or more; a vertex has the column of the highest of its cells.
    pub step: u32,
}

/// Size of a written solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidSize {
    /// Number of triangles.
    pub triangles: u64,
    /// Across, up and high, mm.
    pub size_mm: [f64; 3],
}

/// The least step with which a surface of `cells` has at most [`SOLID_TRIANGLES`] triangles without overhangs.
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

/// A solid with its triangles counted and its heights measured.
pub(crate) struct Solid<'a> {
    banded: &'a Banded<'a>,
    grid: Grid,
    setup: SolidSetup,
    /// From the lowest to the highest place, m.
    range_m: [f64; 2],
    /// Vertices and facets of its mesh.
    pub(crate) counts: MeshCounts,
}

/// Counts of a mesh.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MeshCounts {
    /// Vertices of the surface.
    pub(crate) vertices: u64,
    /// Facets of the surface.
    pub(crate) surface_facets: u64,
    /// Facets of walls and bottom.
    pub(crate) wall_facets: u64,
}

impl MeshSink for MeshCounts {
    fn add_vertex(&mut self, _at: Point, _colour: Colour) {
        self.vertices += 1;
    }

    fn add_surface_facet(&mut self, _corners: [Corner; 3]) -> Result<(), ExchangeError> {
        self.surface_facets += 1;
        Ok(())
    }

    fn add_wall_facet(
        &mut self,
        _corners: [Point; 3],
        _colour: Colour,
    ) -> Result<(), ExchangeError> {
        self.wall_facets += 1;
        Ok(())
    }
}

/// File format of a solid.
pub(crate) trait SolidFormat {
    /// Greatest number of triangles.
    const MAX_TRIANGLES: u64;
    /// Passes over the surface, that of [`Solid::measure`] included.
    const PASSES: usize;

    fn write(self, solid: &Solid<'_>, steps: &mut Steps<'_>) -> Result<(), ExchangeError>;
}

/// Writes the solid of a surface in a format.
pub(crate) fn write_solid<F: SolidFormat>(
    painting: &mut Painting,
    surface: u32,
    setup: &SolidSetup,
    format: F,
    progress: Progress<'_>,
) -> Result<SolidSize, ExchangeError> {
    setup.check()?;
    let banded = banded(painting, surface)?;
    let mut steps = Steps::new(progress, F::PASSES * banded.bands());
    let solid = Solid::measure(&banded, *setup, F::MAX_TRIANGLES, &mut steps)?;
    format.write(&solid, &mut steps)?;
    let size = solid.extent();
    check_whole(painting)?;
    Ok(size)
}

impl<'a> Solid<'a> {
    /// Measures the solid of a surface, for a file of at most `max_triangles` triangles.
    pub(crate) fn measure(
        banded: &'a Banded<'a>,
        setup: SolidSetup,
        max_triangles: u64,
        steps: &mut Steps<'_>,
    ) -> Result<Self, ExchangeError> {
        let grid = Grid::new(banded.cells(), setup.step as usize);
        let check = |triangles: u64| {
            if triangles <= max_triangles {
                Ok(())
            } else {
                Err(ExchangeError::TooManyTriangles {
                    triangles,
                    step: coarser(banded, setup),
                })
            }
        };
        check(grid.triangles())?;
        let mut solid = Self {
            banded,
            grid,
            setup,
            range_m: [0.0; 2],
            counts: MeshCounts::default(),
        };
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let measure = |row: &Row| {
            let ends = |column: &Vec<f32>| [column[0], column[column.len() - 1]].map(f64::from);
            for [low, high] in row.columns.iter().map(ends) {
                range = [range[0].min(low), range[1].max(high)];
            }
        };
        solid.counts = solid.build(MM, false, steps, MeshCounts::default(), measure)?;
        solid.range_m = range;
        check(solid.triangles())?;
        Ok(solid)
    }

    /// Passes its mesh to `sink`: lengths in units of 1/`metre` m, rows with colours if needed.
    pub(crate) fn triangulate<S: MeshSink>(
        &self,
        metre: f64,
        is_coloured: bool,
        steps: &mut Steps<'_>,
        sink: S,
    ) -> Result<S, ExchangeError> {
        self.build(metre, is_coloured, steps, sink, |_| ())
    }

    /// The same, with each row of columns shown to `inspect` first.
    fn build<S: MeshSink>(
        &self,
        metre: f64,
        is_coloured: bool,
        steps: &mut Steps<'_>,
        sink: S,
        mut inspect: impl FnMut(&Row),
    ) -> Result<S, ExchangeError> {
        let [solid_m, painting_m] = THIN_M;
        let setup = RowSetup {
            grid: self.grid,
            thin_m: (solid_m / self.setup.exaggeration).max(painting_m),
            is_coloured,
        };
        let mut mesh = MeshBuilder::new(self.grid, self.scale(metre), sink);
        rows(self.banded, setup, steps, |number, row| {
            inspect(&row);
            mesh.add_row(number, row)
        })?;
        Ok(mesh.sink)
    }

    fn scale(&self, metre: f64) -> FileScale {
        FileScale {
            cell: self.banded.cell_m() * metre,
            lowest_m: self.range_m[0],
            base: self.setup.base_mm * metre / MM,
            metre: self.setup.exaggeration * metre,
        }
    }

    /// A step with which it has fewer triangles.
    pub(crate) fn coarser(&self) -> u32 {
        coarser(self.banded, self.setup)
    }

    /// Number of triangles.
    pub(crate) fn triangles(&self) -> u64 {
        self.counts.surface_facets + self.counts.wall_facets
    }

    /// Its size in units of 1/`metre` m.
    pub(crate) fn size(&self, metre: f64) -> [f64; 3] {
        let scale = self.scale(metre);
        let [across, up] = self.banded.cells().map(|cells| cells as f64 * scale.cell);
        [across, up, scale.z(self.range_m[1])]
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

/// Unit normal of a triangle whose corners are counterclockwise; 0 if it has no area.
pub(crate) fn normal(corners: &[Point; 3]) -> Point {
    unit(area_normal(corners))
}

/// Unit vector of this direction; 0 for that of length 0.
pub(crate) fn unit(n: [f64; 3]) -> Point {
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    if length > 0.0 {
        n.map(|part| (part / length) as f32)
    } else {
        [0.0; 3]
    }
}

/// Normal of a triangle, as long as twice its area.
pub(crate) fn area_normal([a, b, c]: &[Point; 3]) -> [f64; 3] {
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
