//! Streams of a running rig into files.
//!
//! | module | holds |
//! | --- | --- |
//! | [`settings`] | its settings |
//! | [`recorder`] | the handle of a recorder at work |
//! | [`task`] | the task |
//! | [`event`] | what happens to a recording |
//! | [`ring`] | the files of a recording, and those that go for newer ones |
//! | [`part`] | one file |
//! | [`cut_off`] | recordings whose recorder was killed |
//! | [`painting_copy`], [`on_the_way`] | the painting as it is at the beginning of a file |
//! | [`journal_watch`] | where the journal breaks off, and another file begins |

pub(crate) mod cut_off;
pub(crate) mod event;
mod journal_watch;
mod on_the_way;
mod painting_copy;
mod part;
pub(crate) mod recorder;
pub(crate) mod ring;
pub(crate) mod settings;
mod task;
