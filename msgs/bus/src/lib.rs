//! Transport between the processes of a rig.
//!
//! [`Bus`] is the interface of a node: publishers, bounded subscriptions, queries, liveliness tokens and
//! the rig's clock. [`ZenohBus`] carries it between processes; [`MemoryNet`] carries it inside one
//! process under a virtual clock, and loses, delays and reorders what a test tells it to. No other
//! crate of the rig names zenoh; the benchmarks do, to put a bare zenoh beside this bus.
//!
//! | module | holds |
//! | --- | --- |
//! | [`bus`] | the trait and its parts |
//! | [`inbox`] | bounded queues and the wake-up that they share |
//! | [`typed`] | messages instead of bytes |
//! | [`credit`] | streams that lose nothing: credit, a ring, re-asking for gaps |
//! | [`rivals`] | the choice between two senders under one name |
//! | [`participants`] | the programs of a rig, and what each sends, receives and answers |
//! | [`clock`] | the rig's clock |
//! | [`reason`](mod@reason) | what a library says, without paths of the machine that built it |
//! | [`rig`] | the rig's folder, and the file by which a foreign program finds it |
//! | [`sockets`] | the sockets in it, put back where they were removed |

mod announce;
pub mod bus;
pub mod clock;
pub mod credit;
pub mod inbox;
mod memory;
pub mod participants;
mod payload;
mod pool;
pub mod reason;
mod recent;
pub mod rig;
pub mod rivals;
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
pub use payload::{Lent, Payload};
pub use pool::clear_shared_memory;
pub use recent::Recent;
pub use rig::{RigFolder, RigInfo};
pub use zenoh_bus::{Dial, ZenohBus};
