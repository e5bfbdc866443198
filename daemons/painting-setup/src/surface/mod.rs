//! Grounds and teeth of a surface: by name, and from files.

pub mod ground;
pub mod picture;
pub mod tooth;
