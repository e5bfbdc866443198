//! The brush node of a rig: stylus samples in; brush states, credit and contact models out.
//!
//! The node decodes, steps and encodes; transport and clock come from the bus.
//!
//! | module | holds |
//! | --- | --- |
//! | [`node`] | the node: its queues, its turn, its commands |
//! | [`arbiter`] | the choice among several devices that move one brush |
//! | [`path_simplifier`] | samples merged while credit is short |
//! | [`outbox`] | solved states that wait for credit |
//! | [`contact_model`] | the contact model for the hand |
//! | [`fluid_force`] | the drag of the paint on it |
//! | [`relief`] | the relief around the brush that it feels |
//!
//! The force that a brush pressed by a pen asks of a device, linear in the depth around where it is:
//!
//! ```
//! use maulstick_brush::{BrushFile, BrushModel};
//! use maulstick_brush_node::contact_model::{ForceKind, law};
//! use maulstick_painting::PaintingSetup;
//! use maulstick_types::Origin;
//! use maulstick_types::haptics::ForceLaw;
//! use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
//!
//! # fn main() -> Result<(), maulstick_brush::BrushError> {
//! let mut brush = BrushModel::new(BrushFile::library("round")?, 0.5);
//! brush.set_scene(&PaintingSetup::default().scene());
//! let pen = Origin { source: 1, epoch: 1 };
//! for step in 0..40u32 {
//!     let sample = StylusSample {
//!         pose: StylusPose::Contact {
//!             point_m: [1e-3 * f64::from(step), 0.0, 0.0],
//!             tilt_rad: DEFAULT_TILT_RAD,
//!             twist_rad: 0.0,
//!             pressure: 0.6,
//!         },
//!         in_range: true,
//!         ..StylusSample::away()
//!     };
//!     brush.follow(pen, 5_000_000 * u64::from(step), &sample);
//! }
//! let canvas = brush.plane().expect("over the canvas").clone();
//! let ForceLaw::Local { force_n, stiffness_n_m, .. } = law(ForceKind::Local, &mut brush, &canvas) else {
//!     panic!("the head touches");
//! };
//! println!("{:.2} N upward, {:.0} N/m", force_n[2], -stiffness_n_m[2][2]);
//! assert!(force_n[2] > 0.0 && stiffness_n_m[2][2] < 0.0);
//! # Ok(())
//! # }
//! ```
//!
//! # Credit
//!
//! - A live brush without credit merges: samples within half a cell of the chord are joined, others become sub-solves
//!   of one message, in the air the newest wins. Replayed samples are never merged. Waiting samples and the solves of a
//!   turn are bounded, so a flood ends with its last message.
//! - Samples that waited 100 ms are painted in steps twice as long, after 200 ms four times, until the brush lifts; a
//!   blade or a head with a skin keeps its own. Status and window show it.
//!
//! # Order
//!
//! - Strokes wait for what was asked for before them (`ui/pending` says how old the oldest is): the node solves what
//!   the hand did before, but no stroke that begins later. A brush file is taken up between two strokes, and the next
//!   waits until the paint has it. While a hand has the brush on a surface it is not changed, except by the cleaning
//!   key.
//! - A canvas that moves takes along nothing that the hand did before: samples are solved on the desk as it was before
//!   a newer scene is followed (a take follows at once), and each solve says its zoom. A zoom begins the brush anew in
//!   its stroke.
//! - A device keeps its stroke however late its next sample is, as long as no other is in range; one in range may take
//!   over after half a second, and after five any device that is heard lifts the brush.
//!
//! - A brush's file crosses the bus once (`brush/<brush>/def`); whoever needs strips and skin lays them over the joint
//!   angles. A bad file is rejected and the brush stays. Stiffness and wetness are commands to the paint node and
//!   travel in the scene.
//!
//! # For the hand
//!
//! - Forces do not cross the bus: the node sends contact models, which the device evaluates at 1 kHz. k₁ is the solved
//!   head's, or the brush file's five tuples, or the head linearised where it is (`force` of a device).
//! - Paint drags by a fluid force: each credit brings film, viscosity and length of the contact, and every 15 ms the
//!   node sends 20·μ·L with its Jacobian (Baxter 2004, eq. 8.8). Contact models have no drag, so the hand feels it once;
//!   the solve never waits for paint.
//! - The paint node sends relief only for devices with force; it is put on a grid around the hand's own tip, with the
//!   edges of canvas and palette.
//! - Without a paint node no contact models are sent.

pub mod arbiter;
pub mod contact_model;
pub mod fluid_force;
pub mod node;
pub mod outbox;
pub mod path_simplifier;
pub mod relief;

pub use node::{BrushDevices, BrushNode, BrushSettings};
