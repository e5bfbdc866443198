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
//! | [`rheology`] | what the hand feels of wet paint |
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
//!
//! # Steps
//!
//! - Paint steps are .25 mm of the brush's way, or one cell where that is more; what is left of a way waits for more,
//!   or for the brush to lift. So neither sample rate nor steps show, and finer cells need no more steps. A blade and a
//!   head with a skin step a cell at a time: what a blade pushes goes before its edge, and a skin draws hairlines. A
//!   brush that the machine cannot follow takes steps two or four times as long; the solves carry that, so a replay
//!   does the same.
//! - A path begins with the last step of the brush's way down, on a palette with the last four, so a press that does
//!   not move prints, loads and is cleaned.
//! - Strips are drawn where they are in the middle of a step, and cover each cell by its area and by the share of the
//!   way for which they are over it. What strips cover of a cell is the product of what each leaves open; each strip
//!   gets the cells that it covers most. The lowest strip's share alone makes strokes 14 % thinner on cells twice as
//!   large.
//! - Transfer is a function of travel, and paint moves in as many parts as a step has cells, so how a way is cut does
//!   not show.
//!
//! # What a model brings
//!
//! Its step, what paint does at rest, its rheology, and how its paint is shown (`ShowPaint` in `maulstick-appearance`); its
//! entry (`maulstick-model-entry`) has them all. Paint is in
//! counts by slot, on which wells, fills, drying, rewetting and the ledger work, and in planes of its own. A step
//! depends on the cells around the brush alone, never on what else its window holds. Ways of using a brush (`Handling`)
//! are parameters of the step and travel in the scene; what a mode creates or destroys is an account of the ledger. A
//! rag would be another exchange in `transfer`.

pub mod brush;
pub mod footprint;
pub mod interface;
pub mod modes;
pub mod path;
pub mod rheology;
pub mod transfer;
pub mod trial;
