//! The graphics device, and what paint models need to run on it: stages of the simulation in WGSL, each with a twin in Rust.
//! It knows no model: the twin of a model lies in the model's folder, in its module `device`.
//!
//! | module | holds |
//! | --- | --- |
//! | [`device`] | the device, its faults as values |
//! | [`films`] | Kubelka-Munk films of many tiles at once |
//! | [`steps`] | steps of a brush on the device, whatever the model |
//! | [`on_device`] | models as the registry makes them |
//! | [`arena`] | buffers that are used again |
//! | `stage` | a compute shader and its pipelines |
//! | `batch` | tiles as the shaders take them |
//! | `shade_films`, `bake_films` | the stages of films |
//!
//! It also computes the films of all models whose colours are films. Surfaces with wells, the sampler and the vacuum
//! cleaner stay with the processor. Exports use the processor alone, for the same bytes everywhere; a device promises the
//! same bytes for one adapter and driver, and which backend paints is journalled.
//!
//! ```no_run
//! use maulstick_gpu::{Choice, Device, GpuFilms};
//!
//! let device = Device::open(Choice::Auto)?;
//! let films = GpuFilms::new(device);
//! # Ok::<(), maulstick_gpu::GpuError>(())
//! ```
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
