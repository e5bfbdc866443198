//! From a colour to mixtures of paints.
//!
//! | module | holds |
//! | --- | --- |
//! | [`picker`] | the search for mixtures that come near a colour |
//! | [`proposals`] | rows of what was found |
//! | [`colour_square`] | choice of a colour by hue, saturation and brightness |
//! | [`colour_window`] | a colour that the painter has in mind |

mod colour_square;
pub(crate) mod colour_window;
pub(crate) mod picker;
pub(crate) mod proposals;
