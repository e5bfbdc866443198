//! A libdhd for tests: the C interface of Force Dimension's SDK 3.16 over a scripted device.
//!
//! Its shared library is opened by the driver under test in place of the vendor's. A test says by a [`Script`] what the
//! device is and senses, and reads every [`Call`] that moved something. Names, types and codes are those of the vendor's
//! public header (dhdc.h).
//!
//! | module | holds |
//! | --- | --- |
//! | [`script`] | what the device is, and what was called |
//! | `exports` | the C functions |

mod exports;
pub mod script;

pub use script::{Call, Script};

/// How a test hands a script in and gets the calls out.
pub type Control = maulstick_scripted::Control<Script>;
