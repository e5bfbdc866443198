//! Settings of a rig, and the life of a process in it.
//!
//! | module | holds |
//! | --- | --- |
//! | [`asker`] | who asks for something |
//! | [`command_client`] | commands to a node, repeated until answered |
//! | [`config`] | the settings of a rig |
//! | [`user_devices`] | the devices of a user, for any rig |
//! | [`user_error`] | an error as the user sees it: what, where, advice |
//! | [`files`] | files: whole under their name, of one's own kind, open here |
//! | [`log`] | log lines |
//! | [`node_handle`] | joining a rig, living in it, leaving it |
//! | [`program`] | the program of this process, for those that it starts |
//! | [`pulse`] | the status of a node, by which the launcher sees that it makes progress |
//! | [`sketches`] | paintings that have no name yet, in the user's state folder |
//! | [`thread`](mod@thread) | threads by their names |
//! | [`table_file`] | tables in files that a user names |
//! | [`whole_path`](mod@whole_path) | paths as messages carry them |
//! | [`stop`] | the stop flag: a signal, or the launcher's end |
//!
//! A crate of its own, so that daemons, window and launcher share settings and conduct without knowing each other.
//!
//! A studio with one force-feedback stylus; a mistake is reported with its line and what to do.
//!
//! ```
//! use maulstick_rig::RigConfig;
//!
//! # fn main() -> Result<(), maulstick_rig::UserError> {
//! let text = r#"
//! [canvas]
//! width_mm = 400
//! height_mm = 300
//!
//! [[device]]
//! name = "left"
//! driver = "openhaptics"
//! brush = "main"
//! max_force_n = 2.0
//! "#;
//! let rig = RigConfig::parse(text, "rig.toml")?;
//! assert_eq!(rig.canvas.cells(), [1600, 1200]);
//! assert_eq!(rig.device[0].max_force_n, 2.0);
//!
//! let wrong = text.replace("openhaptics", "openhaptic");
//! let error = RigConfig::parse(&wrong, "rig.toml").expect_err("no such driver");
//! assert_eq!(error.place.as_deref(), Some("rig.toml:8"));
//! println!("{error}");
//! # Ok(())
//! # }
//! ```
//!
//! # Progress
//!
//! The loop of each node publishes its status twice a second: messages consumed, produced and waiting. The launcher
//! ends a node that sends none or consumes nothing of what waits. A window may rest while nobody sees it, so a thread
//! of its own sends its status.
//!
//! # Log
//!
//! Lines pass through a bounded queue to a thread, so a terminal that stands still holds up neither paint nor signals.
//! The oldest lines are dropped and their number is logged once lines flow again; a process that ends waits .2 s for
//! its last ones. Panics and the launcher's progress bar take the same way.
//!
//! # Processes
//!
//! Nodes are started by `/proc/self/exe`, so a rig is of one version even after an upgrade has replaced the program.

pub mod asker;
pub mod command_client;
pub mod config;
pub mod log;
pub mod node_handle;
pub mod program;
pub mod pulse;
pub mod size;
pub mod sketches;
pub mod stop;
pub mod table_file;
pub mod thread;
pub mod user_error;
pub mod whole_path;

pub use asker::asker;
pub use config::RigConfig;
pub use config::user_devices;
pub use maulstick_files as files;
pub use node_handle::{NodeArgs, NodeHandle};
pub use sketches::Sketches;
pub use stop::Stop;
pub use user_error::UserError;
pub use whole_path::whole_path;
