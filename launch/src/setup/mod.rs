//! Setup of a painting: its document, canvas, light, memory and backend.

pub mod backend;
pub mod cells;
pub mod destination;
pub mod document;
pub mod duration;
pub mod easel;
pub mod ground;
pub mod kit;
pub mod lamp;
pub mod memory;
pub mod picture;
pub mod tooth;
pub mod viewing;
