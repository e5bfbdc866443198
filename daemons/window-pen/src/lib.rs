//! Pens in a window, by its window system.
//!
//! A thread of its own reads each sample at its own time, whatever the window draws meanwhile, finds it on the desk as
//! the window shows it, and sends it. What a pen touches decides: on the desk it paints, on a panel it is the pointer,
//! and nothing is both.
//!
//! | module | holds |
//! | --- | --- |
//! | [`reading`] | what a window system says of a pen |
//! | [`clock`] | times of a window system on the rig's clock |
//! | [`stylus`] | the pen on the desk: touches, samples, what the window hears of it |
//! | [`window`] | the window as a pen finds it, and the pen as the window finds it |
//! | [`wayland`] | tablet-v2 of Wayland |
//! | [`xinput`] | XInput 2 of X11 |
//! | [`thread`](mod@thread) | the thread that reads |
//!
//! # Who moves the pointer
//!
//! A Wayland compositor moves no pointer of a window that binds tablet-v2, so the window makes those events itself. An
//! X server does; that pointer does nothing on the desk while the pen is near and for 200 ms after.

pub mod clock;
pub mod reading;
pub mod stylus;
pub mod thread;
pub mod wayland;
pub mod window;
pub mod xinput;

pub use reading::{Axes, PenReading, Tool};
pub use stylus::WindowStylus;
pub use thread::{PenThread, pens_of};
pub use window::{DeskView, PenLink, PenState, PointerEvent};
