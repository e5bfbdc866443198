//! Consent of a device to be moved by a replay: asked for at its beginning, and again for as long as it plays.

use std::time::{Duration, Instant};

use maulstick_bus::typed::ask;
use maulstick_bus::{Pending, Qos};
use maulstick_rig::{NodeHandle, asker};
use maulstick_types::haptics::{ForceOrder, ForceReply, ForceRequest};
use maulstick_types::{Flags, Origin, encode};

use crate::error::RecorderError;

/// Longest wait for the device's daemon.
const ANSWER: Duration = Duration::from_secs(3);
/// Time after which a consent is renewed; it holds for three seconds.
pub(super) const RENEWAL: Duration = Duration::from_secs(1);

/// A device's consent to a sender.
pub(super) struct Consent {
    topic: String,
    sender: Origin,
    request: ForceRequest,
    due: Instant,
    /// The newest renewal on its way; dropped, it might not arrive.
    _renewal: Option<Pending>,
}

impl Consent {
    /// Asks the device for its consent to `sender`.
    ///
    /// # Errors
    /// A [`RecorderError`] where its daemon does not give it.
    pub(super) fn ask(
        member: &NodeHandle,
        device: &str,
        sender: Origin,
    ) -> Result<Self, RecorderError> {
        let topic = member.topics.force(device);
        let Origin { source, epoch } = sender;
        let order = ForceOrder::Drive { source, epoch };
        let request = ForceRequest::by(&asker("`maulstick recording replay`"), order);
        let (bus, class) = (&*member.bus, Qos::Control);
        let given = ask::<_, ForceReply>(bus, &topic, class, sender, &request, ANSWER);
        given.map_err(|error| RecorderError::NoConsent {
            device: device.to_owned(),
            topic: topic.clone(),
            error,
        })?;
        Ok(Self {
            topic,
            sender,
            request,
            due: Instant::now() + RENEWAL,
            _renewal: None,
        })
    }

    /// Asks again in time; nobody waits for the answer.
    ///
    /// # Errors
    /// A [`RecorderError`] where the bus is closed.
    pub(super) fn renew(&mut self, member: &NodeHandle) -> Result<(), RecorderError> {
        if Instant::now() < self.due {
            return Ok(());
        }
        self.due = Instant::now() + RENEWAL;
        let now_ns = member.bus.now_ns();
        let bytes = encode(&self.sender, Flags::NONE, 0, now_ns, now_ns, &self.request)?;
        let pending = member
            .bus
            .ask(&self.topic, Qos::Control, bytes, ANSWER, &member.wake)?;
        self._renewal = Some(pending);
        Ok(())
    }
}
