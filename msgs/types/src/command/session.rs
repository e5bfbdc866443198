//! Commands of a recorded session that is painted again.

use serde_bytes::ByteBuf;

use crate::wire::define::wire_enum;

wire_enum! {
    /// A recorded session that is painted again.
    pub enum SessionCommand {
        /// Accepts again what was accepted then, in order. From the first of these to [`End`](Self::End), or until none
        /// came for ten seconds, hands paint nothing, other commands are refused, and time passes only with these.
        Repeat {
            /// Records as a painting keeps them in its journal.
            records: ByteBuf,
        },
        /// Ends it.
        End,
    }
}
