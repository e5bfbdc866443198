//! Pigment optics: from measured paints to colour.
//!
//! | module | holds |
//! | --- | --- |
//! | [`spectrum`] | the wavelength grid and spectra on it |
//! | [`spectrum_file`] | spectra from CSV files |
//! | [`cie`] | observers and illuminants |
//! | [`quadrature`] | Gauss rules of any weight (Stieltjes, Golub and Welsch) |
//! | [`rule`] | which wavelengths a painting computes, and their weights in XYZ |
//! | `fitted` | the rule that is fitted to paints and light |
//! | [`km`] | Kubelka-Munk films |
//! | [`surface`] | the surface correction |
//! | [`light`] | a lamp on a relief |
//! | [`colour`] | XYZ, Lab, ΔE₀₀, sRGB |
//! | [`paints`] | the measured paints |
//! | [`studio`] | all of the above for the paints, ground and light of one painting |

pub mod cie;
pub mod colour;
mod fitted;
pub mod km;
pub mod light;
pub mod paints;
pub mod quadrature;
pub mod rule;
pub mod spectrum;
pub mod spectrum_file;
pub mod studio;
pub mod surface;

pub use cie::{Illuminant, Observer};
pub use paints::{Paint, PaintError, PaintLibrary};
pub use rule::SamplingRule;
pub use spectrum::Spectrum;
pub use studio::{FilmPlanes, RuleKind, Studio, StudioSettings, Under};
