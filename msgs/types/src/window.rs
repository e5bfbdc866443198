//! Message of the window about the frames that it has shown.

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
