//! Force feedback without a device: the force of a contact model, and the servo that turns models into forces a
//! thousand times a second. Pure, without allocation, driven by the caller's clock.
//!
//! | module | holds |
//! | --- | --- |
//! | [`force_law`] | normal force by depth: eq. 8.1, the Hermite curve, a local force |
//! | [`friction`], [`grain`] | forces across the normal |
//! | [`relief`] | heights over the plane: force by depth and slope, stiffness within bounds |
//! | [`contact`] | the force of one contact model at one pose |
//! | [`guide`] | the force of a guide, which holds the hand to a recorded path |
//! | [`bartlett_hanning`] | the filter between a slow solver and a hand at 1 kHz |
//! | [`fluid`] | the force of moving paint, from a solver slower than the hand |
//! | [`recipient`] | the device, session and brush that accept a model |
//! | [`servo`] | one tick: models, ageing, limits |
//! | [`plant`] | a device in a hand, for the simulated stylus and for tests |
//! | [`extent`] | extent of a tip's motion |
//!
//! `tools/grid` tests the servo's stability on thousands of hands, walls, rates and losses.
//!
//! A hand in a pen grip presses 10 mm into a wall of 300 N/m for a second, is pushed back, and is given no energy:
//!
//! ```
//! use glam::DVec3;
//! use maulstick_haptics::{Contact, Hand, Limits, Plant, Sender, Servo};
//! use maulstick_types::haptics::{ContactModel, ForceLaw};
//!
//! const TICK_S: f64 = 1e-3;
//! const HEAD_M: f64 = 0.025;
//! let wall = ContactModel::bare(ForceLaw::Rigid { stiffness_n_m: 300.0 }, HEAD_M);
//! let wall = Contact::new(&wall).expect("finite numbers, a unit normal");
//! let mut servo = Servo::new(Limits::default());
//! let mut hand = Plant::omni(Hand::PEN_GRIP, DVec3::Z * 0.05);
//! let mut force = DVec3::ZERO;
//! for tick in 0..2000 {
//!     // The hand comes down from 25 mm above the canvas, and wants to be 10 mm below it from .5 s on.
//!     let share = (f64::from(tick) / 500.0).min(1.0);
//!     let target = DVec3::Z * (HEAD_M + 0.025 - 0.035 * share);
//!     if tick % 15 == 0 {
//!         servo.receive(wall, Sender::Same);
//!     }
//!     force = servo.step(&hand.handle(), TICK_S).0;
//!     hand.advance(force, target, TICK_S);
//! }
//! println!("{:.2} N, {:.1} mJ given to the hand", force.z, 1e3 * hand.given_j());
//! assert!(servo.fault().is_none() && force.z > 0.8);
//! assert!(hand.given_j() < 0.0, "a hand that presses puts energy into the wall");
//! ```
//!
//! # Guards
//!
//! - Force latches at zero, until it is re-armed, for a value that is not finite, a hand that the device drives, or one
//!   that shakes at the softest wall. Then follow ageing, the newest model, the largest force by motor heat, and slew.
//!   No law is steeper than the device's bound.
//! - Force begins only where the models ask for at most .2 N: a hand deep in the canvas at the start, after a fault or
//!   when force is switched on is not pushed out, and gets no force until it has come up.
//! - The passivity observer pairs the held force with the motion of the step, less the work of the same models without
//!   sampling and the device's own damping. So it never acts below the bound b > K·T/2, nor for a plane that moves. It
//!   counts friction at rest only while nothing gives way.
//! - It cannot see a late force, which shows as a hand that reverses 10 to 60 times a second: the wall gets softer, and
//!   hard again only while the hand is away.
//! - A fast hand gets less force, none from nine tenths of the fault's speed on, and in contact the force does not
//!   return.
//!
//! # Forces
//!
//! - Paint drags by f₀ + J·v from a solver of 15 to 60 Hz. A J that could drive the hand is rejected; the observer
//!   counts all its work. f₀ alone fades over the second period without a message, since the paint may have come to
//!   rest.
//! - Relief is a potential of 16 × 16 B-spline heights, so a closed path gains nothing. Heights are smoothed to bounded
//!   slope and curvature, and the law is softened by both. A new patch fades in as models do.
//! - Torque is the lever from the ferrule to the undeformed tip times the force after its limits, so both have one
//!   potential.
//! - A guide stands beside the contact models within all guards: at most .6 N, 100 N/m and a quarter of the device's
//!   bound. It has its own engagement and fading, and shares observer, heat bound and slew with them. A change not
//!   caused by the hand's motion is spread over .2 s. The message is a piece of path, 100 times a second; only its
//!   sender has the whole path and the hand's progress.
//! - A scaled device is a servo in desk lengths whose force is divided by the scale and whose torque by its square;
//!   stiffness and damping, and so their bounds, are the same numbers in the hand.

pub mod bartlett_hanning;
#[cfg(test)]
mod closed_loop_tests;
pub mod contact;
pub mod extent;
pub mod fluid;
pub mod force_law;
pub mod friction;
pub mod grain;
pub mod guide;
pub mod plant;
pub mod recipient;
pub mod relief;
pub mod servo;

pub use contact::{Contact, ContactForce};
pub use fluid::Fluid;
pub use guide::Guide;
pub use plant::{Hand, Plant};
pub use recipient::Recipient;
pub use servo::Servo;
pub use servo::fault::Fault;
pub use servo::limits::Limits;
pub use servo::persistent::ServoMemory;
pub use servo::tick::{Sender, Switch, Tick};
