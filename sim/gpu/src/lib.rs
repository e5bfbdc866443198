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
