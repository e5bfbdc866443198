//! The graphics device: stages of the simulation in WGSL, each with a twin in Rust.
//!
//! | module | holds |
//! | --- | --- |
//! | [`device`] | the device, its faults as values |
//! | [`models`] | the paint models that it computes |
//! | [`films`] | Kubelka-Munk films of many tiles at once |
//! | [`impasto`] | the paint model `impasto` |
//! | [`dab`] | the paint model `dab` |
//! | `steps` | what their steps share |
//! | [`stokes`] | flow and transport of Stokes Paint, and the flow in the paint model `stokes` |
//! | `stage` | a compute shader and its pipelines |
//! | `batch` | tiles as the shaders take them |
//! | `arena` | buffers that are used again |
//! | `shade_films`, `bake_films` | the stages of films |
//!
//! A film of blue paint over white, on the graphics device and on the processor. Without a device the processor computes
//! both:
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
//! Whole steps of `impasto` and `dab`; of `stokes` the flow around the brush; nothing of `marker`. It also computes the
//! films of all models but `dab`, which has colours of its own. Surfaces with wells, the sampler and the vacuum cleaner
//! stay with the processor. Exports use the processor alone, for the same bytes everywhere; a device promises the same
//! bytes for one adapter and driver, and which backend paints is journalled.
//!
//! # Steps
//!
//! - A window and its brush's load stay on the device from a stroke's first step until they are *settled*, before
//!   anything else reads them. Steps are submitted up to 64 at a time; a stroke sees how full its brush is at its
//!   beginning and after every 256 steps, not when somebody looks, so the same adapter paints the same bytes.
//! - Unsettled steps are kept. When the device is lost or its memory full, the processor repeats them and goes on, no
//!   quantum is missing, and the switch is journalled at the stroke's end. A painting recovered in mid-stroke repeats
//!   its last second on the processor.
//! - What does not depend on the model is in `steps`; a model is a list of stages and a planner that turns a step into
//!   dispatches, beside the processor's model. Tests hold every stage beside its twin, and whole strokes beside the
//!   processor's.
//! - `impasto`: an indirect dispatch skips the rest where nothing is touched; what is asked of one donor is summed in
//!   integers before it is truncated, so the books balance to zero.
//! - `dab`: the processor knows which blends a step has, and sends a record for each; the head is drawn once a drawing,
//!   and a dispatch blends it at each place. Thresholds are the processor's in fixed point and quotients are rounded as
//!   it rounds them, so on the same drawing both leave the same counts. Reservoirs are filled in f32.
//!
//! # Flow
//!
//! - The unified solver in f32: always the same dispatches over one buffer, sums reduced in a fixed order, quotients
//!   kept on the device and guarded against division by zero, nothing read back within a step. The smoother is a
//!   Chebyshev polynomial of damped Jacobi steps, symmetric and without order; one workgroup a component does all
//!   levels of 2048 cells and fewer.
//! - Fields have the processor's layout; whoever writes beside a periodic side writes the copy too. An image of a
//!   search direction that cancels is made orthogonal again by dispatches that otherwise return at once. Distances and
//!   velocities of solids come from the processor.
//! - `auto` gives the device windows of 16,384 cells and more, below which its 300 dispatches take longer than a core
//!   does; `gpu` gives it all. Windows that do not fit are `GpuError::Window`. `GpuFlow::restart` takes another window
//!   into the same buffers, cleared, so no window sees one before it.

mod arena;
mod bake_films;
mod batch;
pub mod dab;
pub mod device;
pub mod films;
pub mod impasto;
pub mod models;
mod shade_films;
mod stage;
mod steps;
pub mod stokes;

pub use device::{AdapterReport, Choice, Device, GpuError, adapters};
pub use films::GpuFilms;
pub use models::DeviceModel;
pub use steps::model::{GpuModel, MakeModel};
pub use steps::traffic::Traffic;
pub use stokes::{FlowState, GpuBrushFlow, GpuFlow, Paints, Tuning};
