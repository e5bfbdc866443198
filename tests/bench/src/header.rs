//! Headers of a brush's states, as if they had come over the bus.

use maulstick_types::{Flags, Header, name_hash};

/// The header of state `seq` of a brush.
pub(crate) fn header_of(brush: &str, seq: u64) -> Header {
    Header {
        version: 1,
        schema: 0,
        source: name_hash(brush),
        epoch: 1,
        flags: Flags::NONE,
        length: 0,
        seq,
        event_ns: 0,
        sent_ns: 0,
    }
}
