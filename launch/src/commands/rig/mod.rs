//! Commands of a rig: its clients, processes and messages.

pub mod client;
pub mod endpoint;
pub mod nodes;
pub mod schema;
mod schema_c;
