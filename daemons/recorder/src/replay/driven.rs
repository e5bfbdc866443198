//! The device whose hand feels a recording, by contact models or guides.

use std::time::Duration;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Qos, Queue};
use maulstick_rig::NodeHandle;
use maulstick_streams::recording::RecordedMessage;
use maulstick_types::haptics::{ContactModel, FluidForce};
use maulstick_types::stylus::{StylusInfo, StylusSample};
use maulstick_types::{Message, Origin, decode};
use tokio::time::timeout;

use crate::error::RecorderError;

/// Longest wait for the device.
pub(super) const PATIENCE: Duration = Duration::from_secs(5);

/// The device.
pub(super) struct Driven {
    pub(super) name: String,
    pub(super) origin: Origin,
    pub(super) brush: String,
}

impl Driven {
    /// Finds the device in the rig, in its current session.
    pub(super) async fn find(member: &NodeHandle, name: &str) -> Result<Self, RecorderError> {
        let (bus, topics) = (&*member.bus, &member.topics);
        let queue = || Queue::Ring(16);
        let sample = topics.sample(name);
        let mut samples: Receiver<StylusSample> =
            Receiver::new(bus, &sample, Qos::RealTime, queue(), &member.wake)?;
        let info = topics.stylus_info(name);
        let mut infos: Receiver<StylusInfo> =
            Receiver::new(bus, &info, Qos::Cached, queue(), &member.wake)?;
        let (mut origin, mut brush) = (None, None);
        let found = async {
            while !member.stop.requested() {
                let sample = samples.newest();
                origin = sample.map(|sample| sample.header.origin()).or(origin);
                brush = infos
                    .newest()
                    .map(|info| info.message.brush)
                    .or(brush.take());
                if let (Some(origin), Some(brush)) = (origin, &brush) {
                    let main = "main".to_owned();
                    return Some(Self {
                        name: name.to_owned(),
                        origin,
                        brush: if brush.is_empty() {
                            main
                        } else {
                            brush.clone()
                        },
                    });
                }
                member.wake.ringing().await;
            }
            None
        };
        timeout(PATIENCE, found)
            .await
            .ok()
            .flatten()
            .ok_or_else(|| RecorderError::NoDevice(name.to_owned()))
    }

    /// A recorded force of paint as one for this device.
    pub(super) fn address_fluid(
        &self,
        message: &RecordedMessage,
    ) -> Result<FluidForce, RecorderError> {
        let force: FluidForce = read("a force of paint cannot be read", message)?;
        Ok(FluidForce {
            device: self.origin.source,
            device_epoch: self.origin.epoch,
            ..force
        })
    }

    /// A recorded model as one for this device.
    pub(super) fn address(&self, message: &RecordedMessage) -> Result<ContactModel, RecorderError> {
        let model: ContactModel = read("a contact model cannot be read", message)?;
        Ok(ContactModel {
            device: self.origin.source,
            device_epoch: self.origin.epoch,
            brush: self.brush.clone(),
            ..model
        })
    }
}

fn read<M: Message>(what: &str, message: &RecordedMessage) -> Result<M, RecorderError> {
    let read = decode::<M>(&message.bytes).map(|(_, message)| message);
    read.map_err(|error| RecorderError::Unreadable {
        what: what.to_owned(),
        error: error.into(),
        file: None,
    })
}
