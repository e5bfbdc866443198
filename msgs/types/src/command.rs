//! Commands to the paint node and their replies.

use crate::define::{message, wire_enum, wire_struct};
use crate::mixture::Mixture;
use crate::pose::Pose;

wire_struct! {
    /// A place in a brush's stream: a command with it enters the journal right after that state.
    pub struct After {
        /// The brush: the source of its states.
        pub brush: u32,
        /// Its epoch.
        pub epoch: u32,
        /// The state.
        pub sequence: u64,
    }
}

wire_enum! {
    /// What a painter, a script or a player can ask for.
    pub enum Command {
        /// Loads a brush afresh: what it carried goes to the cleaner.
        Load {
            /// Name of the brush.
            brush: String,
            /// What it takes up.
            mixture: Mixture,
        },
        /// Takes all paint off a brush.
        Clean {
            /// Name of the brush.
            brush: String,
        },
        /// Announces a take: only announced takes paint. Each new stroke takes the next load in
        /// turn; without loads the brush keeps what it has.
        Take {
            /// Name of the brush that will follow it.
            brush: String,
            /// Source of the player's samples.
            device: u32,
            /// Epoch of this playing.
            device_epoch: u32,
            /// The loads.
            loads: Vec<Mixture>,
        },
        /// Takes the newest step back.
        Undo,
        /// Takes the newest undo back.
        Redo,
        /// Writes a picture of the canvas and, if asked, the ledger.
        Snapshot {
            /// A PNG; written beside and renamed.
            path: String,
            /// A JSON file with the ledger.
            ledger: Option<String>,
        },
        /// Moves, turns or zooms a surface.
        Place {
            /// The surface.
            surface: u32,
            /// Surface frame to desk frame.
            pose: Pose,
            /// Desk lengths per surface length.
            zoom: f64,
        },
        /// Ends nothing and changes nothing: its reply says that the place it names is reached.
        Mark,
    }
}

message! {
    /// A command with its sender and number; sending it again with the same number is safe.
    pub struct CommandRequest [version 1, at most 1048576 bytes] {
        /// A number that the client drew at random.
        pub client: u64,
        /// Counts the client's commands.
        pub number: u64,
        /// Where it takes its place in the journal; at once if absent.
        pub after: Option<After>,
        /// What it does.
        pub command: Command,
    }
}

wire_enum! {
    /// What became of a command.
    pub enum Outcome {
        /// It is done.
        Done {
            /// Its index in the journal.
            journal: u64,
            /// What it wrote or found, in words; may be empty.
            detail: String,
        },
        /// It is accepted and waits for its place; ask again with the same number.
        Waiting,
        /// It was not done.
        Refused {
            /// What is wrong.
            what: String,
            /// What to do about it.
            help: String,
        },
    }
}

message! {
    /// The reply to a command.
    pub struct CommandReply [version 1, at most 65536 bytes] {
        /// The command's number.
        pub number: u64,
        /// What became of it.
        pub outcome: Outcome,
    }
}

message! {
    /// Asks a sender for messages that were lost on the way.
    pub struct GapRequest [version 1, at most 64 bytes] {
        /// The sender's epoch.
        pub epoch: u32,
        /// First number.
        pub from: u64,
        /// Last number.
        pub to: u64,
    }
}
