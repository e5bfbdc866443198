//! Drawing of desk, surfaces and brushes.
//!
//! | module | holds |
//! | --- | --- |
//! | `gpu` | the graphics device |
//! | `device_loss` | recovery from a lost graphics device |
//! | `scene` | the desk in the window |
//! | `tile_atlas` | the tiles of a surface as a toroidal texture atlas |
//! | [`surface`] | a surface on the graphics device |
//! | `light_surface`, [`show_surface`] | its passes: lighting, and drawing into the view |
//! | [`backdrop`] | desk and surfaces as pixels of the window |
//! | [`brush`] | the brushes over them |
//! | `view_light` | viewer and lamp |
//! | `display_transform` | sRGB to the colours of the display |
//! | `frame_reports` | completed frames, and the brush states they show |
//! | [`offscreen`] | the desk without a window |

pub mod backdrop;
pub mod brush;
pub(crate) mod device_loss;
pub(crate) mod frame_reports;
pub(crate) mod gpu;
pub(crate) mod light_surface;
pub mod offscreen;
pub(crate) mod scene;
pub mod show_surface;
pub mod surface;
#[cfg(test)]
mod texels_tests;
pub(crate) mod tile_atlas;
pub(crate) mod view_light;
