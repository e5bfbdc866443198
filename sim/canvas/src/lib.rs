//! Counted paint on surfaces: tiles and their versions, the relief under them, and windows leased on them.
//!
//! Pure, and it knows neither brush nor light: a paint model moves the counts of a window, and whoever shows them
//! computes their colour.
//!
//! | module | holds |
//! | --- | --- |
//! | [`quantum`] | the unit in which paint is counted |
//! | [`planes`], [`own_plane`] | planes of counts, and those that a paint model keeps of its own |
//! | [`tile`], [`store`] | tiles, the tiles of a surface with their versions |
//! | [`dry`], [`rewet`], [`wet_over`] | what has dried, layer over layer, what stayed wet over it, and what becomes wet again |
//! | [`page`] | pages in memory, and the document behind them |
//! | [`relief`] | what catches paint: tooth, made or from a picture, and the ride of a bristle over it |
//! | [`window`] | leased tiles as contiguous planes, on which kernels work |
//! | [`assets`] | pictures and spectra that a painting holds |
//!
//! A drop on linen, taken back by putting the older version of its tile in place again:
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

pub mod assets;
pub mod dry;
mod error;
pub mod layered;
pub mod own_plane;
pub mod page;
pub mod planes;
pub mod quantum;
pub mod relief;
pub mod rewet;
pub mod store;
pub mod tile;
pub mod wet_over;
pub mod window;

pub use error::EditError;
