//! Spines: chains of segments, their roots in the ferrule, and the core that they share.

pub mod core_spine;
pub mod permanent_set;
mod pose_error;
pub mod single_spine;
pub mod spine;
pub mod spine_layout;
pub mod spine_root;
