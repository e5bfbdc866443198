//! Commands of a rig: sessions, paintings opened and saved, snapshots, messages.

pub mod begin;
pub mod endpoint;
pub mod open;
pub mod save_as;
pub mod schema;
mod schema_c;
pub mod session;
pub mod snapshot;
