//! The file on disk: its lock, its names, and its rows one by one.

pub(crate) mod connect;
pub mod database;
pub(crate) mod path;
pub(crate) mod probe;
pub mod relocate;
pub(crate) mod watch;
