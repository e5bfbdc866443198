//! Parts of several panels and dialogs that know the rig.
//!
//! | module | holds |
//! | --- | --- |
//! | [`brush_gauge`] | colours of the brush in the hand, and how full it is |
//! | [`context`] | state that a panel reads and changes |
//! | [`key_picture`] | a small picture of what the most used keys do |
//! | [`mixture_field`] | a field for a mixture |
//! | [`progress`] | progress of long work |

pub(crate) mod brush_gauge;
pub(crate) mod context;
pub(crate) mod key_picture;
pub(crate) mod mixture_field;
pub(crate) mod progress;
