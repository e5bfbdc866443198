//! A brush on a surface: its head, its load and its traits, in cells and quanta.

pub mod head;
pub mod load;
pub mod scale;
pub mod streaks;
pub mod traits;
