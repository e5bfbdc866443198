//! What the window says of its frames.

use crate::define::message;
use crate::paint::FrameHolds;

message! {
    /// A frame of the window that the graphics device has completed; `event_ns` of its header is when.
    pub struct Presented [version 1, at most 4096 bytes] {
        /// Its number since the window was opened, from 0.
        pub frame: u64,
        /// When the window began to draw it, rig clock, ns.
        pub begun_ns: u64,
        /// Time that the window took until the graphics device had all of it to do, ns.
        pub draw_ns: u64,
        /// The journal entries below this index are in its picture of the canvas.
        pub journal: u64,
        /// The brush states that are in its picture of the canvas.
        pub holds: Vec<FrameHolds>,
    }
}
