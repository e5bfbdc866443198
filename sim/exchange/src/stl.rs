//! A painting as a solid to print, in binary STL (3D Systems 1988, *StereoLithography Interface Specification*), in mm, as
//! printers take it.

use std::io::{BufWriter, Write};

use maulstick_painting::Painting;

use crate::ExchangeError;
use crate::solid::{Colour, Corner, Facets, Point, Solid, SolidSetup, SolidSize, normal};
use crate::surface::{Progress, Steps, banded, check_whole};

const MM: f64 = 1e3;

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
    setup.check()?;
    let banded = banded(painting, surface)?;
    let mut steps = Steps::new(progress, 2 * banded.bands());
    let solid = Solid::of(&banded, *setup, u32::MAX.into(), &mut steps)?;
    let size = solid.extent();
    let mut to = BufWriter::new(to);
    let mut header = [0; 80];
    let name = b"Maulstick relief, mm";
    header[..name.len()].copy_from_slice(name);
    to.write_all(&header)?;
    to.write_all(&(size.triangles as u32).to_le_bytes())?;
    solid.make(MM, false, &mut steps, Stl(to))?.0.flush()?;
    check_whole(painting)?;
    Ok(size)
}

struct Stl<W: Write>(BufWriter<W>);

impl<W: Write> Facets for Stl<W> {
    fn surface(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError> {
        self.wall(corners.map(|corner| corner.at), Colour::default())
    }

    fn wall(&mut self, corners: [Point; 3], _colour: Colour) -> Result<(), ExchangeError> {
        let mut bytes = [0; 50];
        let normal = normal(&corners);
        let floats = std::iter::once(&normal).chain(&corners).flatten();
        for (bytes, value) in bytes.chunks_exact_mut(4).zip(floats) {
            bytes.copy_from_slice(&value.to_le_bytes());
        }
        Ok(self.0.write_all(&bytes)?)
    }
}
