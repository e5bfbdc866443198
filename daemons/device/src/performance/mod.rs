//! Performances made from a seed.

pub mod demo;
pub mod mark_sheet;
pub(crate) mod strokes;
