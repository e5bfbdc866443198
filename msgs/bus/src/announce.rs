//! Cached values that stay those of their sender though another process sends on their topic.

use maulstick_types::{Header, Message, Origin};

use crate::bus::{Bus, BusError, Qos, Subscription};
use crate::inbox::{Queue, Wake};
use crate::sender_arbiter::SILENCE_NS;
use crate::typed::Sender;

/// Sends a cached value, and sends it again once another sender, who has contradicted it, is silent.
pub struct Announcer<M> {
    sender: Sender<M>,
    heard: Subscription,
    topic: String,
    origin: Origin,
    newest: Option<M>,
    /// Time at which it was last sent, ns.
    sent_ns: u64,
    /// Values sent so far.
    sent: u64,
    /// Time of the last message of another sender, ns.
    contradicted_ns: Option<u64>,
    /// True once it was reported.
    told: bool,
}

impl<M: Message + Clone> Announcer<M> {
    /// Declares the topic and listens to it.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(bus: &dyn Bus, topic: &str, origin: Origin, wake: &Wake) -> Result<Self, BusError> {
        Ok(Self {
            sender: Sender::new(bus, topic, Qos::Cached, origin)?,
            // Earlier messages are no contradiction: the topic is not cached here.
            heard: bus.subscribe(topic, Qos::Control, Queue::Ring(16), wake)?,
            topic: topic.to_owned(),
            origin,
            newest: None,
            sent_ns: 0,
            sent: 0,
            contradicted_ns: None,
            told: false,
        })
    }

    /// Sends a value, which holds from now on.
    ///
    /// # Errors
    /// As [`Sender::send`].
    pub fn send(&mut self, now_ns: u64, value: &M) -> Result<(), BusError> {
        self.sender.send(now_ns, now_ns, value)?;
        (self.sent, self.sent_ns) = (self.sent + 1, now_ns);
        self.newest = Some(value.clone());
        Ok(())
    }

    /// True if a message was sent from here: no other has the origin, number and time of one of ours.
    fn is_own(&self, header: &Header) -> bool {
        header.origin() == self.origin && header.seq < self.sent && header.sent_ns <= self.sent_ns
    }

    /// Sends the value again where another sender has contradicted it.
    ///
    /// # Errors
    /// As [`Sender::send`].
    pub fn poll(&mut self, now_ns: u64) -> Result<(), BusError> {
        while let Some(arrival) = self.heard.try_recv() {
            let header = Header::from_bytes(&arrival.bytes);
            if header.is_ok_and(|header| !self.is_own(&header)) {
                self.contradicted_ns = Some(arrival.arrived_ns);
            }
        }
        let Some(contradicted_ns) = self.contradicted_ns else {
            return Ok(());
        };
        if !std::mem::replace(&mut self.told, true) {
            let topic = &self.topic;
            tracing::warn!("{topic}: a second program sends here: end it, or give it another name");
        }
        if now_ns < contradicted_ns.saturating_add(SILENCE_NS) {
            return Ok(());
        }
        self.contradicted_ns = None;
        match self.newest.take() {
            Some(value) => self.send(now_ns, &value),
            None => Ok(()),
        }
    }
}
