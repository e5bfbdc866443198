//! IMPaSTo (Baxter 2004, ch. 6): paint that the brush pushes, leaves and takes up.
//!
//! A whole step reads from top to bottom in [`step`]; each stage of fig. 6.3 is a file.
//!
//! | module | stage |
//! | --- | --- |
//! | [`footprint`] | 1: what of the head reaches which cell, and how deep |
//! | [`band`] | … in rows, those of one core each |
//! | [`velocity`] | 2: where the paint under it goes |
//! | [`advection`] | 3: the paint goes there, counted |
//! | [`exchange`] | 4 and 5: Algorithm 3, both ways |
//! | [`bristle_flow`] | paint moves within the head |
//! | [`modes`] | the sampler and the vacuum cleaner, in place of 2 to 5 |

pub mod advection;
pub mod band;
pub mod bristle_flow;
pub mod contact;
mod draw_skin;
pub mod exchange;
pub mod footprint;
pub mod levelling;
pub mod modes;
mod rasterizer;
pub mod seep;
pub mod step;
pub mod velocity;

pub use step::Impasto;

/// Smaller footprints run on one core: fork-join would cost more than it saves.
const PARALLEL_MIN_CELLS: usize = 400;
