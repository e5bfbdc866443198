//! Surfaces on the desk, and where a stylus holds the ferrule over them.

pub mod desk;
pub mod palette_place;
pub mod placement;
