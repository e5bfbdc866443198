//! Set-up of devices: what is attached to this machine, the devices of a user, and those of a running rig.
//!
//! | module | content |
//! | --- | --- |
//! | [`attached`] | devices at nodes below `/dev`, software of vendors, the rule for udev |
//! | [`listing`] | what is attached, what a rig has of it, and what it may have |
//! | [`allow`](mod@allow) | permission for the user at this machine |
//! | [`add`](mod@add), [`change`](mod@change), [`rename`](mod@rename), [`remove`](mod@remove) | a device of a user, kept in a file and changed in a rig that runs |
//! | [`fit`](mod@fit) | fit of a device to the canvas |
//! | [`user_file`] | the file of a user's devices |
//! | `running` | devices of a running rig |
//! | [`error`] | errors, and their words for a user |
//!
//! Each change is a function that returns what was done. It blocks, as programs, sockets and hands do: `maulstick
//! device` calls it as it is, the window on a thread.
//!
//! ```
//! use maulstick_device_setup::attached::{Attached, Permission};
//! use maulstick_device_setup::listing::DeviceListing;
//!
//! let tablet = Attached {
//!     name: "Intuos".into(),
//!     id: "056a:0357".into(),
//!     path: "/dev/hidraw0".into(),
//!     driver: Some("pen"),
//!     permission: Permission::Granted,
//!     missing: None,
//! };
//! let listing = DeviceListing {
//!     hid: vec![tablet],
//!     ..DeviceListing::default()
//! };
//! assert_eq!(listing.unused()[0].address, "056a:0357");
//! ```

pub mod add;
pub mod allow;
pub mod attached;
pub mod change;
pub mod error;
pub mod fit;
pub mod listing;
pub mod remove;
pub mod rename;
mod running;
pub mod user_file;
