//! From a colour to mixtures of paints.
//!
//! | module | holds |
//! | --- | --- |
//! | [`picker`] | the search for mixtures near a colour |
//! | [`proposals`] | rows of results |
//! | [`colour_square`] | choice of a colour by hue, saturation and brightness |
//! | [`colour_window`] | a colour of the painter's choice |

mod colour_square;
pub(crate) mod colour_window;
pub(crate) mod picker;
pub(crate) mod proposals;
