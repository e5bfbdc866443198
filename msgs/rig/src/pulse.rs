//! Pulse of a node: its status, sent by the loop that does its work, by which the launcher sees that it makes progress.

use std::sync::{Arc, Mutex, PoisonError};

use maulstick_bus::typed::{Sender, random_epoch};
use maulstick_bus::{Bus, BusError, Qos};
use maulstick_types::node::{NodeStatus, NodeWork};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};

/// Work that a node reports; clones share it.
#[derive(Clone, Debug, Default)]
pub struct WorkCount(Arc<Mutex<NodeWork>>);

impl WorkCount {
    /// Says what the node has done.
    pub fn set(&self, work: NodeWork) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = work;
    }

    fn get(&self) -> NodeWork {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}

/// Counts the turns of a loop and sends the status of its node.
pub struct Pulse {
    sender: Sender<NodeStatus>,
    work: WorkCount,
    turns: u64,
    /// Time of the newest status, ns.
    told_ns: Option<u64>,
}

impl Pulse {
    /// The pulse of the node called `node`, which does `work`.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(
        bus: &dyn Bus,
        topics: &Topics,
        node: &str,
        work: WorkCount,
    ) -> Result<Self, BusError> {
        let origin = Origin {
            source: name_hash(node),
            epoch: random_epoch(),
        };
        let sender = Sender::new(bus, &topics.node_status(node), Qos::Background, origin)?;
        Ok(Self {
            sender,
            work,
            turns: 0,
            told_ns: None,
        })
    }

    /// Counts a turn, and sends the status where one is due.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn poll(&mut self, now_ns: u64) -> Result<(), BusError> {
        self.turns += 1;
        let is_due = |told_ns: u64| now_ns.saturating_sub(told_ns) >= NodeStatus::PERIOD_NS;
        if self.told_ns.is_none_or(is_due) {
            self.told_ns = Some(now_ns);
            let status = NodeStatus {
                process: std::process::id(),
                turns: self.turns,
                work: self.work.get(),
            };
            self.sender.send(now_ns, now_ns, &status)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use maulstick_bus::typed::Receiver;
    use maulstick_bus::{Faults, MemoryNet, Queue, Wake};

    use super::*;

    #[test]
    fn a_status_comes_twice_a_second_and_says_what_was_done() {
        let net = MemoryNet::new(1, 0, Faults::default());
        let (bus, topics, work) = (net.bus(), Topics::new("studio"), WorkCount::default());
        let topic = topics.node_status("brush-main");
        let (queue, wake) = (Queue::Ring(64), Wake::new());
        let heard = Receiver::<NodeStatus>::new(&bus, &topic, Qos::Background, queue, &wake);
        let mut heard = heard.expect("a topic");
        let mut pulse = Pulse::new(&bus, &topics, "brush-main", work.clone()).expect("a topic");
        for ms in 0..1400 {
            work.set(NodeWork {
                consumed: ms,
                ..NodeWork::default()
            });
            pulse.poll(ms * 1_000_000).expect("sent");
        }
        net.advance(1_000_000_000);
        let said: Vec<(u64, u64)> = std::iter::from_fn(|| heard.try_recv())
            .map(|status| (status.message.turns, status.message.work.consumed))
            .collect();
        assert_eq!(said, [(1, 0), (501, 500), (1001, 1000)]);
    }
}
