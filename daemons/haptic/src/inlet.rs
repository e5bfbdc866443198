//! Messages about force from the rig, for the servo.

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_haptics::Recipient;
use maulstick_types::Message;

use crate::servo::channels::Delivery;

/// What a message means to the servo, or why it is refused.
type Reads<M, T> = Box<dyn Fn(&M) -> Result<T, &'static str>>;

/// The way in of the messages of a topic.
pub(crate) struct Inlet<M: Message, T> {
    messages: Receiver<M>,
    /// True for a message to a device in its current session.
    accepts: fn(&Recipient, &M) -> bool,
    reads: Reads<M, T>,
    deliveries: u64,
    /// True once a refusal has been logged.
    warned: bool,
}

impl<M: Message, T> Inlet<M, T> {
    /// Listens on a topic.
    ///
    /// # Errors
    /// [`BusError`].
    pub(crate) fn new(
        (bus, topic): (&dyn Bus, &str),
        accepts: fn(&Recipient, &M) -> bool,
        reads: impl Fn(&M) -> Result<T, &'static str> + 'static,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        Ok(Self {
            messages: Receiver::new(bus, topic, Qos::RealTime, Queue::Ring(64), wake)?,
            accepts,
            reads: Box::new(reads),
            deliveries: 0,
            warned: false,
        })
    }

    /// The newest message, if one has come; one that is not for the recipient, or is refused, is counted.
    pub(crate) fn newest(
        &mut self,
        recipient: &Recipient,
        foreign: &mut u64,
    ) -> Option<Delivery<T>> {
        let received = self.messages.newest()?;
        if !(self.accepts)(recipient, &received.message) {
            *foreign += 1;
            return None;
        }
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
                *foreign += 1;
                if !std::mem::replace(&mut self.warned, true) {
                    tracing::warn!("{}: a message is dropped: {what}", received.key);
                }
                None
            }
        }
    }
}
