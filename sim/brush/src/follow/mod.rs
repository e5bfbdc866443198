//! The brush that follows a stylus: the path between samples, the lead, the mark.

pub mod handle_path;
pub mod lead;
pub mod mark;
pub mod model;
pub mod speed_limit;
mod stroke_count;
