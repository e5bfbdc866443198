//! The painting as a file.
//!
//! A painting is one SQLite database (`.maul`), open in one program at a time. It holds the tiles with
//! their history, the records accepted since then (the journal), named versions, the tiles as they are shown,
//! and the files that the painting is made with. `docs/document.md` describes the tables.
//!
//! | module | holds |
//! | --- | --- |
//! | [`document`], `thread`, `queues` | an open painting, the thread that owns its file, and the queues between them |
//! | [`database`] | the file: locks, pages read one by one |
//! | [`writing`], [`opening`] | a checkpoint of a painting, written as one transaction and read back |
//! | [`moving`], `watch` | its file under another name, or removed |
//! | [`journal`] | accepted records as bytes |
//! | [`contents`], [`pack`] | contents of a file; making it small |
//! | [`planes`], [`loads`] | paint as bytes |
//! | [`rows`], [`schema`], [`sum`] | tables, migrations, checksums |
//! | [`scan`], [`mod@recover`] | rows out of damaged files; a new painting of the intact ones |
//! | [`error`] | errors, each with advice |

pub mod contents;
pub mod database;
pub mod document;
pub mod error;
pub mod journal;
pub mod loads;
pub mod moving;
pub mod opening;
pub mod pack;
pub mod planes;
mod queues;
pub mod recover;
pub mod rows;
pub mod scan;
pub mod schema;
pub mod sum;
mod thread;
mod watch;
pub mod writing;

pub use contents::Contents;
pub use database::{Access, glance, scene};
pub use document::{Document, DocumentSettings};
pub use error::DocumentError;
pub use moving::{Left, Moving, make_room, unfinished};
pub use opening::Opened;
pub use queues::Shelf;
pub use recover::{Salvage, part_of, recover};
pub use writing::{Moment, ShownTile};
