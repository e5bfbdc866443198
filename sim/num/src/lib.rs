//! Elementary functions with the same bytes on every machine, rigid motions, loops for wide registers and work shared
//! among cores.
//!
//! std's transcendentals call the system's library, which uses fused multiply-add where the
//! processor has it: two machines would paint two pictures. The functions of f64 are those of the
//! `libm` crate, plain Rust without such dispatch; those of f32 are written so that a loop over a
//! plane vectorises and so that a shader can hold the same polynomial.
//!
//! Neither the registers ([`lanes`], [`wide`]) nor the number of cores ([`fork_join`]) change a byte of the results.
//!
//! ```
//! use maulstick_num::{cos, sin_cos};
//!
//! let (sine, cosine) = sin_cos(0.5);
//! assert_eq!(cosine, cos(0.5));
//! assert!((sine * sine + cosine * cosine - 1.0).abs() < 1e-15);
//! ```
//!
//! # Same bytes
//!
//! Kernels that gain from it are compiled for AVX-512, AVX2 and neither, and all add, multiply and round alike. No
//! `mul_add`, no transcendentals of std (`clippy.toml` forbids both), no crate that dispatches to fused multiply-add on
//! the replay path. Every random quantity has a seed. A step is shared by all cores but one, at most 16, in shares of
//! about a thousand cells; cores write to different places and results are combined in a fixed order, so the bytes are
//! those of one core. The cuts of shares follow measured times, which changes no byte either.

mod elementary;
pub mod fork_join;
pub mod geometry;
pub mod lanes;
pub mod select;
pub mod wide;

pub use elementary::{Decay, acos, atan2, cos, decay_f32, exp, exp_f32, ln, powf, sin, sin_cos};
