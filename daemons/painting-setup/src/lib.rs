//! What a painting begins with, of command line, rig.toml and files.
//!
//! | module | holds |
//! | --- | --- |
//! | [`options`] | options of the command line: [`KitOptions`], [`PaintingOptions`] |
//! | `painting` | [`painting_setup`]: the painting that settings ask for |
//! | [`backend`] | backend of the paint's steps |
//! | `brushes`, `paints` | brush files and paints as settings name them |
//! | [`cells`] | side of the cells, and how many a canvas may have |
//! | [`destination`] | display or file that colours go to: profile and gamut |
//! | [`document`] | paintings in files |
//! | [`lamp`], [`viewing`] | light over a painting; light, observer and rule of a table of colours |
//! | [`memory`] | memory that is allocated at once |
//! | `refusal` | refusals of a painting as the user sees them |
//! | [`outputs`] | files that are written; none replaces one that is read |
//! | [`surface`] | grounds, teeth and surroundings by name and from files; pictures that are read |
//! | [`take_setup`] | setup that a take embeds |
//!
//! ```
//! use maulstick_painting_setup::{PaintingOptions, library, painting_setup};
//! use maulstick_rig::RigConfig;
//!
//! # fn main() -> Result<(), maulstick_rig::UserError> {
//! let mut config = RigConfig::default();
//! let mut options = PaintingOptions::default();
//! options.kit.size = Some([400, 300]);
//! options.apply(&mut config)?;
//! let setup = painting_setup(&config, &library()?)?;
//! assert_eq!(setup.cells, [400, 300]);
//! # Ok(())
//! # }
//! ```

pub mod backend;
mod brushes;
pub mod cells;
pub mod destination;
pub mod document;
pub mod lamp;
pub mod memory;
pub mod options;
pub mod outputs;
mod painting;
mod paints;
mod refusal;
pub mod surface;
pub mod take_setup;
pub mod viewing;

pub use brushes::{brush_file, of_a_brush};
pub use options::{KitOptions, PaintingOptions};
pub use painting::painting_setup;
pub use paints::{library, library_from, mixture_of};
pub use refusal::refused;
