//! Settings that outlive the window.
//!
//! | module | holds |
//! | --- | --- |
//! | [`preferences`] | the file of them |
//! | `look`, `units` | text size and theme; units of lengths |
//! | `window_side` | sides of the window |
//! | `presets` | brushes with their paint, by name |
//! | `brush_memory` | the brush in the hand, from session to session |
//! | `paint_sets` | sets of paints for the palette |
//! | `brush_library` | the library's brushes |
//! | `brush_load` | the mixtures that a brush takes up |

pub(crate) mod brush_library;
pub(crate) mod brush_load;
pub(crate) mod brush_memory;
pub mod look;
pub(crate) mod paint_sets;
pub mod preferences;
pub(crate) mod presets;
pub mod window_side;
