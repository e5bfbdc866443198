//! Journal entries of version 11, whose decisions are words: a painting's file may hold them.

use super::Decision;
use crate::command::Command;
use crate::wire::define::{message, wire_enum};
use crate::wire::worded::Worded as _;

wire_enum! {
    /// Record that the sequencer accepted, as [`super::Entry`].
    pub enum Entry {
        /// Brush states.
        States {
            /// Name of the brush.
            brush: String,
            /// Its epoch.
            epoch: u32,
            /// First state.
            from: u64,
            /// Last state.
            to: u64,
        },
        /// A command.
        Command {
            /// The sender.
            client: u64,
            /// Its number.
            number: u64,
            /// What it does.
            command: Command,
        },
        /// A sixtieth of a second of flowing or drying.
        Tick {
            /// Number of ticks since the painting began.
            count: u64,
        },
        /// Brush states that an undo dropped.
        Cut {
            /// The sender of the undo.
            client: u64,
            /// The undo's number.
            number: u64,
            /// Name of the brush.
            brush: String,
            /// Its epoch.
            epoch: u32,
            /// First state.
            from: u64,
            /// Last state.
            to: u64,
            /// True if nothing of the stroke was painted.
            whole: bool,
        },
        /// A decision of the paint node itself.
        Decision {
            /// Its words.
            what: String,
        },
        /// A brush, or another file of a known one.
        Brush {
            /// Its name.
            brush: String,
            /// The file, TOML.
            toml: String,
        },
    }
}

message! {
    /// An entry of the journal.
    pub struct JournalEntry [version 11, at most 1049600 bytes] {
        /// From 0, without gaps.
        pub index: u64,
        /// The record.
        pub entry: Entry,
    }
}

impl From<JournalEntry> for super::JournalEntry {
    fn from(JournalEntry { index, entry }: JournalEntry) -> Self {
        let entry = match entry {
            Entry::States {
                brush,
                epoch,
                from,
                to,
            } => super::Entry::States {
                brush,
                epoch,
                from,
                to,
            },
            Entry::Command {
                client,
                number,
                command,
            } => super::Entry::Command {
                client,
                number,
                command,
            },
            Entry::Tick { count } => super::Entry::Tick { count },
            Entry::Cut {
                client,
                number,
                brush,
                epoch,
                from,
                to,
                whole,
            } => super::Entry::Cut {
                client,
                number,
                brush,
                epoch,
                from,
                to,
                whole,
            },
            Entry::Decision { what } => super::Entry::Decision {
                what: Decision::of_words(&what),
            },
            Entry::Brush { brush, toml } => super::Entry::Brush { brush, toml },
        };
        Self { index, entry }
    }
}
