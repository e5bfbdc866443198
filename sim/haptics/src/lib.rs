//! Force feedback without a device: the force of a contact model, and the servo that turns models
//! into forces a thousand times a second. Pure, without allocation, driven by whatever clock calls
//! it.
//!
//! | module | holds |
//! | --- | --- |
//! | [`force_law`] | normal force by depth: eq. 8.1, the Hermite curve, a local force |
//! | [`friction`], [`grain`] | what is felt across the normal |
//! | [`relief`] | heights over the plane: force by depth and slope, stiffness within bounds |
//! | [`contact`] | the force of one contact model at one pose |
//! | [`guide`] | the force of a guide, which holds the hand to a recorded path |
//! | [`bartlett_hanning`] | the filter between a slow solver and a hand at 1 kHz |
//! | [`fluid`] | the force of moving paint, from a solver slower than the hand |
//! | [`recipient`] | the device, session and brush that accept a model |
//! | [`servo`] | one tick: models, ageing, limits |
//! | [`plant`] | a device and a hand that hold each other, for the simulated stylus and for tests |
//! | [`extent`] | how far a tip moves |
//!
//! `tools/grid` tries hands, walls, rates and losses by the thousand: whether the servo is stable.
//!
//! # Guards
//!
//! - Force latches at zero, until it is re-armed, for a value that is not finite, a hand that the device drives, or one
//!   that shakes however soft the wall. Then follow ageing, the newest model, largest force by motor heat, and slew. No
//!   law is steeper than the device bears.
//! - Force begins where little is asked for, .2 N on the hand: a hand deep in the canvas at the start, after a fault or
//!   when force is switched on is not pushed out, and feels nothing until it has come up.
//! - The passivity observer pairs the held force with the way gone in the step, less what the same models would have
//!   given without samples and what the device damps itself. So it never acts below the bound b > K·T/2, nor for a
//!   plane that moves. It counts friction at rest only while nothing gives way.
//! - What it cannot see, a force that comes late, shows as a hand that turns round 10 to 60 times a second: the wall
//!   gets softer, and hard again only while the hand is away.
//! - A fast hand gets less force, none from nine tenths of the fault's speed, and in contact it does not come back.
//!
//! # Forces
//!
//! - Paint drags by f₀ + J·v from a solver of 15 to 60 Hz. A J that could drive the hand is refused; all work counts
//!   for the observer. f₀ alone fades over the second period without a message, since the paint may have come to rest.
//! - Relief is a potential of 16 × 16 B-spline heights, so a closed way gives nothing. Heights are smoothed to bounded
//!   slope and curvature, and the law softened by both. A new patch fades in as models do.
//! - Torque is the lever from the ferrule to the undeformed tip times the force after its limits, so both have one
//!   potential.
//! - A guide stands beside the contact models within all guards: at most .6 N, 100 N/m and a quarter of what the device
//!   bears, an engagement and fading of its own, one observer, heat bound and slew for both. What the hand's motion
//!   does not explain is spread over .2 s. The message is a piece of path, 100 times a second; only its sender knows
//!   the whole and how far the hand has come.
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
