//! A painting's relief as a solid to print, in binary STL (3D Systems 1988, *StereoLithography
//! Interface Specification*).
//!
//! The top is the surface's height over a base, with vertices in the middles of cells; walls go down to
//! z = 0, and the bottom is a fan around its middle. Each edge has two triangles that run along it in
//! opposite directions, all normals point out, and lengths are mm, as printers take them.

mod grid;

use std::io::{BufWriter, Write};

use maulstick_painting::Painting;

use self::grid::Grid;
use crate::ExchangeError;
use crate::surface::{Progress, Steps, banded, check_whole};

/// Triangles that most programs still work with.
pub const STL_TRIANGLES: u64 = 4_000_000;
/// Thickness of a base, mm.
const BASES_MM: [f64; 2] = [0.01, 1000.0];
/// Factors on heights.
const EXAGGERATIONS: [f64; 2] = [0.0, 1000.0];
const MM: f64 = 1e3;

/// What a relief is made with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StlSetup {
    /// Thickness under the lowest place, mm, .01 to 1000.
    pub base_mm: f64,
    /// Factor on heights, 0 to 1000.
    pub exaggeration: f64,
    /// Cells from vertex to vertex, 1 or more; the height of one is the highest of its cells.
    pub step: u32,
}

/// What a relief has become.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StlSize {
    /// How many triangles it has.
    pub triangles: u64,
    /// Across, up and high, mm.
    pub size_mm: [f64; 3],
}

/// The least step with which a surface of so many cells has at most [`STL_TRIANGLES`].
#[must_use]
pub fn stl_step(cells: [u32; 2]) -> u32 {
    let cells = cells.map(|cells| cells as usize);
    let few = |step: &u32| Grid::new(cells, *step as usize).triangles() <= STL_TRIANGLES;
    (1..u32::MAX).find(few).unwrap_or(u32::MAX)
}

/// Writes the relief of a surface.
///
/// # Errors
/// [`ExchangeError`].
pub fn write_stl(
    painting: &mut Painting,
    surface: u32,
    setup: &StlSetup,
    to: impl Write,
    progress: Progress<'_>,
) -> Result<StlSize, ExchangeError> {
    within("base in mm", setup.base_mm, BASES_MM)?;
    within("exaggeration", setup.exaggeration, EXAGGERATIONS)?;
    let steps = [1.0, f64::from(u32::MAX)];
    within("step in cells", f64::from(setup.step), steps)?;
    let banded = banded(painting, surface)?;
    let grid = Grid::new(banded.cells(), setup.step as usize);
    let triangles = grid.triangles();
    let Ok(count) = u32::try_from(triangles) else {
        let step = stl_step(banded.store().cells());
        return Err(ExchangeError::TooManyTriangles { triangles, step });
    };
    let mut steps = Steps::new(progress, 2 * banded.bands());
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    grid.rows(&banded, &mut steps, |_, heights| {
        least = heights.iter().copied().fold(least, f64::min);
        greatest = heights.iter().copied().fold(greatest, f64::max);
        Ok(())
    })?;
    let z = |height: f64| setup.base_mm + (height - least) * setup.exaggeration * MM;
    let mut to = BufWriter::new(to);
    let mut header = [0; 80];
    let name = b"Maulstick relief, mm";
    header[..name.len()].copy_from_slice(name);
    to.write_all(&header)?;
    to.write_all(&count.to_le_bytes())?;
    let mut solid = Solid {
        grid,
        cell_mm: banded.cell_m() * MM,
        above: Vec::new(),
        to,
    };
    grid.rows(&banded, &mut steps, |row, heights| {
        let tops = heights.iter().map(|height| z(*height) as f32);
        solid.row(row, tops.collect())
    })?;
    solid.to.flush()?;
    let [across, up] = banded.cells().map(|cells| cells as f64 * solid.cell_mm);
    check_whole(painting)?;
    Ok(StlSize {
        triangles,
        size_mm: [across, up, z(greatest)],
    })
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

/// A place, mm.
type Point = [f32; 3];

/// A solid that is written from its highest row of vertices down.
struct Solid<W: Write> {
    grid: Grid,
    cell_mm: f64,
    /// z of the row before; none for the highest.
    above: Vec<f32>,
    to: W,
}

impl<W: Write> Solid<W> {
    fn place(&self, axis: usize, vertex: usize) -> f32 {
        (self.grid.at(axis, vertex) * self.cell_mm) as f32
    }

    /// Writes what lies between a row of vertices of these z and the one above it, and the wall below
    /// the first and the last row.
    fn row(&mut self, row: usize, tops: Vec<f32>) -> Result<(), ExchangeError> {
        let [across, up] = self.grid.spaces();
        let y = self.place(1, row);
        let xs: Vec<f32> = (0..=across).map(|i| self.place(0, i)).collect();
        let own = |i: usize| [xs[i], y, tops[i]];
        if row < up {
            let y = self.place(1, row + 1);
            let tops = std::mem::take(&mut self.above);
            let above = |i: usize| [xs[i], y, tops[i]];
            for i in 0..across {
                self.facet([own(i), own(i + 1), above(i + 1)])?;
                self.facet([own(i), above(i + 1), above(i)])?;
            }
            self.wall([above(0), own(0)])?;
            self.wall([own(across), above(across)])?;
        }
        for i in 0..across {
            if row == 0 {
                self.wall([own(i), own(i + 1)])?;
            }
            if row == up {
                self.wall([own(i + 1), own(i)])?;
            }
        }
        self.above = tops;
        Ok(())
    }

    /// The wall under an edge of the top, which runs counterclockwise around it, and the bottom from
    /// there to its middle.
    fn wall(&mut self, [from, to]: [Point; 2]) -> Result<(), ExchangeError> {
        let foot = |[x, y, _]: Point| [x, y, 0.0];
        self.facet([from, foot(from), foot(to)])?;
        self.facet([from, foot(to), to])?;
        let [width, height] = self.grid.spaces();
        let middle = [0.5 * self.place(0, width), 0.5 * self.place(1, height), 0.0];
        self.facet([foot(from), middle, foot(to)])
    }

    /// Writes a triangle, counterclockwise from outside.
    fn facet(&mut self, corners: [Point; 3]) -> Result<(), ExchangeError> {
        let mut bytes = [0; 50];
        let normal = normal(&corners);
        let floats = std::iter::once(&normal).chain(&corners).flatten();
        for (bytes, value) in bytes.chunks_exact_mut(4).zip(floats) {
            bytes.copy_from_slice(&value.to_le_bytes());
        }
        Ok(self.to.write_all(&bytes)?)
    }
}

/// The unit normal of a triangle whose corners are counterclockwise.
fn normal([a, b, c]: &[Point; 3]) -> Point {
    let side = |to: &Point| [0, 1, 2].map(|i| f64::from(to[i]) - f64::from(a[i]));
    let (u, v) = (side(b), side(c));
    let n = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    n.map(|part| (part / length) as f32)
}
