//! Transport between the processes of a rig.
//!
//! [`Bus`] is the interface of a node: publishers, bounded subscriptions, queries, liveliness tokens and
//! the rig's clock. [`ZenohBus`] carries it between processes; [`MemoryNet`] carries it inside one
//! process under a virtual clock, and loses, delays and reorders as a test demands. No other
//! crate of the rig names zenoh; the benchmarks do, to put a bare zenoh beside this bus.
//!
//! | module | holds |
//! | --- | --- |
//! | [`bus`] | the trait and its parts |
//! | [`inbox`] | bounded queues and the wake-up that they share |
//! | [`typed`] | messages instead of bytes |
//! | [`credit`] | streams that lose nothing: credit, a ring, re-asking for gaps |
//! | [`sender_arbiter`] | the choice between two senders under one name |
//! | [`participants`] | the programs of a rig, and what each sends, receives and answers |
//! | [`clock`] | the rig's clock |
//! | [`reason`](mod@reason) | what a library says, without paths of the machine that built it |
//! | [`rig`] | the rig's folder, and the file by which a foreign program finds it |
//! | [`sockets`] | the sockets in it, put back where they were removed |
//!
//! A program publishes a stylus over a network that loses a fifth of the messages and lets others overtake; the receiver
//! has each sample once, in order. In a rig a [`ZenohBus`] takes the place of the [`MemoryBus`].
//!
//! ```
//! use maulstick_bus::credit::Stamp;
//! use maulstick_bus::{Bus, CreditReceiver, CreditSender, Faults, MemoryNet, Wake};
//! use maulstick_types::stylus::StylusSample;
//! use maulstick_types::wire::topics::Topics;
//! use maulstick_types::{Flags, Origin, name_hash};
//!
//! # fn main() -> Result<(), maulstick_bus::BusError> {
//! let net = MemoryNet::new(1, 0, Faults { loss: 0.2, delay_ns: 3_000_000 });
//! let (bus, topics, wake) = (net.bus(), Topics::new("studio"), Wake::new());
//! let (topic, me) = (topics.sample("my-pen"), Origin { source: name_hash("my-pen"), epoch: 1 });
//! let mut pen = CreditSender::<StylusSample>::new(&bus, &topics, &topic, me, &wake)?;
//! let mut brush = CreditReceiver::<StylusSample>::new(&bus, &topics, &topic, me, &wake)?;
//!
//! let mut received = Vec::new();
//! while received.len() < 50 {
//!     let now_ns = bus.now_ns();
//!     if pen.next_seq() < 50 {
//!         let stamp = Stamp { now_ns, event_ns: now_ns };
//!         pen.send(Flags::NONE, stamp, &StylusSample::away())?;
//!     }
//!     brush.poll(&bus)?;
//!     while let Some(sample) = brush.pop() {
//!         received.push(sample.header.seq);
//!     }
//!     pen.consumed(me.epoch, received.len() as u64, now_ns);
//!     pen.serve(now_ns)?;
//!     net.advance(1_000_000);
//! }
//! assert_eq!(received, Vec::from_iter(0..50));
//! # Ok(())
//! # }
//! ```
//!
//! # Streams without loss
//!
//! The transport may drop anything. A sender numbers its messages, rejects and reports one that exceeds its size limit,
//! keeps the newest five seconds at 1 kHz (8 MB at most) and answers for gaps. A receiver delivers in order; at most 64
//! messages are unconsumed at a time. A sender without progress for 50 ms repeats its newest message, because a lost
//! last message leaves no gap. A live gap is given up after a second, counted and reported: a painter does not wait.
//! The stream of a played take is asked for until it is whole. Streams of `recording replay --topic` count as live, and nobody
//! answers for their gaps.
//!
//! # Two senders under one name
//!
//! Of two epochs the later one is followed, once it has been heard for half a second or says that it is the first, so a
//! stray message takes nothing over. A sender that was set aside is followed again after half a second of silence of
//! the other. Within one epoch, numbers that leap by more than a ring belong to another sender. What is set aside is
//! counted and reported once. A cached value that another process overwrites is sent again when that process is silent.
//! Memory of senders is bounded: 64 streams, 256 names, ten minutes.
//!
//! # Links
//!
//! - Callbacks only push into bounded queues, since one slow callback stalls every topic of a peer.
//! - Each node has a unix socket in a folder of mode 0700; all connect to the launcher's, the hub, and gossip makes the
//!   mesh. Each socket has a second name from which a removed one is restored.
//! - A program without a socket joins as a zenoh client and the hub passes everything on. A peer without a socket
//!   cannot be dialled, and with one-sided dialling may never meet the node that it queries; so command-line programs
//!   join as clients.
//! - A link that breaks while both ends keep theirs to the hub is not made again. The lease is therefore 20 s, so a
//!   process may stand still that long; one that dies closes its sockets at once.
//!
//! # Shared memory
//!
//! Frames are encoded into a pool of 16 MB (4 MB where no more may be locked) and read in place. Only the paint node
//! and the window use it. What finds no pool, or no room in it, goes through the socket, and so does a second request
//! for what has not arrived within 500 ms. Nothing is overwritten while it may be read: a pool clogged by a dead reader
//! is given up for a new one, and a starting rig clears away what killed ones left.
//!
//! # Clock
//!
//! `CLOCK_MONOTONIC` plus an offset that the launcher fixes once for each rig.

mod announce;
pub mod bus;
pub mod clock;
pub mod credit;
pub mod inbox;
mod memory;
pub mod participants;
pub mod reason;
mod recent;
pub mod rig;
pub mod sender_arbiter;
mod shared_memory;
pub mod sockets;
pub mod typed;
mod zenoh_bus;

pub use announce::Announcer;
pub use bus::{Arrival, Bus, BusError, Pending, Publish, Qos, Request, Server, Subscription};
pub use clock::RigClock;
pub use credit::{CreditReceiver, CreditSender};
pub use inbox::{Counts, Inbox, Queue, Wake};
pub use memory::{Faults, MemoryBus, MemoryNet};
pub use participants::Participant;
pub use recent::Recent;
pub use rig::{RigFolder, RigInfo};
pub use shared_memory::payload::{Payload, SharedPayload};
pub use shared_memory::pool::clear_shared_memory;
pub use zenoh_bus::{Dial, ZenohBus};
