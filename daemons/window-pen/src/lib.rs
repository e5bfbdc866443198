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
//! | [`source`] | pens of a window system, whichever it is |
//! | [`wayland`] | tablet-v2 of Wayland |
//! | [`xinput`] | XInput 2 of X11 |
//! | [`thread`](mod@thread) | the thread that reads |
//! | [`mouse`] | the mouse of the window, where no other stylus is in range |
//!
//! A pen over a window whose pixels are a quarter of a millimetre wide: what it touches there is painted.
//!
//! ```
//! use std::sync::Arc;
//!
//! use maulstick_bus::{Bus, CreditReceiver, Faults, MemoryNet, Wake};
//! use maulstick_device::pen::{Presence, Reading};
//! use maulstick_types::Origin;
//! use maulstick_types::stylus::{StylusPose, StylusSample};
//! use maulstick_types::wire::topics::Topics;
//! use maulstick_window_pen::{Axes, DeskView, PenLink, PenReading, Tool, WindowStylus};
//!
//! struct Open;
//! impl DeskView for Open {
//!     fn is_desk(&self, _: [f64; 2]) -> bool {
//!         true
//!     }
//!     fn to_desk(&self, [x, y]: [f64; 2]) -> [f64; 3] {
//!         [(x - 400.0) * 0.25e-3, (300.0 - y) * 0.25e-3, 0.0]
//!     }
//!     fn takes_strokes(&self) -> bool {
//!         true
//!     }
//!     fn is_mirrored(&self) -> bool {
//!         false
//!     }
//! }
//!
//! # fn main() -> Result<(), maulstick_bus::BusError> {
//! let net = MemoryNet::new(1, 0, Faults::default());
//! let (bus, topics, me) = (Arc::new(net.bus()), Topics::new("studio"), Origin { source: 1, epoch: 1 });
//! let mut brush = CreditReceiver::<StylusSample>::new(&*bus, &topics, &topics.sample("pen"), me, &Wake::new())?;
//! let link = PenLink::default();
//! link.show(Some(Arc::new(Open)), "main");
//! let mut stylus = WindowStylus::new(bus.clone(), &topics, ("pen", me), link)?;
//! stylus.read(&PenReading {
//!     tool: Tool(1),
//!     axes: Axes { pressure: true, ..Axes::default() },
//!     time_ms: 0,
//!     point_px: [480.0, 300.0],
//!     reading: Reading { presence: Presence::Touching, pressure: 0.5, ..Reading::AWAY },
//! })?;
//! net.advance(1_000_000);
//! brush.poll(&*bus)?;
//! let sample = brush.pop().expect("a sample").message;
//! let StylusPose::Contact { point_m, pressure, .. } = sample.pose else { panic!("a pen touches") };
//! assert_eq!((point_m, pressure), ([0.02, 0.0, 0.0], 0.5));
//! # Ok(())
//! # }
//! ```
//!
//! # Who moves the pointer
//!
//! A Wayland compositor moves no pointer of a window that binds tablet-v2, so the window makes those events itself. An
//! X server does; that pointer does nothing on the desk while the pen is near and for 200 ms after.

pub mod clock;
pub mod mouse;
pub mod reading;
pub mod source;
pub mod stylus;
pub mod thread;
pub mod wayland;
pub mod window;
pub mod xinput;

pub use reading::{Axes, PenReading, Tool};
pub use stylus::WindowStylus;
pub use thread::{PenThread, pens_of};
pub use window::{DeskView, PenLink, PenState, PointerEvent};
