//! Conversion between paint models that show the same counts in different colours.
//!
//! Every model counts its paint by slot, so a conversion moves no volume: each cell keeps the quanta of each of its
//! layers, and its thinner and varnish. Only the colours differ. Kubelka-Munk films mix yellow and blue to green, volumes to grey
//! ([`Colouring`](maulstick_appearance::colouring::Colouring)); a thick dark glaze is nearly black as a film and has
//! its tint as a volume. So the paints of each layer are fitted, from the bottom up: those of the same volume that are
//! nearest in ΔE₀₀ to the old appearance of the layer over all below it.
//!
//! | module | holds |
//! | --- | --- |
//! | `palette` | the paints that a fit may use, as numbers |
//! | `shown` | stacked layers of a tile in either colouring |
//! | `cell` | colour of a layer of one cell, and its slopes by the shares of the paints |
//! | `cell_fit` | fits of a cell's layers |
//! | `fit` | nearest shares: Gauss-Newton steps on the simplex |
//! | `program` | the quadratic program of a step |
//! | `masstones` | starting mixtures of a fit without a near neighbour |
//! | [`Converter`] | the paint of a tile |
//!
//! A tile of yellow over blue paint, converted from films to volumes:
//!
//! ```
//! use maulstick_appearance::Appearance;
//! use maulstick_appearance::colouring::Colouring;
//! use maulstick_canvas::planes::TILE_CELLS;
//! use maulstick_canvas::quantum::QUANTUM_M;
//! use maulstick_canvas::tile::Tile;
//! use maulstick_convert::{Converter, TileGround};
//! use maulstick_dab::layers::VOLUMES;
//! use maulstick_optics::{PaintLibrary, Studio, Under};
//!
//! # fn main() -> Result<(), maulstick_optics::PaintError> {
//! let library = PaintLibrary::measured()?;
//! let mut studio = Studio::daylight();
//! let paints = ["Ultramarine Blue", "Hansa Yellow Opaque", "Titanium White", "Phthalo Green Blue Shade"];
//! for paint in paints {
//!     studio.add(library.find(paint)?);
//! }
//! let white = vec![0.9; studio.wavelengths()];
//! let quanta = (60e-6 / QUANTUM_M).round() as f32;
//! let plane = |share: f32| vec![(share * quanta).round(); TILE_CELLS].into();
//! let tile = Tile::new([(0, plane(0.2)), (1, plane(0.8))].into_iter(), None);
//!
//! let look = Appearance::new(studio);
//! let ground = TileGround { under: Under::Even(&white), stays: &[] };
//! let converted = Converter::new(&look, Colouring::Films, Colouring::Volumes(&VOLUMES)).tile(&tile, ground);
//! let slots: Vec<usize> = converted.wet.iter().map(|(slot, _)| *slot).collect();
//! println!("{slots:?}, ΔE₀₀ {:.2} in the mean", converted.distance.mean());
//! assert!(converted.distance.mean() < 5.0, "the green of the films is met");
//! # Ok(())
//! # }
//! ```
//!
//! # The fit
//!
//! Gauss-Newton steps on the simplex, from the shares of the cell before, under a small cost for leaving the layer's
//! own mixture, or from masstones and a table of mixtures. A step is a quadratic program with three residuals, so a set
//! of free paints has four unknowns. For dry volumes the opacity is fitted too, as a film that would have stayed wet
//! over them. The model of a surface belongs to its materials, so steps, versions and undo include a conversion. Models
//! whose colourings are equal keep their counts as they are.

mod cell;
mod cell_fit;
mod fit;
mod masstones;
mod palette;
mod program;
mod shown;
mod tile;

pub use tile::{Converted, Converter, Distance, Farthest, OBVIOUS_DELTA_E, TileGround};
