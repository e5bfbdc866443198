//! Status of a node: its progress and its work.

use crate::wire::define::{message, wire_struct};

wire_struct! {
    /// Work of a node since its start, and work that waits; 0 where it counts none.
    #[derive(Default)]
    pub struct NodeWork {
        /// Messages, samples or reports that it has consumed.
        pub consumed: u64,
        /// Messages that it has sent of its main stream.
        pub produced: u64,
        /// Messages that wait to be consumed.
        pub waiting: u64,
        /// Messages that wait until another node has room.
        pub held: u64,
        /// Messages that it refused.
        pub refused: u64,
        /// Messages that were lost on their way to it, or for which it had no room.
        pub lost: u64,
        /// Samples faster than a hand, at which a brush began anew.
        pub too_fast: u64,
    }
}

message! {
    /// Status of a node, twice a second, from the loop that does its work: the launcher ends one that sends none.
    pub struct NodeStatus [version 1, at most 256 bytes] {
        /// Its process.
        pub process: u32,
        /// Turns of its loop since its start.
        pub turns: u64,
        /// Its work.
        pub work: NodeWork,
    }
}

impl NodeStatus {
    /// Time between two statuses of a node, ns.
    pub const PERIOD_NS: u64 = 500_000_000;
}
