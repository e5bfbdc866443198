//! Settings of a rig, and the life of a process in it.
//!
//! | module | holds |
//! | --- | --- |
//! | [`commander`] | commands to a node, repeated until answered |
//! | [`config`] | the settings of a rig |
//! | [`fault`] | an error as the user sees it: what, where, advice |
//! | [`files`] | files: whole under their name, of one's own kind, open here |
//! | [`log`] | log lines |
//! | [`member`] | joining a rig, living in it, leaving it |
//! | [`stop`] | the stop flag: a signal, or the launcher's end |

pub mod commander;
pub mod config;
pub mod fault;
pub mod log;
pub mod member;
pub mod size;
pub mod stop;

pub use config::RigConfig;
pub use fault::Fault;
pub use maulstick_files as files;
pub use member::{Member, MemberArgs};
pub use stop::Stop;
