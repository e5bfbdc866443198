//! Spectra, the light and the observer, and the wavelengths that a painting computes.

pub mod cie;
pub mod quadrature;
pub mod rule;
pub mod spectrum;
pub mod spectrum_error;
pub mod spectrum_file;
pub mod upsampling;
