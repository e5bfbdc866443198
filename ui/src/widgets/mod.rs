//! Parts that panels and dialogs are made of.
//!
//! | module | holds |
//! | --- | --- |
//! | [`arrow_keys`] | arrow keys on a field that has the keyboard |
//! | [`brush_gauge`] | colours of the brush in the hand, and how full it is |
//! | [`context`] | state that a panel reads and changes |
//! | [`key_picture`] | a small picture of what the most used keys do |
//! | [`rows`], [`labelled`] | rows of a panel: a word and a control |
//! | [`pending`] | a value that the rig has not confirmed yet |
//! | [`notifications`] | messages to the painter |
//! | [`progress`] | progress of long work |
//! | [`swatches`] | colour patches of paints |

pub(crate) mod arrow_keys;
pub(crate) mod brush_gauge;
pub(crate) mod context;
pub(crate) mod key_picture;
pub(crate) mod labelled;
pub(crate) mod notifications;
pub(crate) mod pending;
pub(crate) mod progress;
pub(crate) mod rows;
pub(crate) mod swatches;
