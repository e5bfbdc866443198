//! What every paint model works with: a brush on a surface, in cells and quanta, and the interface behind which a model
//! moves the paint of one step.
//!
//! Pure, and it knows no model. [`PaintModel`](interface::PaintModel) is the interface; what touches what is the same for
//! all models on cells, so the footprint of a head is found here.
//!
//! | module | holds |
//! | --- | --- |
//! | [`interface`] | the interface of paint models: a step, and what it reports |
//! | [`brush`] | head, load and traits of a brush, in cells and quanta |
//! | [`path`] | its motion cut into steps |
//! | [`footprint`] | the cells that a head touches in a step, and how deep |
//! | [`transfer`] | how much goes between brush and canvas along a way |
//! | [`modes`] | the sampler and the vacuum cleaner |
//! | [`trial`] | a brush on a bare surface, to measure a model by itself |
//!
//! A full round brush and its load, as a model finds it:
//!
//! ```
//! use maulstick_brush::{BrushFile, Head};
//! use maulstick_model::brush::load::{BrushLoad, Half};
//! use maulstick_model::brush::traits::BrushTraits;
//!
//! # fn main() -> Result<(), maulstick_brush::BrushError> {
//! let file = BrushFile::library("round")?;
//! let head = Head::of(&file);
//! let traits = BrushTraits::of(&file, 2.5e-4, 1.0);
//! let mut load = BrushLoad::clean(head.strips());
//! assert_eq!(load.fullness(&traits), 0.0);
//! load.fill(&head, &traits, &[(0, 1.0)], None, (Half::Both, 1));
//! assert!(load.fullness(&traits) > 0.9);
//! assert_eq!(load.total(), load.counts()[0]);
//! # Ok(())
//! # }
//! ```

pub mod brush;
pub mod footprint;
pub mod interface;
pub mod modes;
pub mod path;
pub mod transfer;
pub mod trial;
