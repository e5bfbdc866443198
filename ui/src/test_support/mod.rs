//! Windows for tests, without a rig.
//!
//! | module | holds |
//! | --- | --- |
//! | [`panel_bench`] | a panel in a column, and its snapshot |
//! | [`context_bench`] | rack and panels with a rig in memory |
//! | [`overlay_bench`] | the whole overlay with keys, clicks and dialogs |

pub(crate) mod context_bench;
pub(crate) mod overlay_bench;
pub(crate) mod panel_bench;
