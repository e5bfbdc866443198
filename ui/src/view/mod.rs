//! The desk seen from above.
//!
//! | module | holds |
//! | --- | --- |
//! | [`camera`] | desk points to window points and back |
//! | `held_view` | the view while a brush touches the desk |
//! | [`visible_tiles`] | the tiles of a surface that are in view |
//! | `quad` | a surface in perspective |
//! | `fit_crosses` | what a device is to touch while it is fitted |
//! | `palette_slide` | animation of the palette |
//! | `well_labels` | labels of the wells |

pub mod camera;
pub(crate) mod fit_crosses;
pub(crate) mod held_view;
pub(crate) mod palette_slide;
pub(crate) mod quad;
pub mod visible_tiles;
pub(crate) mod well_labels;
