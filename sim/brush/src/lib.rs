//! vBRUSH (Baxter 2004, ch. 3): the head of a brush as spines that bend to the least energy.
//!
//! Pure: stylus samples and the scene come in, [`BrushState`](maulstick_types::brush::BrushState)s go out, and time
//! is in the messages.
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
//! | [`speed_limit`] | the speed above which a brush restarts |
//! | [`head_solver`] | a solved head: its spines among obstacles and each other |
//! | [`mark`], [`lead`] | the mark of a brush, and the lead that brings it under the point of a pen |
//! | [`head_stiffness`] | its stiffness, for the force on the hand |
//! | [`placement`], [`palette_place`] | placement of surfaces and of the palette on the desk |
//! | [`model`] | the brush that follows a stylus |
//! | [`single_spine`] | a single spine, from a file and a list of poses |
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
//!
//! # Solving
//!
//! - The unknowns of a spine are segment directions, not joint angles: energy and constraints depend on directions
//!   alone, joints are linear in them, and no pose is singular. Messages carry θ and φ.
//! - A head is solved spine by spine, each by a Newton method with an active set of touching joints. Neighbours keep
//!   their places of the last solve. Bonds hold each spine to the *core*, one spine for the mean of all that is
//!   solved first, because separate spines would each give way to a different side. Friction is iterated until it
//!   agrees with the normal forces.
//! - A sticking contact keeps its anchor; a new anchor at each solve would creep, since friction is rounded off.
//! - Joints stay outside of every obstacle in reach; against a raised palette, the face that they are farthest
//!   outside of counts.
//! - The hand feels the solved head: k₁ of its contact model is the force of all spines divided by the depth.
//!
//! # From samples to solves
//!
//! - A touching brush is solved every .175 mm of the handle's path, the parabola through the samples, counted across
//!   samples, and halfway where a joint in contact would move more than .25 mm. So the result does not depend on the
//!   sample rate. Steps are measured on the handle's path, not on the motion of strips: after one slip, the remainder
//!   of a strip's motion would put all later steps out of phase. Chords in place of the parabola, or fewer solves,
//!   show between sample rates. A sample between two solves gives a preview, which is shown and not painted.
//! - Time that does not advance restarts the brush at its new pose, and paints nothing between.
//! - A pause up to .3 s in contact (a stalled pen, late frames) is interpolated; after a pause much longer than the
//!   interval before it, the parabola never runs backward. A longer pause begins another stroke with the same bend: a
//!   head that landed anew would be dragged round and leave a notch.
//! - A stroke lasts from the first contact to the last. Contacts less than 150 ms apart are one stroke, and so are
//!   all of one press of a pen or the mouse.
//! - Above 20 m/s, measured over a frame, a brush in contact restarts, live as offline, so the solves of a sample are
//!   bounded.
//! - A pen without pressure holds its brush so high that each joint of the unbent head clears what lies below by 5
//!   mm.
//! - A pen's first samples wait for 1 mm of path, at most .1 s, and are shown as previews; the head is then laid down
//!   along the stroke, over a run-up that paints nothing. A head lowered straight down spreads or buckles, and leaves
//!   an anvil or a hook once it is dragged.
//!
//! # Strips
//!
//! On coarse cells a head is thinned: its strips are halved in number while they stay no wider than two cells of the
//! canvas at its zoom. Strips follow a sequence whose beginning is as even as the whole, so those left keep their
//! places, lifts and capacities. Blades, whose strips are a line, are not thinned. Each load and each stroke disturbs
//! tresses and tips, which also regroup along the stroke, seeded by the painting's number of strokes, so a replay has
//! the same streaks.

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
pub use spines::{core_spine, permanent_set, single_spine, spine, spine_layout, spine_root};
pub use surfaces::{desk, palette_place, placement};
