//! The streams of a running rig for Foxglove, by a process of its own that no node waits for.
//!
//! | module | holds |
//! | --- | --- |
//! | [`admission`] | who may watch |
//! | [`token`] | the secret in the address |
//! | `viewer` | one who watches |
//! | [`foxglove_server`] | what they are sent |

pub mod admission;
pub mod foxglove_server;
pub mod token;
mod viewer;
