//! The processes of a running rig and what they send each other, as a picture.
//!
//! | module | holds |
//! | --- | --- |
//! | `processes` | [`Graph`], of what each process says that it sends and receives |
//! | [`mermaid`], [`svg`] | its pictures |
//!
//! ```
//! use std::collections::BTreeMap;
//!
//! use maulstick_bus::Participant;
//! use maulstick_graph::{Graph, mermaid};
//! use maulstick_types::wire::topics::Topics;
//!
//! let pen = Participant {
//!     session: "5f3a".into(),
//!     name: Some("pen".into()),
//!     process: None,
//!     sends: ["maulstick/studio/stylus/pen/sample".into()].into(),
//!     receives: [].into(),
//!     answers: [].into(),
//! };
//! let graph = Graph::of(&[pen], &BTreeMap::new(), &Topics::new("studio"));
//! assert!(mermaid::text(&graph).contains("n0[\"pen\"]"));
//! ```

pub mod mermaid;
mod processes;
pub mod svg;

pub use processes::{Arrow, Graph, Process, Sent, Stage};
