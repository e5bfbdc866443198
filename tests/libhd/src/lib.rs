//! A libHD for tests: the C interface of OpenHaptics 3.4's HD library over a simulated Phantom.
//!
//! Its shared library is opened by the driver under test in place of the vendor's. A test says by a
//! [`Script`] what the device is and what goes wrong when, and reads every [`Call`] that was made.
//! Names, types, codes and rules of use are those of the vendor's public headers and reference guide.
//!
//! | module | holds |
//! | --- | --- |
//! | [`script`] | what a test may ask of the device |
//! | [`log`] | what was called |
//! | [`control`] | how a test hands one in and gets the other out |
//! | `codes` | numbers of the interface |
//! | `phantom` | the device and the hand that holds it |
//! | `library` | the state behind the interface |
//! | `scheduler` | the thread that calls back a thousand times a second |
//! | `exports` | the C functions |

mod codes;
pub mod control;
mod exports;
mod library;
pub mod log;
mod phantom;
mod scheduler;
pub mod script;

pub use control::Control;
pub use log::Call;
pub use script::{Event, Grip, Moment, Script};
