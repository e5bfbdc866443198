//! Mixtures of paints: films, matches to a colour, and the four ways of mixing compared.

pub mod body;
pub mod comparison;
pub mod km;
pub mod matching;
pub mod mixture;
pub mod oil;
pub mod paints;
pub mod search;
pub mod surface;
pub mod thinning;
