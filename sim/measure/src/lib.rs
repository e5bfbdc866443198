//! Measuring paints: from reflectances of masstones, mixtures and drawdowns to K and S
//! (Baxter 2004, § 7.5 and 7.6).
//!
//! | module | holds |
//! | --- | --- |
//! | [`table`] | tables of measurements |
//! | [`headings`], [`notes`] | its columns and comments |
//! | [`measurements`] | samples: their composition and readings |
//! | `reading` | rows of a table, as numbers |
//! | [`instrument`] | raw spectra, the standard, the neutral-density filter |
//! | [`surface`] | the instrument's reading of an internal reflectance |
//! | [`layer`] | reflectance of a layer with its derivatives |
//! | [`links`] | links of each paint to the reference white through samples |
//! | [`prior`] | assumptions about a paint before it is measured |
//! | [`normal`], [`program`] | normal equations; quadratic programs |
//! | [`wavelength`] | K and S of all paints at one wavelength |
//! | [`determined`] | determinacy of the result |
//! | [`influence`] | samples inconsistent with the others |
//! | [`residuals`] | residuals of the samples |
//! | [`fit`](mod@fit) | the whole |
//! | [`paint_file`](mod@paint_file) | the result as a file |
//! | [`warning`] | warnings of a fit |
//!
//! The example of `docs/measuring.md`: 24 readings of five paints give K and S at each wavelength.
//!
//! ```
//! use maulstick_measure::{FitOptions, fit, paint_file};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let table = include_str!("../../../docs/examples/measurements.csv");
//! let fitted = fit(table, &FitOptions::default())?;
//! for paint in &fitted.paints {
//!     println!("{}: K/S at 560 nm {:.3}", paint.name, paint.k.at(560.0) / paint.s.at(560.0));
//! }
//! println!("noise of the readings {:.4}, worst sample ΔE₀₀ {:.2}", fitted.noise, fitted.worst());
//! assert!(fitted.noise < 2e-3 && fitted.worst() < 0.5);
//! assert_eq!(maulstick_optics::PaintLibrary::parse(&paint_file(&fitted))?.paints().len(), 5);
//! # Ok(())
//! # }
//! ```

pub mod error;
pub mod fit;
mod input;
pub mod paint_file;
mod solving;
pub mod surface;
pub mod warning;

pub use solving::{
    determined, influence, layer, links, normal, prior, program, residuals, wavelength,
};

pub use error::{MeasureError, Place};
pub use fit::{Fit, FitOptions, fit};
pub(crate) use input::reading;
pub use input::{headings, instrument, measurements, notes, table};
pub use notes::{SurfaceError, parse_surface};
pub use paint_file::paint_file;
pub use residuals::Residual;
pub use warning::Warning;
