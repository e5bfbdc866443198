//! Messages of the window: the frames that it has shown, and what it has asked for.

use crate::paint::FrameHolds;
use crate::wire::define::message;

message! {
    /// A frame of the window that the graphics device has completed; `event_ns` of its header is the time of completion.
    pub struct Presented [version 1, at most 4096 bytes] {
        /// Number of the frame since the window was opened, from 0.
        pub frame: u64,
        /// Time at which the window began to draw it, rig clock, ns.
        pub begun_ns: u64,
        /// Time until all of it was submitted to the graphics device, ns.
        pub draw_ns: u64,
        /// The journal entries below this index are in its picture of the canvas.
        pub journal: u64,
        /// The brush states that are in its picture of the canvas.
        pub holds: Vec<FrameHolds>,
    }
}

message! {
    /// Says that something that a painter asked for at the window is not done yet: a stroke that begins after it was asked
    /// for waits. Sent at least each 50 ms while something is pending, and once when nothing is any more.
    pub struct PendingOrders [version 1, at most 16 bytes] {
        /// Samples of a stylus until then were made before the oldest of it was asked for, rig clock, ns; 0 if nothing is
        /// pending.
        pub since_ns: u64,
    }
}
