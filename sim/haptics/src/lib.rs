//! Force feedback without a device: the force of a contact model, and the servo that turns models
//! into forces a thousand times a second. Pure, without allocation, driven by whatever clock calls
//! it.
//!
//! | module | holds |
//! | --- | --- |
//! | [`law`] | normal force by depth: eq. 8.1, the Hermite curve, a local force |
//! | [`friction`], [`grain`] | what is felt across the normal |
//! | [`contact`] | the force of one contact model at one pose |
//! | [`address`] | whom a model is for |
//! | [`servo`] | one tick: models, ageing, limits |
//! | [`plant`] | a device and a hand that hold each other, for the simulated stylus and for tests |
//! | [`grid`] | hands, walls, rates and losses by the thousand: whether the servo is stable |

pub mod address;
pub mod contact;
pub mod friction;
pub mod grain;
pub mod grid;
pub mod law;
pub mod plant;
#[cfg(test)]
mod scaled;
pub mod servo;
#[cfg(test)]
mod stability;

pub use address::Address;
pub use contact::{Contact, Felt};
pub use plant::{Hand, Plant};
pub use servo::fault::Fault;
pub use servo::kept::Kept;
pub use servo::limits::Limits;
pub use servo::{Sender, Servo, Switch, Tick};
