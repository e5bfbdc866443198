//! Options of an export in any format, for a command line or a window.

use std::io::{Seek, Write};
use std::path::Path;

use maulstick_appearance::picture::{Depth, Export};
use maulstick_painting::Painting;

use crate::surface::Progress;
use crate::{
    ExchangeError, SolidSetup, solid_step, write_glb, write_gloss_map, write_height_map,
    write_lit_png, write_open_exr, write_open_raster, write_stl,
};

/// Formats of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The painting under its light: PNG.
    Png,
    /// Unlit linear colour, height, and each paint's thickness, wet and dry: OpenEXR.
    Exr,
    /// A layer for each dry layer: OpenRaster.
    Ora,
    /// Heights as a grey PNG of 16 bits.
    Height,
    /// Gloss as a grey PNG of 16 bits.
    Gloss,
    /// A solid: STL.
    Stl,
    /// The same with its colours: binary glTF.
    Glb,
}

impl Format {
    /// All formats, with their names: a file's extension, except for heights and gloss.
    pub const ALL: [(&'static str, Self); 7] = [
        ("png", Self::Png),
        ("exr", Self::Exr),
        ("ora", Self::Ora),
        ("height", Self::Height),
        ("gloss", Self::Gloss),
        ("stl", Self::Stl),
        ("glb", Self::Glb),
    ];

    /// The format with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let same = |(known, _): &&(&str, Self)| known.eq_ignore_ascii_case(name);
        Self::ALL.iter().find(same).map(|(_, format)| *format)
    }

    /// The format of a file by its name.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?;
        Self::named(ending).filter(|format| !matches!(format, Self::Height | Self::Gloss))
    }
}

/// Options of an export.
#[derive(Clone, Debug)]
pub struct Order {
    /// The format.
    pub format: Format,
    /// The surface.
    pub surface: u32,
    /// Bits of a PNG.
    pub depth: Depth,
    /// Conversion of a PNG from the working space.
    pub export: Export,
    /// Thickness of a solid under its lowest point, mm.
    pub base_mm: f64,
    /// Factor on the heights of a solid.
    pub exaggeration: f64,
    /// Cells between points of a solid; [`solid_step`] if absent.
    pub step: Option<u32>,
}

impl Order {
    /// Writes a painting; returns a note about the file, which may be empty.
    ///
    /// # Errors
    /// [`ExchangeError`].
    pub fn write(
        &self,
        painting: &mut Painting,
        to: &mut (impl Write + Seek),
        progress: Progress<'_>,
    ) -> Result<String, ExchangeError> {
        let surface = self.surface;
        match self.format {
            Format::Png => {
                let look = (&self.export, self.depth);
                write_lit_png(painting, surface, look, to, progress)?;
            }
            Format::Exr => write_open_exr(painting, surface, to, progress)?,
            Format::Ora => write_open_raster(painting, surface, to, progress)?,
            Format::Height => {
                let range = write_height_map(painting, surface, to, progress)?;
                let [least, greatest] =
                    [range.least_m, range.greatest_m].map(|m| f64::from(m) * 1e6);
                return Ok(format!("black is {least:.1} µm, white is {greatest:.1} µm"));
            }
            Format::Gloss => {
                write_gloss_map(painting, surface, to, progress)?;
                return Ok("black is matt, white is the glossiest film".to_owned());
            }
            Format::Stl | Format::Glb => {
                let cells = painting
                    .store(surface)
                    .map_or([1, 1], |store| store.cells());
                let setup = SolidSetup {
                    base_mm: self.base_mm,
                    exaggeration: self.exaggeration,
                    step: self.step.unwrap_or_else(|| solid_step(cells)),
                };
                let size = match self.format {
                    Format::Glb => write_glb(painting, surface, &setup, to, progress)?,
                    _ => write_stl(painting, surface, &setup, to, progress)?,
                };
                let [x, y, z] = size.size_mm;
                return Ok(format!(
                    "{} triangles, {x:.1} × {y:.1} × {z:.2} mm",
                    size.triangles
                ));
            }
        }
        Ok(String::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_say_their_format() {
        let of = |name: &str| Format::of(Path::new(name));
        assert_eq!(of("a.PNG"), Some(Format::Png));
        assert_eq!(of("/x.y/a.stl"), Some(Format::Stl));
        assert_eq!(of("a.glb"), Some(Format::Glb));
        for name in ["a", "a.height", "a.gloss", "a.jpg", ".png"] {
            assert_eq!(of(name), None, "{name}");
        }
        assert_eq!(Format::named("Height"), Some(Format::Height));
    }
}
