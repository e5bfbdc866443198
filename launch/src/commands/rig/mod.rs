//! Commands of a rig: clients, paintings opened and saved, snapshots, messages.

pub mod begin;
pub mod client;
pub mod endpoint;
pub mod open;
pub mod save_as;
pub mod schema;
mod schema_c;
pub mod snapshot;
