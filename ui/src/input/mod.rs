//! Keys, mouse and gestures, and their requests.
//!
//! | module | holds |
//! | --- | --- |
//! | [`keys`] | actions and their default keys |
//! | [`keymap`] | the painter's keys |
//! | [`presses`] | presses of keys |
//! | [`pointer_path`] | path of the pointer, and where its button presses the brush |
//! | [`ruler`] | straight strokes |
//! | [`size_drag`] | width of the brush by dragging |
//! | [`pen`] | the pen over the window |
//! | [`navigation`] | wheel, drag and touch: moves the surfaces |
//! | [`clean_key`] | the key that cleans the brush, or lifts paint while it is held |
//! | [`palette_gesture`] | the wave of the brush that fetches the palette |
//! | [`brush_choice`] | the brush in the hand and its width |

pub(crate) mod brush_choice;
pub(crate) mod clean_key;
pub(crate) mod keymap;
pub(crate) mod keys;
pub(crate) mod navigation;
pub(crate) mod palette_gesture;
pub(crate) mod pen;
pub(crate) mod pointer_path;
pub(crate) mod presses;
pub(crate) mod ruler;
pub(crate) mod size_drag;
