//! Surfaces on the desk, and the ferrule of a stylus over them.

pub mod desk;
pub mod palette_place;
pub mod placement;
