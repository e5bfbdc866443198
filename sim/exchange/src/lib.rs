//! Paintings to and from other programs.
//!
//! An export takes a painting and a surface of it, writes to a file from its start, and reports its
//! progress. Each needs memory for a few rows of tiles, however large the surface is, but for
//! [`write_open_raster`], which also holds packed layers, and [`write_glb`], which holds its walls. The same painting gives the same bytes: no
//! file has a date in it.
//!
//! | export | file |
//! | --- | --- |
//! | [`write_lit_png`] | the painting under its lamp: PNG of 8 or 16 bits a channel |
//! | [`write_open_exr`] | unlit colour, height and the thickness of each paint: OpenEXR |
//! | [`write_open_raster`] | flat colour, a layer for each dry layer: OpenRaster |
//! | [`write_gloss_map`] | gloss: grey PNG of 16 bits |
//! | [`write_height_map`] | height: grey PNG of 16 bits; [`HeightRange`] says what black and white are |
//! | [`write_stl`] | a solid to print, with overhangs: STL; [`solid_step`] proposes the resolution |
//! | [`write_glb`] | the same with colours: binary glTF |
//!
//! [`Order`] is any of these; [`small_picture`] is a thumbnail, and [`film`] draws frame after frame. Errors are
//! [`ExchangeError`]; [`Progress`] reports the progress of an export.
//!
//! An import makes an underpainting, a ground or a tooth from a picture:
//!
//! | module | holds |
//! | --- | --- |
//! | [`read_image`] | pictures from files, a row at a time |
//! | [`fit_to`] | a picture as large as a canvas |
//! | [`embed`] | pictures for a painting's grounds and teeth |
//! | [`underpaint`] | a picture as paint |
//! | [`environment`] | a picture as surroundings |
//!
//! Its errors are [`ImportError`].
//!
//! A canvas that is half yellow, written as PNG, and as a solid to print:
//!
//! ```
//! use std::io::Cursor;
//!
//! use maulstick_appearance::picture::{Depth, Export};
//! use maulstick_exchange::{SolidSetup, write_lit_png, write_stl};
//! use maulstick_optics::PaintLibrary;
//! use maulstick_painting::edits::{Fill, FillPaint};
//! use maulstick_painting::{Painting, PaintingSetup};
//! use maulstick_types::scene::CANVAS;
//! use maulstick_types::values::FilmThickness;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let setup = PaintingSetup { cells: [128, 64], ..PaintingSetup::default() };
//! let mut painting = Painting::new(&setup, PaintLibrary::measured()?)?;
//! painting.apply(Fill {
//!     paint: FillPaint::Mixture { mixture: "Hansa Yellow Opaque".parse()? },
//!     thickness: FilmThickness::in_unit(60.0)?,
//!     surface: CANVAS,
//! })?;
//!
//! let mut png = Vec::new();
//! write_lit_png(&mut painting, CANVAS, (&Export::default(), Depth::Eight), &mut png, &mut |_, _| {})?;
//! let mut picture = png::Decoder::new(Cursor::new(png)).read_info()?;
//! let mut pixels = vec![0; picture.output_buffer_size().ok_or("too large")?];
//! let size = picture.next_frame(&mut pixels)?;
//! assert_eq!((size.width, size.height), (128, 64));
//! assert!(pixels[0] > 150 && pixels[2] < 80, "red and little blue make yellow");
//!
//! let solid = SolidSetup { base_mm: 2.0, exaggeration: 1.0, step: 4 };
//! let mut stl = Cursor::new(Vec::new());
//! let size = write_stl(&mut painting, CANVAS, &solid, &mut stl, &mut |_, _| {})?;
//! println!("{} triangles, {:?} mm", size.triangles, size.size_mm);
//! assert!(size.size_mm[2] > 2.0);
//! # Ok(())
//! # }
//! ```
//!
//! # Notes
//!
//! `read_image` is the only reader of pictures, also for the window's reference and tracing pictures. Thumbnails of the
//! history are drawn tile by tile while nobody paints; states share most tiles, so a few colours of each tile are kept.

pub mod embed;
pub mod environment;
mod error;
pub mod film;
pub mod fit_to;
mod format;
mod glb;
mod gloss_map;
mod grey_map;
mod height_map;
pub mod import_error;
mod lit_png;
mod open_exr;
mod open_raster;
pub mod read_image;
mod solid;
mod stl;
mod surface;
mod thumbnail;
pub mod underpaint;

pub use error::ExchangeError;
pub use format::{Format, Order};
pub use glb::write_glb;
pub use gloss_map::write_gloss_map;
pub use height_map::{HeightRange, write_height_map};
pub use import_error::ImportError;
pub use lit_png::write_lit_png;
pub use open_exr::write_open_exr;
pub use open_raster::write_open_raster;
pub use read_image::{Image, PictureKind, UnusedMark};
pub use solid::{SOLID_TRIANGLES, SolidSetup, SolidSize, solid_step};
pub use stl::write_stl;
pub use surface::Progress;
pub use thumbnail::{HistoryPictures, small_picture};
pub use underpaint::{ColourError, Support, Underpainting};
