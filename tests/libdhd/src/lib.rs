//! A libdhd for tests: the C interface of Force Dimension's SDK 3.16 over a scripted device.
//!
//! Its shared library is opened by the driver under test in place of the vendor's. A test says by a [`Script`] what the
//! device is and senses, and reads every [`Call`] that moved something. Names, types and codes are those of the vendor's
//! public header (dhdc.h).
//!
//! | module | holds |
//! | --- | --- |
//! | [`script`] | what the device is, and what was called |
//! | [`control`] | how a test hands one in and gets the other out |
//! | `exports` | the C functions |

pub mod control;
mod exports;
pub mod script;

pub use control::Control;
pub use script::{Call, Script};
