//! Recovery of damaged paintings.
//!
//! A painting is one SQLite database. If a disk, a copy or a program has damaged it, SQLite refuses all of it for one
//! wrong page; this crate reads the pages itself and makes a new painting of the intact rows.
//!
//! | module | holds |
//! | --- | --- |
//! | [`sqlite`] | rows of a damaged SQLite file, read without SQLite: any database, not paintings alone |
//! | [`recovery`] | a new painting of the intact rows, and a report of the losses |
//!
//! The rows of a database whose header and schema are overwritten with zeros:
//!
//! ```
//! use maulstick_salvage::sqlite::{Scan, Value};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("paints.db");
//! let database = rusqlite::Connection::open(&path)?;
//! database.execute_batch(
//!     "CREATE TABLE paint(id INTEGER PRIMARY KEY, name TEXT);
//!      INSERT INTO paint VALUES (1, 'Lead White'), (2, 'Bone Black');",
//! )?;
//! drop(database);
//! let mut bytes = std::fs::read(&path)?;
//! bytes[..4096].fill(0);
//! std::fs::write(&path, bytes)?;
//!
//! let mut scan = Scan::open(&path)?;
//! let names: Vec<Value> = scan.rows().map(|row| row.values[1].clone()).collect();
//! assert_eq!(names, ["Lead White", "Bone Black"].map(|name| Value::Text(name.to_owned())));
//! # Ok(())
//! # }
//! ```
//!
//! # Why a reader of our own
//!
//! SQLite's recovery API and its `sqlite_dbpage` table are not in the SQLite that `rusqlite` bundles. It also takes
//! frames of the WAL only up to the first damaged one, and does not separate current rows from deleted ones on free
//! pages, by which copies of a tile are chosen.

pub mod recovery;
pub mod sqlite;

pub use recovery::{SalvageError, SalvageReport, recover, temporary_path};
