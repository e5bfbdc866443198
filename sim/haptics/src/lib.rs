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
//! | [`fluid`] | the force of moving paint, from a solver slower than the hand |
//! | [`recipient`] | the device, session and brush that accept a model |
//! | [`servo`] | one tick: models, ageing, limits |
//! | [`plant`] | a device and a hand that hold each other, for the simulated stylus and for tests |
//! | [`stability_grid`] | hands, walls, rates and losses by the thousand: whether the servo is stable |

#[cfg(test)]
mod closed_loop_tests;
pub mod contact;
pub mod fluid;
pub mod force_law;
pub mod friction;
pub mod grain;
pub mod guide;
pub mod plant;
pub mod recipient;
pub mod relief;
pub mod servo;
pub mod stability_grid;

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
