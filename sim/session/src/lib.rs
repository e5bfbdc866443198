//! Brush and paint in one process, without a bus.
//!
//! | module | holds |
//! | --- | --- |
//! | [`offline`] | samples in, a painting out: the same bytes as a rig that heard them |
//! | [`autosave`] | a painting kept in its document as it grows |
//! | [`ticker`] | ticks of a clock |

pub mod autosave;
pub mod offline;
pub mod ticker;

pub use autosave::Autosave;
pub use offline::Offline;
