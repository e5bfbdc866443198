//! Force feedback without a device: the force of a contact model, and the servo that turns models
//! into forces a thousand times a second. Pure, without allocation, driven by whatever clock calls
//! it.
//!
//! | module | holds |
//! | --- | --- |
//! | [`contact`] | the force of one contact model at one pose |
//! | [`servo`] | one tick: models, ageing, limits |
//! | [`plant`] | a device and a hand that hold each other, for the simulated stylus and for tests |

pub mod contact;
pub mod plant;
pub mod servo;
#[cfg(test)]
mod stability;

pub use contact::Contact;
pub use plant::{Hand, Plant};
pub use servo::{Limits, Sender, Servo, Tick};
