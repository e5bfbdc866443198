//! Files that programs write.
//!
//! | module | holds |
//! | --- | --- |
//! | [`kind`] | kinds of files by their first bytes; which file may be written over |
//! | [`open`] | databases that this process has open, by device and inode |
//! | [`whole`] | files that are whole under their name, or not there at all |

pub mod kind;
pub mod open;
pub mod whole;

pub use kind::{Kind, allow_overwriting, gives_way, is_companion};
pub use open::{FileId, OpenDatabase, read_head};
pub use whole::{
    Unfinished, check_folder, check_writable, clear_on_signals, write_folder, write_whole,
    write_whole_at,
};
