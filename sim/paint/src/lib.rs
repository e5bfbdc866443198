//! Paint on surfaces.
//!
//! Pure: brush states and commands come in, tiles and reports go out. [`Sequencer`] decides the
//! order and keeps the journal; [`Painting`] does what the journal says; a [`PaintModel`] moves the
//! paint of one step.
//!
//! | module | holds |
//! | --- | --- |
//! | [`quantum`] | the unit in which paint is counted |
//! | [`planes`], [`tile`], [`store`], [`window`] | planes of counts, tiles, their versions, and windows leased on them |
//! | [`page`], [`backing`] | pages in memory, and the document behind them |
//! | [`head`], [`path`] | the head of a brush in space, and its motion cut into steps |
//! | [`scale`], [`traits`] | a brush's lengths and traits in cells and quanta |
//! | [`dry`], [`rewet`] | what has dried, layer over layer, and becomes wet again |
//! | [`tooth`], [`tooth_picture`], [`relief`] | what catches paint |
//! | [`assets`], [`ground`] | pictures that a painting holds, and what lies under the paint |
//! | [`model`], [`impasto`] | paint models |
//! | [`transfer`] | how much goes between brush and canvas |
//! | [`load`], [`ledger`], [`history`] | what a brush carries, the books, undo |
//! | [`snapshot`] | the part of a document that is not tiles |
//! | [`clock`] | ticks, and the dryings that they drive |
//! | [`setup`] | the scene of a new painting |
//! | [`painting`], [`sequencer`] | the painting and its journal |
//! | [`light`], [`appearance`] | the light of the scene, and colour under it |
//! | [`blank_surface`], [`display`], [`lamp`] | a surface as shown: blank, unlit, lit |
//! | [`brush_colour`] | the paint on a brush as it is shown |
//! | [`bands`], [`picture`] | a surface row of tiles by row of tiles, and pictures of it |

pub mod appearance;
mod apply;
pub mod assets;
pub mod backing;
pub mod bands;
pub mod blank_surface;
pub mod brush_colour;
pub mod clock;
pub mod display;
pub mod dry;
mod error;
pub mod ground;
pub mod head;
pub mod history;
pub mod impasto;
pub mod lamp;
mod lattice_noise;
pub mod ledger;
pub mod light;
pub mod load;
pub mod model;
pub mod page;
pub mod painting;
pub mod path;
pub mod picture;
pub mod planes;
pub mod quantum;
pub mod relief;
pub mod rewet;
pub mod ride;
pub mod scale;
pub mod sequencer;
pub mod setup;
pub mod snapshot;
pub mod store;
pub mod streaks;
pub mod tile;
pub mod tooth;
pub mod tooth_picture;
pub mod traits;
pub mod transfer;
mod weave;
pub mod window;

pub use apply::{Applied, Apply};
pub use error::EditError;
pub use model::PaintModel;
pub use painting::Painting;
pub use sequencer::{Effect, Sequencer};
pub use setup::PaintingSetup;
