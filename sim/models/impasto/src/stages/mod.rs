//! IMPaSTo (Baxter 2004, ch. 6): paint that the brush pushes, deposits and takes up.
//!
//! A whole step reads from top to bottom in [`step`]; each stage of fig. 6.3 is a file.
//!
//! | module | stage |
//! | --- | --- |
//! | [`footprint`](maulstick_model::footprint) | 1: contacts of the head with cells, and their depth |
//! | [`velocity`] | 2: velocity of the paint under it |
//! | [`advection`] | 3: motion of the paint, counted |
//! | [`exchange`] | 4 and 5: Algorithm 3, both ways |
//! | `overhang` | what goes over the border |
//! | [`sheets`] | what lies on top stays there |
//! | [`sides`] | deposits along the step |
//! | [`bristle_flow`] | paint moves within the head |
//! | [`rest`], [`levelling`] | after the stroke |
//! | [`modes`](maulstick_model::modes) | the sampler and the vacuum cleaner, in place of 2 to 5 |

pub mod advection;
pub mod bristle_flow;
pub mod exchange;
pub mod levelling;
mod overhang;
pub mod rest;
pub mod seep;
pub mod sheets;
pub mod sides;
pub mod step;
pub mod velocity;

pub use step::Impasto;
