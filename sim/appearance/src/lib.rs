//! Appearance of a canvas's paint under light.
//!
//! Pure: tiles, a ground and a light come in, colour, gloss and height go out, and pictures of whole surfaces.
//!
//! | module | holds |
//! | --- | --- |
//! | [`Appearance`], [`Bakery`] | optics of the paints in use, opacity of dry layers, and those layers baked |
//! | [`light`], [`lamp`] | the scene's light for the optics, and its lamp over a surface |
//! | [`ground`], [`blank_surface`] | the ground under the paint, and a surface without paint |
//! | [`heap`] | the shape of paint in a well |
//! | [`show_paint`], [`colouring`] | display of a paint model's planes, and conversion of counts to colours |
//! | [`display`] | display of a tile before light: colour, gloss, height |
//! | [`shown_surface`] | a blank surface and the display of what is painted on it |
//! | [`bands`] | a surface by rows of tiles |
//! | [`picture`] | surfaces under light as pixels |
//!
//! A film of 40 µm of ultramarine is darker over grey than over gesso:
//!
//! ```
//! use maulstick_appearance::display::WetFilms;
//! use maulstick_appearance::ground::Ground;
//! use maulstick_canvas::assets::Assets;
//! use maulstick_canvas::planes::TILE_CELLS;
//! use maulstick_canvas::quantum::QUANTUM_M;
//! use maulstick_canvas::tile::{Tile, TileId};
//! use maulstick_optics::{PaintLibrary, Studio};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut studio = Studio::daylight();
//! let blue = studio.add(PaintLibrary::measured()?.find("Ultramarine Blue")?);
//! let counts = (40e-6 / QUANTUM_M).round() as f32;
//! let tile = Tile::new([(blue, vec![counts; TILE_CELLS].into())].into_iter(), None);
//! let films = WetFilms::of(Some(&tile));
//! let [gesso, grey] = ["gesso", "grey"]
//!     .map(|name| Ground::called(name, [64, 64], &studio, &Assets::default()));
//! let [over_gesso, over_grey] = [gesso?, grey?]
//!     .map(|ground| films.shade(&studio, ground.tile(TileId { x: 0, y: 0 }).under()));
//! assert!(over_grey[2][0] < over_gesso[2][0]);
//! # Ok(())
//! # }
//! ```
//!
//! # Notes
//!
//! - Wet paint lies on reflectances baked from the dry layers below it, kept until a layer is added, its opacity
//!   changes or the light does. Under another light a view gets all tiles anew, and the frame thread bakes the rest
//!   tile by tile when idle.
//! - `ShowPaint` interprets a model's counts and planes: films for the optics, height, colour and gloss.
//! - A well is a squeezed heap, displayed before a brush comes and counted from then on.
//! - Exports go band by band, a band being a row of tiles: two threads draw ahead of the one that writes, with the
//!   heights of the 24 rows beyond. A PNG of 16384² takes 100 MB besides the paint, and its bytes are independent of
//!   the threads.

mod appearance;
mod bakery;
pub mod bands;
pub mod blank_surface;
pub mod colouring;
pub mod display;
mod edge;
mod error;
pub mod ground;
pub mod heap;
pub mod lamp;
pub mod light;
pub mod picture;
pub mod show_paint;
pub mod shown_surface;

pub use appearance::Appearance;
pub use bakery::Bakery;
pub use error::LookError;
