//! Paintings to and from other programs.
//!
//! An export takes a painting and a surface of it, writes to a file from its start, and tells how far
//! it is. Each needs memory for a few rows of tiles, however large the surface is, but for
//! [`write_open_raster`], which also holds packed layers, and [`write_glb`], which holds its walls. The same painting gives the same bytes: no
//! file has a date in it.
//!
//! | export | file |
//! | --- | --- |
//! | [`write_lit_png`] | the painting under its lamp: PNG of 8 or 16 bits a channel |
//! | [`write_open_exr`] | unlit colour, height and the thickness of each paint: OpenEXR |
//! | [`write_open_raster`] | flat colour, a layer for each dry layer: OpenRaster |
//! | [`write_height_map`] | height: grey PNG of 16 bits; [`HeightRange`] says what black and white are |
//! | [`write_stl`] | a solid to print, with what overhangs: STL; [`solid_step`] proposes how fine |
//! | [`write_glb`] | the same with colours: binary glTF |
//!
//! [`Order`] is any of these; [`small_picture`] is for the eye alone, and [`film`] draws frame after frame. Errors are
//! [`ExchangeError`]; [`Progress`] hears how far an export is.
//!
//! An import makes of a picture an underpainting, a ground or a tooth:
//!
//! | module | holds |
//! | --- | --- |
//! | [`read_image`] | pictures from files, a row at a time |
//! | [`fit_to`] | a picture as large as a canvas |
//! | [`embed`] | pictures as a painting holds them: grounds and teeth |
//! | [`underpaint`] | a picture as paint |
//!
//! Its errors are [`ImportError`].
//!
//! # Notes
//!
//! `read_image` is the only reader of pictures, also for the window's reference and tracing pictures. Thumbnails of the
//! history are drawn tile by tile while nobody paints; states share most tiles, so a few colours of each tile are kept.

pub mod embed;
mod error;
pub mod film;
pub mod fit_to;
mod format;
mod glb;
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
pub use underpaint::{Likeness, Support, Underpainting};
