//! Figures: pages, plots and swatches.

pub mod page;
pub mod plot;
pub mod swatch;
