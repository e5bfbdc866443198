//! Editing of recorded motions of a stylus: cutting, joining, placing, mirroring, and filling an outline by example
//! (Baxter 2004, § 9.2).
//!
//! Pure: samples in, samples out. Only the place of the brush's point on the surface, its rotation and its times
//! change; heights above the surface and pressures stay, so the brush bends and touches as before.
//!
//! | module | holds |
//! | --- | --- |
//! | [`take_sample`] | a sample with its time; its point on the surface |
//! | [`strokes`](mod@strokes) | strokes of a motion, and their paths |
//! | [`cut`](mod@cut), [`join`] | a part of a motion; motions one after the other |
//! | [`placement`], [`mirror`] | motions scaled, turned, moved; mirrored |
//! | [`pace`] | motions that go faster or slower |
//! | [`outline`] | an area, and the parts of lines within it |
//! | [`example`], [`fill`](mod@fill) | measures of an example; an outline filled with its strokes |
//!
//! ```
//! use maulstick_motion::{Placement, TakeSample};
//! use maulstick_types::stylus::StylusSample;
//!
//! # fn main() -> Result<(), maulstick_motion::MotionError> {
//! let motion = [TakeSample { time_ns: 0, sample: StylusSample::away() }];
//! let moved = Placement::moved([0.01, 0.0]).motion(&motion, 0.0)?;
//! assert_eq!(moved[0].point(0.0)[0], 0.01);
//! # Ok(())
//! # }
//! ```
//!
//! # Mirroring
//!
//! A rotation R of the handle becomes M·R·B, where M mirrors the desk and B the brush in its broad side, for which each
//! head is symmetric.

pub mod cut;
mod error;
pub mod example;
pub mod fill;
pub mod join;
pub mod mirror;
pub mod outline;
pub mod pace;
pub mod placement;
mod random;
pub mod strokes;
pub mod take_sample;

pub use cut::{Part, cut};
pub use error::MotionError;
pub use example::Example;
pub use fill::{Fill, filled};
pub use join::joined;
pub use mirror::{Mirror, mirrored};
pub use outline::Outline;
pub use pace::{Pace, retimed};
pub use placement::Placement;
pub use strokes::{Stroke, strokes};
pub use take_sample::TakeSample;
