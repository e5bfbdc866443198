//! An OpenXR loader and runtime for tests: the C interface of OpenXR 1.0 over a scripted controller.
//!
//! Its shared library is opened by the driver under test in place of Khronos's loader. A test says by a [`Script`] what the
//! runtime can do and where the controller is, and reads every [`Call`]. Types and codes are those of Khronos's registry, as
//! crate `openxr-sys` has them.
//!
//! | module | holds |
//! | --- | --- |
//! | [`script`] | the runtime and its controller, and what was called |
//! | `state` | what the runtime remembers |
//! | `exports` | the C functions |

mod exports;
pub mod script;
mod state;

pub use script::{Call, Script};

/// How a test hands a script in and gets the calls out.
pub type Control = maulstick_scripted::Control<Script>;
