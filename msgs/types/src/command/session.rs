//! Commands of a recorded session that is painted again.

use serde_bytes::ByteBuf;

use crate::wire::define::wire_enum;

wire_enum! {
    /// A recorded session that is painted again.
    pub enum SessionCommand {
        /// Begins it: until [`End`](Self::End), or until nothing came for ten seconds, hands paint nothing, other commands
        /// are refused, and time passes only with the session.
        Begin {
            /// Number that its player has chosen at random.
            session: u64,
        },
        /// Accepts again what was accepted then, in order.
        Repeat {
            /// The session.
            session: u64,
            /// Number of the batch, from 0: one that was accepted is not accepted twice.
            batch: u64,
            /// Records as a painting keeps them in its journal.
            records: ByteBuf,
        },
        /// Ends it.
        End {
            /// The session.
            session: u64,
        },
    }
}
