//! Counted paint on surfaces: tiles and their versions, the relief under them, and windows leased on them.
//!
//! It depends on neither brush nor light: a paint model moves the counts of a window, and the appearance computes their
//! colour.
//!
//! | module | holds |
//! | --- | --- |
//! | [`quantum`] | the unit in which paint is counted |
//! | [`planes`], [`own_plane`] | planes of counts, and a paint model's own planes |
//! | [`sheet`] | what lies over the rest of its cell |
//! | [`tile`], [`store`] | tiles, the tiles of a surface with their versions |
//! | [`dry`], [`rewet`] | dried layers, and their rewetting |
//! | [`page`] | pages in memory, and the document behind them |
//! | [`relief`] | the surface that catches paint: tooth, generated or from a picture, and the ride of a bristle over it |
//! | [`window`] | leased tiles as contiguous planes, on which kernels work |
//! | [`assets`] | pictures and spectra of a painting |
//!
//! A drop on linen, undone by restoring the older version of its tile:
//!
//! ```
//! use maulstick_canvas::relief::{Relief, tooth::Tooth};
//! use maulstick_canvas::store::TileStore;
//! use maulstick_canvas::window::Window;
//!
//! let cell_m = 2.5e-4;
//! let linen = Relief::new(Tooth::new("linen", 1, cell_m).expect("a kind of tooth"), cell_m);
//! let mut store = TileStore::new([100, 90]);
//! let all = store.around([0, 0], [100, 90]).expect("a surface");
//!
//! let mut window = Window::open(&mut store, all, &linen).expect("not leased");
//! let cell = 40 * window.width() + 30;
//! window.plane_mut(0)[cell] = 1e6;
//! window.touch_cells(&[cell]);
//! let (mut newest, mut older) = (1, Vec::new());
//! window.commit(&mut store, &mut newest, |id, version| older.push((id, version)));
//! window.close(&mut store);
//! assert_eq!(store.counts()[0], 1_000_000);
//!
//! for (id, version) in older {
//!     store.replace(id, version);
//! }
//! assert_eq!(store.counts()[0], 0);
//! ```
//!
//! # Counting
//!
//! One thickness unit is 25 mm; a quantum is 2⁻²⁴ of it (1.5 nm) on one cell. A cell stores one count for each paint,
//! exact in f32 up to one unit, its capacity. Requests of several cells to one donor are summed, scaled together if
//! they exceed its stock, truncated once, taken from one side and given to the other; so the ledger balances to zero in
//! any order of cells.
//!
//! # Tiles, pages, layers
//!
//! - Tiles are 64×64 cells, immutable and reference-counted. A window leases whole tiles, copies them into contiguous
//!   planes for kernels, and writes them back as new versions; undo swaps versions.
//! - A page holds the counts of a tile, wet or dried, or the load of a brush, and never changes. It may leave memory
//!   once the document has it, and is read back on demand; the last owner to drop it lets the document delete it.
//! - Dried paint is a list of layers shared with older versions of the tile: drying a whole tile moves its planes by
//!   reference. Pages and links are numbered as they are made. A wet page older than the newest link is the remainder
//!   of that link's drying, so the link grows; a newer page gets a new link of the same layer, because two mixtures are
//!   not one.
//! - Models keep planes of their own beside the counts (kind, type, values a cell); store, history and document keep
//!   them without knowing what they mean.
//! - Bristles ride on the upper envelope of tooth and dry paint under parabolas of 28 mm radius, as stiff as a bristle
//!   is along itself. Tooth is a seeded weave or grain, or comes from a picture.

pub mod assets;
pub mod dry;
mod error;
pub mod own_plane;
pub mod page;
pub mod planes;
pub mod quantum;
pub mod relief;
pub mod rewet;
pub mod sheet;
pub mod store;
pub mod tile;
pub mod window;

pub use error::CanvasError;
