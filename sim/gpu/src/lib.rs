//! The graphics device, and the machinery of paint models on it: stages of the simulation in WGSL, each with a twin
//! in Rust. It names no model: the device part of a model is in the model's folder, in its module `device`.
//!
//! | module | holds |
//! | --- | --- |
//! | [`device`] | the device, its faults as values |
//! | [`films`] | Kubelka-Munk films of many tiles at once |
//! | [`steps`] | steps of a brush on the device, whatever the model |
//! | [`on_device`] | models as the registry makes them |
//! | [`arena`] | buffers that are used again |
//! | `stage` | a compute shader and its pipelines |
//! | `batch` | tiles in the layout of the shaders |
//! | `shade_films`, `bake_films` | the stages of films |
//!
//! A film of blue paint over white, on the graphics device and on the processor. Without a device the processor
//! computes both:
//!
//! ```
//! use maulstick_gpu::{Choice, Device, GpuFilms};
//! use maulstick_optics::backend::TILE_CELLS;
//! use maulstick_optics::{CpuFilms, FilmBackend, FilmPlanes, PaintLibrary, Studio, Under};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut backend: Box<dyn FilmBackend> = match Device::open(Choice::Forced) {
//!     Ok(device) => Box::new(GpuFilms::new(device)?),
//!     Err(missing) => {
//!         eprintln!("{missing}");
//!         Box::new(CpuFilms::new())
//!     }
//! };
//! let mut studio = Studio::daylight();
//! let blue = studio.add(PaintLibrary::measured()?.find("Ultramarine Blue")?);
//! // From 0 to 80 µm along the tile.
//! let thickness_m: Vec<f32> = (0..TILE_CELLS).map(|cell| 8e-5 * cell as f32 / TILE_CELLS as f32).collect();
//! let white = vec![0.9; studio.wavelengths()];
//! let tile = FilmPlanes { paints: &[(blue, &thickness_m)], opacity: 1.0, under: Under::Even(&white) };
//! let [red, ..] = backend.shade(&studio, &[tile])?.remove(0);
//! let [on_cpu, ..] = CpuFilms::new().shade(&studio, &[tile])?.remove(0);
//! println!("{}: red falls from {:.2} to {:.2}", backend.name(), red[0], red[TILE_CELLS - 1]);
//! assert!(red[0] > 20.0 * red[TILE_CELLS - 1]);
//! assert!(red.iter().zip(&on_cpu).all(|(gpu, cpu)| (gpu - cpu).abs() < 1e-5));
//! # Ok(())
//! # }
//! ```
//!
//! # What a device computes
//!
//! Steps of the models that have a device part, and the films of all models whose colours are films. Surfaces with
//! wells, the sampler and the vacuum cleaner stay with the processor. Exports use the processor alone, for the same
//! bytes everywhere; a device gives the same bytes for one adapter and driver, and the journal names the backend.
//!
//! # Steps
//!
//! - A window and its brush's load stay on the device from a stroke's first step until they are *settled*, before
//!   anything else reads them. Steps are submitted up to 64 at a time. The brush's load is read back at the beginning
//!   of a stroke and after every 256 steps, never on demand, so the same adapter paints the same bytes.
//! - Unsettled steps are kept. When the device is lost or its memory full, the processor repeats them and continues
//!   without a missing quantum, and the switch is journalled at the stroke's end. A painting recovered in mid-stroke
//!   repeats its last second on the processor.
//! - Model-independent parts are in `steps`; a model is a list of stages and a planner that turns a step into
//!   dispatches, beside the processor's model. Tests compare every stage with its twin, and whole strokes with the
//!   processor's.

pub mod arena;
mod bake_films;
mod batch;
pub mod device;
pub mod films;
pub mod on_device;
mod shade_films;
mod stage;
pub mod steps;

pub use device::{AdapterReport, Choice, Device, GpuError, adapters};
pub use films::GpuFilms;
pub use on_device::{MakeModel, OnDevice};
