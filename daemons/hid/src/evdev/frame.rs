//! The events of one time as bytes: of each its type, code and value, little endian.

/// Bytes of an event.
const EVENT_BYTES: usize = 8;

/// Types of events, as in `input-event-codes.h`.
pub mod kind {
    /// The end of what came at one time.
    pub const SYN: u16 = 0;
    /// A key goes down or up.
    pub const KEY: u16 = 1;
    /// An axis has another value.
    pub const ABS: u16 = 3;
}

/// An event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    /// See [`kind`].
    pub kind: u16,
    /// `ABS_*`, `KEY_*`, `BTN_*`.
    pub code: u16,
    /// The axis's value; 1 of a key that is down.
    pub value: i32,
}

/// Adds an event to a frame.
pub fn push(frame: &mut Vec<u8>, event: Event) {
    frame.extend(event.kind.to_le_bytes());
    frame.extend(event.code.to_le_bytes());
    frame.extend(event.value.to_le_bytes());
}

/// The events of a frame.
pub fn events(frame: &[u8]) -> impl Iterator<Item = Event> {
    frame.chunks_exact(EVENT_BYTES).map(|bytes| Event {
        kind: u16::from_le_bytes([bytes[0], bytes[1]]),
        code: u16::from_le_bytes([bytes[2], bytes[3]]),
        value: i32::from_le_bytes([bytes[4], bytes[5], bytes[6], bytes[7]]),
    })
}
