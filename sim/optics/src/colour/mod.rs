//! XYZ, Lab, ΔE₀₀, and the colour spaces of displays and pictures.
//!
//! The working space is linear light with the primaries of sRGB, unclamped: a colour outside of sRGB has a negative
//! channel there, and a positive one in a wider space.

mod adapt;
mod encoding;
mod lab;
mod matrix;
mod rgb;

pub use adapt::{D50, adaptation, bradford};
pub use encoding::{Chromaticities, Transfer};
pub use lab::{delta_e_2000, delta_e_2000_near, lab};
pub use matrix::{Matrix, apply, inverse, product, solve3};
pub use rgb::{
    RgbSpace, SrgbCurve, SrgbTable, linear_srgb_as_it_is, srgb_decode, srgb_encode,
    xyz_to_linear_srgb,
};

pub use crate::gamut::clamp_chromaticity;
