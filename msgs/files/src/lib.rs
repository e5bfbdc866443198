//! Files that programs write.
//!
//! | module | holds |
//! | --- | --- |
//! | [`kind`] | kinds of files by their first bytes and by how their names end; which file may be written over |
//! | [`free`] | names that are not taken |
//! | [`open`] | databases that this process has open, by device and inode |
//! | [`private`] | files that their user alone may read |
//! | [`same`] | names of one file |
//! | [`whole`] | files that are whole under their name, or not there at all |
//!
//! A table is written while the disk fails: the one before it stays, whole.
//!
//! ```
//! use std::io::{Error, Write as _};
//!
//! use maulstick_files::{Kind, write_whole};
//!
//! # fn main() -> Result<(), Error> {
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("force.csv");
//! write_whole(&path, Kind::Forces, |file| writeln!(file, "time_s,force_n"))?;
//!
//! let failed = write_whole(&path, Kind::Forces, |file| {
//!     writeln!(file, "time_s,for")?;
//!     Err(Error::other("the disk is full"))
//! });
//! assert!(failed.is_err());
//! assert_eq!(std::fs::read_to_string(&path)?, "time_s,force_n\n");
//! assert!(write_whole(&folder.path().join("force.png"), Kind::Forces, |_| Ok(())).is_err());
//! # Ok(())
//! # }
//! ```
//!
//! # Open databases
//!
//! No file that this process has open as a database may be opened a second time in it: closing any descriptor drops
//! SQLite's POSIX locks on the inode. Readers ask `open` first, which knows open databases by device and inode.

pub mod free;
pub mod kind;
pub mod open;
pub mod private;
pub mod same;
pub mod whole;

pub use free::{companion, first_free};
pub use kind::{COMPANIONS, Kind, allow_overwriting, ending, gives_way, is_companion, is_painting};
pub use open::{FileId, OpenDatabase, read_head};
pub use private::{create_private, open_private};
pub use same::is_same;
pub use whole::{
    Unfinished, check_folder, check_writable, clear_on_signals, write_folder, write_whole,
    write_whole_at,
};
