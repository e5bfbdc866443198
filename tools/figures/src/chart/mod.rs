//! Pictures of mixtures.
//!
//! | module | holds |
//! | --- | --- |
//! | [`every_pair`] | the mixing chart of all paints |
//! | [`four_ways`] | one graded mixture by four ways of mixing |

pub(crate) mod every_pair;
pub(crate) mod four_ways;
