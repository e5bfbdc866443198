//! Commands of colour: paints, mixtures, measurements, light.

pub mod fit;
pub mod light;
pub mod matching;
pub mod mix;
pub mod paints;
