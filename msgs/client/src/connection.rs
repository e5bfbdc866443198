//! Connection to a running rig, for commands and questions.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use maulstick_bus::typed::{Received, Receiver, ask, random_epoch};
use maulstick_bus::{Bus, BusError, Dial, Qos, Queue, RigClock, RigFolder, Wake, ZenohBus};
use maulstick_rig::command_client::{CommandClient, Done};
use maulstick_rig::node_handle::CONFIG_FILE;
use maulstick_rig::{RigConfig, UserError};
use maulstick_types::command::Command;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Message, Origin, name_hash};

/// Longest wait for the answer of a node.
const PATIENCE: Duration = Duration::from_secs(10);

/// A connection to a rig, closed in the end.
#[derive(Debug)]
pub struct Client {
    bus: Arc<ZenohBus>,
    topics: Topics,
    folder: PathBuf,
}

impl Client {
    /// Joins the rig of this name.
    ///
    /// # Errors
    /// [`BusError::NoRig`] where no rig of that name runs, another where it cannot be joined.
    pub fn open(rig: impl AsRef<str>) -> Result<Self, BusError> {
        let (folder, info) = RigFolder::join(rig.as_ref())?;
        let dial = Dial {
            name: "cli".into(),
            listen: None,
            connect: vec![info.endpoint],
        };
        let bus = ZenohBus::open(&dial, RigClock::with_offset(info.clock_offset_ns))?;
        Ok(Self {
            bus: Arc::new(bus),
            topics: Topics::new(folder.rig()),
            folder: folder.path().to_owned(),
        })
    }

    /// The settings of the rig, as its nodes read them.
    ///
    /// # Errors
    /// A [`UserError`] where they cannot be read.
    pub fn config(&self) -> Result<RigConfig, UserError> {
        RigConfig::read(&self.folder.join(CONFIG_FILE))
    }

    /// Sends a command to its node of the rig called `rig`; returns what the node says.
    ///
    /// # Errors
    /// A [`UserError`] where no rig runs, or with the node's refusal.
    pub fn command(rig: impl AsRef<str>, command: impl Into<Command>) -> Result<String, UserError> {
        Self::open(rig)?.send(command)
    }

    /// The topics of the rig.
    #[must_use]
    pub fn topics(&self) -> &Topics {
        &self.topics
    }

    /// The time in the rig, ns.
    #[must_use]
    pub fn now_ns(&self) -> u64 {
        self.bus.now_ns()
    }

    /// Sends a command to its node; returns what it says.
    ///
    /// # Errors
    /// A [`UserError`] with the node's refusal.
    pub fn send(&self, command: impl Into<Command>) -> Result<String, UserError> {
        self.send_within(command, PATIENCE)
    }

    /// The same of a command that may take as long as `limit`.
    ///
    /// # Errors
    /// A [`UserError`] with the node's refusal.
    pub fn send_within(
        &self,
        command: impl Into<Command>,
        limit: Duration,
    ) -> Result<String, UserError> {
        let done = self.carry_out(command, limit)?;
        Ok(done.detail.to_string())
    }

    /// The same, with the place that the command has in the painting's journal.
    ///
    /// # Errors
    /// A [`UserError`] with the node's refusal.
    pub fn carry_out(
        &self,
        command: impl Into<Command>,
        limit: Duration,
    ) -> Result<Done, UserError> {
        let command = command.into();
        let node = command.node().to_owned();
        let bus = Arc::clone(&self.bus) as Arc<dyn Bus>;
        let is_gone = || RigFolder::join_at(&self.folder).is_err();
        CommandClient::of(bus, &self.topics, &node).carry_out(command, None, limit, &is_gone)
    }

    /// Sends a node a query of its own.
    ///
    /// # Errors
    /// A [`UserError`] if nobody answers.
    pub fn ask<Q: Message, A: Message>(&self, topic: &str, question: &Q) -> Result<A, UserError> {
        self.ask_within(topic, question, PATIENCE)
    }

    /// The same of a node that has to answer within `limit`.
    ///
    /// # Errors
    /// A [`UserError`] if nobody answers.
    pub fn ask_within<Q: Message, A: Message>(
        &self,
        topic: &str,
        question: &Q,
        limit: Duration,
    ) -> Result<A, UserError> {
        let me = Origin {
            source: name_hash("cli"),
            epoch: random_epoch(),
        };
        let answer = ask(&*self.bus, topic, Qos::Control, me, question, limit);
        answer.map_err(UserError::from)
    }

    /// Follows a topic.
    ///
    /// # Errors
    /// [`BusError::Topic`] as a [`UserError`].
    pub fn follow<M: Message>(&self, topic: &str, qos: Qos) -> Result<Feed<M>, UserError> {
        let wake = Wake::new();
        let messages = Receiver::new(&*self.bus, topic, qos, Queue::Ring(16), &wake)?;
        Ok(Feed {
            messages,
            wake,
            topic: topic.to_owned(),
        })
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        self.bus.close();
    }
}

/// Messages of one topic.
#[derive(Debug)]
pub struct Feed<M> {
    messages: Receiver<M>,
    wake: Wake,
    topic: String,
}

impl<M: Message> Feed<M> {
    /// Waits for the next message until then.
    pub fn next_before(&mut self, until: Instant) -> Option<M> {
        self.received_before(until).map(|received| received.message)
    }

    /// Waits for the next message, with its topic, until then.
    pub fn received_before(&mut self, until: Instant) -> Option<Received<M>> {
        loop {
            if let Some(received) = self.messages.try_recv() {
                return Some(received);
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return None;
            }
            self.wake.wait(left);
        }
    }

    /// Waits for the next message.
    ///
    /// # Errors
    /// A [`UserError`] where none comes.
    pub fn wait_for_next(&mut self) -> Result<Received<M>, UserError> {
        let give_up = Instant::now() + PATIENCE;
        loop {
            if let Some(received) = self.messages.newest() {
                return Ok(received);
            }
            let left = give_up.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Err(BusError::NoAnswer {
                    topic: self.topic.clone(),
                    limit_ms: PATIENCE.as_millis() as u64,
                }
                .into());
            }
            self.wake.wait(left);
        }
    }
}
