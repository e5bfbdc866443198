//! The painting as a file.
//!
//! A painting is one SQLite database (`.maul`), open in one program at a time. It holds the tiles with their history,
//! the records accepted since the last checkpoint (the journal) and those before (the record), named versions,
//! displayed tiles, and the painting's files. `docs/document.md` describes the tables.
//!
//! | module | holds |
//! | --- | --- |
//! | [`document`], `thread` | an open painting; the thread that owns its file, and the queues between them |
//! | [`checkpoint`], [`writing`], [`opening`] | a checkpoint of a painting, written as one transaction and read back |
//! | [`journal`] | accepted records as bytes |
//! | [`record`] | records accepted since the beginning of the record, for replay |
//! | [`file`](mod@file) | the file: locks, pages read one by one, relocation, removal while it is open |
//! | [`tables`] | tables and migrations, rows, checksums, paint as bytes |
//! | [`stats`], [`pack`] | sizes and integrity of a file; packing it |
//! | [`error`] | errors, each with advice |
//!
//! A painting in memory gets a file, is closed, and is opened again:
//!
//! ```
//! use maulstick_document::{Access, Checkpoint, Document, DocumentSettings};
//! use maulstick_optics::PaintLibrary;
//! use maulstick_painting::{Painting, PaintingSetup, Sequencer};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = tempfile::tempdir()?;
//! let settings = DocumentSettings::new(&folder.path().join("sea.maul"), Access::Paint);
//! let setup = PaintingSetup { cells: [128, 64], ..PaintingSetup::default() };
//! let (document, opened) = Document::open(&settings)?;
//! assert!(opened.is_none(), "the file is new");
//! let pager = document.pager().clone();
//! let painting = Painting::paged(&setup, PaintLibrary::measured()?, pager)?;
//! document.write_checkpoint(Checkpoint::of(&mut Sequencer::new(painting), 0));
//! document.close()?;
//!
//! let (document, opened) = Document::open(&settings)?;
//! let opened = opened.ok_or("no painting")?;
//! assert_eq!(opened.snapshot().scene.surfaces[0].cells, [128, 64]);
//! document.close()?;
//! # Ok(())
//! # }
//! ```
//!
//! # Durability
//!
//! - One thread owns the SQLite file. Accepted records are committed every tenth of a second; every second a checkpoint
//!   writes changed tiles, steps and state in one transaction. Pages that take long are written before, in separate
//!   transactions, with the journal in between. After a crash the newest checkpoint is read and later records are
//!   accepted again; the continuation itself is a journal entry. Readers that wait for a page are served first, even
//!   within a transaction.
//! - Displayed tiles are stored too, so a picture appears before its paint is read.
//! - Files may come from anywhere: one function opens them and executes nothing in them, their schema is compared with
//!   our own, and a page is bounded by the size of its paints.
//! - At each commit, and each second, the thread checks that its files still have their names. Where one is gone or
//!   replaced, everything is written to a new file beside it. While the disk fails no page leaves memory. A journal cut
//!   short in place has lost its records: the last merged file continues under another name and receives the whole
//!   painting.
//! - Moving to another file needs no restart: the thread merges its journal, copies or renames between two
//!   transactions, and continues there or stays.
//! - Record: each checkpoint moves what it includes from the journal into one row of the table `record`, with its time.
//!   Opening reads the journal, the beginning and one number of the record; time lapse and log read it row by row.

pub mod checkpoint;
pub mod document;
pub mod error;
pub mod file;
pub mod journal;
pub mod opening;
pub mod pack;
pub mod record;
pub mod stats;
pub mod tables;
mod thread;
pub mod writing;

pub use checkpoint::Checkpoint;
pub use document::{Document, DocumentSettings};
pub use error::DocumentError;
pub use file::database::Access;
pub use file::relocate::{Relocate, Relocation, make_room, unfinished};
pub use opening::{Opened, glance, scene, shown_tiles};
pub use record::{RecordRow, RecordStats};
pub use stats::DocumentStats;
pub use tables::rows;
pub use thread::queues::TileCache;
pub use writing::ShownTile;
