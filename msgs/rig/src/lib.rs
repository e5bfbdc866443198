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
//! | [`pulse`] | the status of a node, by which the launcher sees that it goes on |
//! | [`sketches`] | paintings that have no name yet, in the user's state folder |
//! | [`table_file`] | tables in files that a user names |
//! | [`stop`] | the stop flag: a signal, or the launcher's end |

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
pub mod user_devices;
pub mod user_error;

pub use asker::asker;
pub use config::RigConfig;
pub use maulstick_files as files;
pub use node_handle::{NodeArgs, NodeHandle};
pub use sketches::Sketches;
pub use stop::Stop;
pub use user_error::UserError;
