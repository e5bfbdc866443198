//! Drawing of a brush.
//!
//! | module | holds |
//! | --- | --- |
//! | `geometry` | ferrule, handle and shadow discs |
//! | `bristles` | the head |
//! | `handle` | ferrule and handle |
//! | `cast_shadow` | the shadow pass |
//! | `paint_colour` | colours of the paint on the head |
//! | [`renderer`] | a brush from shadow to handle |
//! | [`thumbnail`] | a brush as a picture |
//! | `icon_cache` | thumbnails as textures of the window |

pub(crate) mod bristles;
pub(crate) mod cast_shadow;
pub(crate) mod geometry;
pub(crate) mod handle;
pub(crate) mod icon_cache;
pub(crate) mod paint_colour;
pub mod renderer;
pub mod thumbnail;
