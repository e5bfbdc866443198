//! The streams of a running rig for Foxglove, by a process of its own that no node waits for.
//!
//! | module | holds |
//! | --- | --- |
//! | [`admission`] | who may watch: a browser lets every page open a connection, and every user reaches a port |
//! | [`token`] | the secret in the address |
//! | `server` | [`Bridge`]: a rig's messages, wishes and refusals, as they come |
//! | `lobby` | the viewers, and the channels that they know of |
//! | `connection`, `viewer` | one of them: admitted, obeyed, sent what waits for it |
//! | `feed` | messages as JSON channels |
//!
//! The protocol is the library's; connections are accepted here, for its own server judges nobody who connects.
//!
//! All are tasks on a tokio runtime of the caller: one that serves, one that accepts, one for each viewer. Nothing waits for a
//! viewer: of what a slow one does not take, the oldest messages are dropped. The runtime has to be one of several threads,
//! for closing a zenoh session blocks in place.

pub mod admission;
mod connection;
mod feed;
mod lobby;
mod server;
pub mod token;
mod viewer;

pub use server::{Bridge, BridgeSettings};
