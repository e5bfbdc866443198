//! Streams that lose nothing over a transport that may drop.
//!
//! A [`CreditSender`] numbers its messages, keeps those of the newest five seconds and answers queries for those that
//! were lost; it counts how many the consumer has not yet consumed. A [`CreditReceiver`] hands messages on in order,
//! asks again for missing ones, and reports those that it gives up. The behaviour of a sender without credit is its own
//! affair: a player waits, a live brush merges.

mod losses;
mod receiver;
mod sender;
mod stream;

pub use receiver::{CreditReceiver, ReceiverCounts};
pub use sender::{CreditSender, Stamp};

/// Largest number of unconsumed messages in flight.
pub const WINDOW: u64 = 64;
/// Number of sent messages kept for receivers that missed them: over five seconds of a device of 1 kHz.
pub const RING: usize = 5120;
/// Bytes of the messages kept at most, as far as they are not needed for the window.
pub const RING_BYTES: usize = 8 << 20;
/// Time after which a gap is requested again, and an unconsumed message sent again, ns.
pub const RETRY_NS: u64 = 50_000_000;
/// Live, a gap is given up after this many askings.
pub const PATIENCE: u32 = 20;

#[cfg(test)]
mod rival_tests;
#[cfg(test)]
mod tests;
