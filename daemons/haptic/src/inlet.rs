//! Messages about force from the rig, for the servo.

use maulstick_bus::sender_arbiter::Once;
use maulstick_bus::typed::{Received, Receiver};
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_haptics::Recipient;
use maulstick_types::Message;
use maulstick_types::stylus::StylusStatus;

use crate::senders::{Means, Senders, Verdict};
use crate::servo::channels::Delivery;

/// Meaning of a message to the servo, or its refusal.
type Reads<M, T> = Box<dyn Fn(&M) -> Result<T, &'static str>>;

/// The way in of the messages of a topic.
pub(crate) struct Inlet<M: Message, T> {
    messages: Receiver<M>,
    means: Means,
    /// True for a message to a device in its current session.
    accepts: fn(&Recipient, &M) -> bool,
    reads: Reads<M, T>,
    deliveries: u64,
    /// True once a refusal has been logged.
    warned: bool,
    /// Senders of which it was said that they are refused.
    refused: Once,
}

impl<M: Message, T> Inlet<M, T> {
    /// Listens on a topic.
    ///
    /// # Errors
    /// [`BusError`].
    pub(crate) fn new(
        (bus, topic): (&dyn Bus, &str),
        means: Means,
        accepts: fn(&Recipient, &M) -> bool,
        reads: impl Fn(&M) -> Result<T, &'static str> + 'static,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        let messages = Receiver::new(bus, topic, Qos::RealTime, Queue::Ring(64), wake)?;
        Ok(Self {
            messages: messages.of_all_senders(),
            means,
            accepts,
            reads: Box::new(reads),
            deliveries: 0,
            warned: false,
            refused: Once::default(),
        })
    }

    /// The newest message of the sender that is followed, if one has come; one that is not for the recipient, or not of a
    /// sender that may move the hand, or makes no sense, is counted in `told`.
    pub(crate) fn newest(
        &mut self,
        recipient: &Recipient,
        senders: &mut Senders,
        told: &mut StylusStatus,
        now_ns: u64,
    ) -> Option<Delivery<T>> {
        let mut newest = None;
        while let Some(received) = self.messages.try_recv() {
            if !(self.accepts)(recipient, &received.message) {
                told.foreign_models += 1;
                continue;
            }
            match senders.judge(self.means, received.header.origin(), now_ns) {
                Verdict::Followed => newest = Some(received),
                Verdict::SetAside => {}
                Verdict::Refused => {
                    told.refused_senders += 1;
                    self.refuse(&received);
                }
            }
        }
        let received = newest?;
        match (self.reads)(&received.message) {
            Ok(model) => {
                self.deliveries += 1;
                Some(Delivery {
                    model: Some(model),
                    sender: Some(received.header.origin()),
                    number: self.deliveries,
                })
            }
            Err(what) => {
                told.foreign_models += 1;
                if !std::mem::replace(&mut self.warned, true) {
                    tracing::warn!("{}: a message is dropped: {what}", received.key);
                }
                None
            }
        }
    }

    /// Says once of a sender that it may not move the hand.
    fn refuse(&mut self, received: &Received<M>) {
        let source = received.header.source;
        if self.refused.say(&source.to_string()) {
            tracing::warn!(
                "{}: another program (source {source:08x}) would move the hand, and is refused: one sender a device; \
                 `maulstick recording replay --drive` asks before it does, and `driven_by` in rig.toml names others",
                received.key
            );
        }
    }
}
