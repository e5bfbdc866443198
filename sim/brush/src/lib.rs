//! vBRUSH (Baxter 2004, ch. 3): the head of a brush as spines that bend to the least energy.
//!
//! Pure: stylus samples and the scene come in, [`BrushState`](maulstick_types::brush::BrushState)s
//! go out, and time is in the messages.
//!
//! | module | holds |
//! | --- | --- |
//! | [`mod@file`] | the brush file and the library of brushes |
//! | [`gltf`] | a brush modelled in Blender |
//! | [`spine`] | a chain of segments: directions, joint angles, joints |
//! | [`spine_layout`] | places of the spines in the ferrule |
//! | [`spine_root`] | one spine and its frame there |
//! | [`core_spine`] | the bend that the spines of a head share |
//! | [`energy`] | spring, friction, damping, neighbours, bond: value, gradient, Hessian |
//! | [`qp`] | the quadratic program of one Newton step |
//! | [`blocks`] | symmetric matrices with a block for each pair of segments |
//! | [`solver`] | the constrained minimum; a whole solve reads from top to bottom |
//! | [`head`] | the bristle strips between the spines |
//! | [`skin`] | the surface around them |
//! | [`subdivide`] | Catmull-Clark subdivision |
//! | [`desk`] | surfaces, and where a stylus holds the ferrule |
//! | [`handle_path`] | the handle's path between samples |
//! | [`speed_limit`] | the speed beyond which a brush begins anew |
//! | [`head_solver`] | a solved head: its spines among obstacles and each other |
//! | [`mark`], [`lead`] | the mark of a brush, and the lead that brings it under the point of a pen |
//! | [`head_stiffness`] | its stiffness, as the hand feels it |
//! | [`placement`], [`palette_place`] | placement of surfaces and of the palette on the desk |
//! | [`model`] | the brush that follows a stylus |
//! | [`single_spine`] | one spine by itself, from a file and a list of poses |
//!
//! A round brush, pressed 3 mm onto a surface while it leans by 40°:
//!
//! ```
//! use maulstick_brush::BrushFile;
//! use maulstick_brush::head_stiffness::press;
//!
//! # fn main() -> Result<(), maulstick_brush::BrushError> {
//! let file = BrushFile::library("round")?;
//! let pressed = press(&file, f64::to_radians(40.0), &[0.0, 3e-3]);
//! assert!(pressed[1].force_n > pressed[0].force_n);
//! println!("{:.3} N", pressed[1].force_n);
//! # Ok(())
//! # }
//! ```

pub mod energy;
pub mod file;
mod follow;
pub mod gltf;
pub mod head;
pub mod head_solver;
pub mod head_stiffness;
mod numeric;
pub mod skin;
pub mod solver;
mod spines;
mod surfaces;

pub use file::{BrushError, BrushFile};
pub use follow::{handle_path, lead, mark, model, speed_limit};
pub use head::{Head, HeadPose, Hold};
pub use model::BrushModel;
pub use numeric::{blocks, qp, subdivide};
pub use solver::{Solution, Solver};
pub use spine::{Spine, SpineShape};
pub use spine_layout::SpineLayout;
pub use spine_root::SpineRoot;
pub use spines::{core_spine, single_spine, spine, spine_layout, spine_root};
pub use surfaces::{desk, palette_place, placement};
