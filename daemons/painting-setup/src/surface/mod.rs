//! Grounds and teeth of a surface, and surroundings: by name, and from files.

pub mod environment;
pub mod ground;
pub mod picture;
pub mod tooth;
