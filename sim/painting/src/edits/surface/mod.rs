//! Edits of a surface: its place, light, materials, films and wells.

mod convert;
mod fill;
mod flip;
mod ground;
mod piles;
mod place;
mod relight;
mod scrape;
mod size;
mod tooth;
mod wells;

pub use convert::Convert;
pub use fill::{Fill, FillPaint};
pub use flip::Flip;
pub use ground::{Ground, GroundSource};
pub use piles::Piles;
pub use place::Place;
pub use relight::{Exposure, LightChange, Relight};
pub use scrape::Scrape;
pub use size::Size;
pub use tooth::Tooth;
pub use wells::Wells;

use maulstick_canvas::assets::{IMAGE, SPECTRUM};

/// True if a name refers to something that a painting holds, and alone can check.
fn is_held(name: &str) -> bool {
    name.starts_with(IMAGE) || name.starts_with(SPECTRUM)
}
