//! A painting as a solid to print, in binary STL (3D Systems 1988, *StereoLithography Interface Specification*), in mm, as
//! printers take it.

use std::io::{BufWriter, Write};

use maulstick_painting::Painting;

use crate::ExchangeError;
use crate::solid::{
    Colour, Corner, MM, MeshSink, Point, Solid, SolidFormat, SolidSetup, SolidSize, normal,
    write_solid,
};
use crate::surface::{Progress, Steps};

/// Writes a surface as a solid.
///
/// # Errors
/// [`ExchangeError`].
pub fn write_stl(
    painting: &mut Painting,
    surface: u32,
    setup: &SolidSetup,
    to: impl Write,
    progress: Progress<'_>,
) -> Result<SolidSize, ExchangeError> {
    let format = Stl(BufWriter::new(to));
    write_solid(painting, surface, setup, format, progress)
}

/// Binary STL: header, number of triangles, facets.
struct Stl<W: Write>(BufWriter<W>);

impl<W: Write> SolidFormat for Stl<W> {
    const MAX_TRIANGLES: u64 = u32::MAX as u64;
    const PASSES: usize = 2;

    fn write(mut self, solid: &Solid<'_>, steps: &mut Steps<'_>) -> Result<(), ExchangeError> {
        let mut header = [0; 80];
        let name = b"Maulstick relief, mm";
        header[..name.len()].copy_from_slice(name);
        self.0.write_all(&header)?;
        self.0
            .write_all(&(solid.triangles() as u32).to_le_bytes())?;
        Ok(solid.triangulate(MM, false, steps, self)?.0.flush()?)
    }
}

impl<W: Write> MeshSink for Stl<W> {
    fn add_surface_facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError> {
        self.add_wall_facet(corners.map(|corner| corner.at), Colour::default())
    }

    fn add_wall_facet(
        &mut self,
        corners: [Point; 3],
        _colour: Colour,
    ) -> Result<(), ExchangeError> {
        let mut bytes = [0; 50];
        let normal = normal(&corners);
        let floats = std::iter::once(&normal).chain(&corners).flatten();
        for (bytes, value) in bytes.chunks_exact_mut(4).zip(floats) {
            bytes.copy_from_slice(&value.to_le_bytes());
        }
        Ok(self.0.write_all(&bytes)?)
    }
}
