//! Pigment optics: from measured paints to colour.
//!
//! | module | holds |
//! | --- | --- |
//! | [`spectrum`] | the wavelength grid and spectra on it |
//! | [`spectrum_file`] | spectra from CSV files |
//! | [`cie`] | observers and illuminants |
//! | [`quadrature`] | Gauss rules of any weight (Stieltjes, Golub and Welsch) |
//! | [`rule`] | the wavelengths of a painting, and their weights in XYZ |
//! | `fitted` | the rule that is fitted to paints and light |
//! | [`km`] | Kubelka-Munk films |
//! | [`surface`] | the surface correction |
//! | [`light`] | a lamp on a relief |
//! | [`colour`] | XYZ, Lab, ΔE₀₀, the RGB of displays |
//! | [`gamut`] | colours outside a display's gamut |
//! | [`icc`] | output profiles |
//! | [`paints`] | the measured paints |
//! | [`mixture`] | reflectance of mixed paints, opaque or as a film |
//! | [`viewing`] | light, observer and rule together: the colour of a reflectance |
//! | [`comparison`] | one graded mixture by four ways of mixing |
//! | [`search`] | minima of functions of one and two variables |
//! | [`matching`] | mixtures nearest to a colour |
//! | [`studio`] | all of the above for the paints, ground and light of one painting |
//! | [`upsampling`] | reflectances that have a given colour |
//! | [`backend`] | a studio's films for many tiles at once, on any backend |
//!
//! A film of blue and white paint, 100 µm of each, over black, and the same paint half as thick:
//!
//! ```
//! use maulstick_optics::PaintLibrary;
//! use maulstick_optics::studio::Studio;
//!
//! # fn main() -> Result<(), maulstick_optics::PaintError> {
//! let library = PaintLibrary::measured()?;
//! let mut studio = Studio::daylight();
//! let blue = studio.add(library.find("Cobalt Blue")?);
//! let white = studio.add(library.find("Titanium White")?);
//! let black = vec![0.0; studio.wavelengths()];
//! let thick = studio.lab(&[(blue, 1e-4), (white, 1e-4)], &black);
//! let thin = studio.lab(&[(blue, 5e-5), (white, 5e-5)], &black);
//! assert!(thick[0] > thin[0] && thick[2] < -20.0, "lighter where it hides the black, and blue");
//! # Ok(())
//! # }
//! ```
//!
//! # Choices
//!
//! - Colour is computed at a few wavelengths. These, and their weights in XYZ, are fitted to the paints and the light
//!   when a painting begins and when its light changes. The fit is to the whole paint file, since a new paint on the
//!   palette must not change colours on the canvas. No weight is negative: weights of either sign would reduce the mean
//!   error by only a hundredth, and without them XYZ of any reflectance lies between black and white.
//! - Paint mixes linearly in K and S. A film costs one exponential and one division a wavelength; the surface
//!   correction is applied once, on top.
//! - Views compute films on two threads or on a graphics device (`FilmBackend`), exports on the processor alone, for
//!   the same bytes everywhere. A device that fails is replaced by the processor.
//! - Light is a pass over unlit colour, gloss and height, here for exports and in `ui/src/render/shaders` for the view;
//!   a test compares the two. A level surface shows its film and the surface's own reflection k₁, times intensity and
//!   exposure. A relief casts soft shadows up to 4 mm or 24 cells, hides the sky within 2 mm or 16 cells, and light
//!   bounces between walls of the paint's own colour; so a changed tile affects the light of the cells around it. A
//!   cell's unresolved slopes add to its roughness, so coarse tiles keep the gloss of finer cells.
//! - Gamut and encoding follow light: hues are kept in Oklab, or clamped as in the dissertation. sRGB and Display P3
//!   are our own arithmetic with profiles of constant bytes; other ICC profiles go through `moxcms`, in the window
//!   through a cube of 33³ colours.

pub mod backend;
pub mod colour;
mod fitted;
pub mod gamut;
pub mod icc;
pub mod light;
mod mixing;
mod spectra;
pub mod studio;
pub mod viewing;

pub use backend::{BackendError, CpuFilms, FilmBackend};
pub use cie::{Illuminant, Observer};
pub use mixing::{body, comparison, km, matching, mixture, oil, paints, search, surface, thinning};
pub use mixture::{Blend, Coat, Layer};
pub use paints::{Paint, PaintError, PaintLibrary, THINNER, VARNISHES};
pub use rule::SamplingRule;
pub use spectra::{cie, quadrature, rule, spectrum, spectrum_error, spectrum_file, upsampling};
pub use spectrum::Spectrum;
pub use spectrum_file::Reflectance;
pub use studio::{FilmPlanes, RuleKind, Studio, StudioSettings, Under};
pub use thinning::thinned;
pub use upsampling::{Smooth, Upsampler};
pub use viewing::{Seen, Viewing};
