//! Common parts of all paint models: a brush on a surface, in cells and quanta, and the interface of a model that moves
//! the paint of one step.
//!
//! It names no model. [`PaintModel`](interface::PaintModel) is the interface; contacts are the same for all models on
//! cells, so the footprint of a head is computed here.
//!
//! | module | holds |
//! | --- | --- |
//! | [`interface`] | the interface of paint models: a step and its report |
//! | [`brush`] | head, load and traits of a brush, in cells and quanta |
//! | [`path`] | its motion cut into steps |
//! | [`footprint`] | the cells that a head touches in a step, and how deep |
//! | [`transfer`] | amount transferred between brush and canvas along a path |
//! | [`spread`] | a deposit along a step |
//! | [`modes`] | the sampler and the vacuum cleaner |
//! | [`rheology`] | properties of wet paint for the force on the hand |
//! | [`trial`] | a brush on a bare surface, to measure a model alone |
//!
//! A full round brush and its load, as input of a model:
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
//!
//! # Steps
//!
//! - Paint steps are .25 mm of the brush's way, or one cell where that is more; the remainder of a path waits for more,
//!   or for the brush to lift. So neither sample rate nor steps show, and finer cells need no more steps. A blade and a
//!   head with a skin step a cell at a time: a blade pushes paint ahead of its edge, and a skin draws hairlines. A
//!   brush that the machine cannot follow takes steps two or four times as long; the solves carry that, so a replay
//!   does the same.
//! - A path begins with the last step of the brush's descent, on a palette with the last four, so that a press without
//!   motion prints, loads and cleans.
//! - Strips are drawn at their place in the middle of a step, and cover each cell by its area and by the share of the
//!   path over it. The open share of a cell is the product of those of its strips; each strip gets the cells that it
//!   covers most. The lowest strip's share alone makes strokes 14 % thinner on cells twice as large.
//! - Transfer is a function of travel, and paint moves in as many parts as a step has cells, so the subdivision of a
//!   path does not show.
//!
//! # What a model brings
//!
//! Its step, the motion of paint at rest, its rheology, and the display of its paint (`ShowPaint` in
//! `maulstick-appearance`); its entry (`maulstick-model-entry`) has them all. Paint is in counts by slot, on which
//! wells, fills, drying, rewetting and the ledger work, and in planes of its own. A step depends on the cells around
//! the brush alone, never on the rest of its window. The handling of a brush (`Handling`) is a parameter of the step
//! and travels in the scene; paint created or destroyed by a mode is an account of the ledger. A rag would be another
//! exchange in `transfer`.

pub mod brush;
pub mod footprint;
pub mod interface;
pub mod modes;
pub mod path;
pub mod rheology;
pub mod spread;
pub mod transfer;
pub mod trial;
