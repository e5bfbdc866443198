//! Senders of recorded messages, each as one of now.

use std::collections::BTreeMap;
use std::time::Duration;

use maulstick_bus::Qos;
use maulstick_bus::bus::Publish;
use maulstick_rig::NodeHandle;
use maulstick_streams::Recording;
use maulstick_streams::recording::RecordedMessage;
use maulstick_streams::topic_pattern::matches;
use maulstick_types::stylus::{StylusInfo, StylusSample};
use maulstick_types::wire::header::HEADER_BYTES;
use maulstick_types::{Flags, Header, Origin, decode, encode, name_hash};

use super::driven::Driven;
use super::pacing::Pacing;
use super::place::Place;
use crate::error::RecorderError;

/// Topics that move the hand at a device: contact models and forces of paint.
pub(super) const DRIVING: [&str; 2] = [MODELS, FLUIDS];
const MODELS: &str = "haptics/*/model";
const FLUIDS: &str = "haptics/*/fluid";

/// True if what a topic has moves the hand at a device.
pub(super) fn drives(topic: &str) -> bool {
    DRIVING.iter().any(|pattern| matches(pattern, topic))
}

/// Senders by topic, each with the number of its next message.
pub(super) struct Senders<'a> {
    pub(super) member: &'a NodeHandle,
    /// As whom contact models and forces of paint are sent.
    pub(super) driver: Origin,
    pub(super) senders: BTreeMap<String, (Box<dyn Publish>, u64)>,
    pub(super) renamed: &'a BTreeMap<String, String>,
    pub(super) device: Option<&'a str>,
    pub(super) driven: Option<Driven>,
    /// Where samples of a stylus are put.
    pub(super) place: Option<Place>,
    pub(super) pacing: Pacing,
    /// Times of sampling of the newest message of each topic, as recorded and as sent, ns.
    pub(super) newest_ns: BTreeMap<String, (u64, u64)>,
}

impl Senders<'_> {
    /// Time to wait for credit; `None` where the brushes have it for another sample.
    pub(super) fn wait_for_credit(&mut self) -> Option<Duration> {
        self.pacing.wait_for_credit(self.member.bus.now_ns())
    }

    /// The topic as which a topic is sent.
    fn topic(&self, topic: &str) -> String {
        if let Some(renamed) = self.renamed.get(topic) {
            return renamed.clone();
        }
        let mut parts: Vec<&str> = topic.split('/').collect();
        match (parts.as_mut_slice(), self.device, &self.driven) {
            ([first, middle, _], Some(device), _) if ["stylus", "control"].contains(first) => {
                *middle = device;
            }
            (["haptics", middle, _], _, Some(driven)) => *middle = &driven.name,
            _ => {}
        }
        parts.join("/")
    }

    /// Introduces the device as which samples are sent, with what the recorded one said of itself.
    pub(super) fn introduce(
        &mut self,
        recorded: Option<StylusInfo>,
        device: &str,
    ) -> Result<(), RecorderError> {
        let Some(info) = recorded else {
            return Ok(());
        };
        let info = StylusInfo {
            device: device.to_owned(),
            drives: 0,
            ..info
        };
        let topic = format!("stylus/{device}/info");
        let bytes = self.encoded(&topic, Flags::NONE, [0, 0], &info)?;
        self.put(&topic, Qos::Cached, bytes)
    }

    /// Sender of a topic: the one that is named in it; of what drives a device the replay, by whose consent the brush's
    /// own ones are set aside.
    fn origin(&self, topic: &str) -> Origin {
        if drives(topic) {
            return self.driver;
        }
        Origin {
            source: name_hash(topic.split('/').nth(1).unwrap_or(topic)),
            epoch: self.driver.epoch,
        }
    }

    fn encoded<M: maulstick_types::Message>(
        &self,
        topic: &str,
        flags: Flags,
        [seq, event_ns]: [u64; 2],
        message: &M,
    ) -> Result<Vec<u8>, RecorderError> {
        let now_ns = self.member.bus.now_ns();
        let origin = self.origin(topic);
        Ok(encode(&origin, flags, seq, event_ns, now_ns, message)?)
    }

    /// Sends a message as one of now: its number and its times are new.
    pub(super) fn send(
        &mut self,
        recorded: &str,
        message: &RecordedMessage,
    ) -> Result<(), RecorderError> {
        let topic = self.topic(recorded);
        let now_ns = self.member.bus.now_ns();
        let old = message.header;
        let event_ns = now_ns.saturating_sub(old.sent_ns.saturating_sub(old.event_ns));
        let event_ns = self.advancing(&topic, old.event_ns, event_ns);
        let seq = self.senders.get(&topic).map_or(0, |(_, next)| *next);
        let bytes = match (&self.driven, &self.place) {
            (Some(driven), _) if matches(MODELS, recorded) => {
                let model = driven.address(message)?;
                self.encoded(&topic, Flags::NONE, [seq, event_ns], &model)?
            }
            (Some(driven), _) if matches(FLUIDS, recorded) => {
                let force = driven.address_fluid(message)?;
                self.encoded(&topic, Flags::NONE, [seq, event_ns], &force)?
            }
            (_, Some(place)) if matches("stylus/*/sample", recorded) => {
                let sample = place.sample(&message.bytes)?;
                self.encoded(&topic, Flags::NONE, [seq, event_ns], &sample)?
            }
            _ => {
                let origin = self.origin(&topic);
                let header = Header {
                    source: origin.source,
                    epoch: origin.epoch,
                    flags: Flags::NONE,
                    seq,
                    event_ns,
                    sent_ns: now_ns,
                    ..old
                };
                let body = message.bytes.get(HEADER_BYTES..).unwrap_or_default();
                [header.to_bytes().as_slice(), body].concat()
            }
        };
        let qos = if topic.starts_with("haptics/") || topic.ends_with("/sample") {
            Qos::RealTime
        } else {
            Qos::Data
        };
        self.put(&topic, qos, bytes)
    }

    /// The time of sampling of a message of a topic: later than that of the one before, where it was so when they were
    /// recorded. Played faster than they came, messages are closer together than the times that they took to arrive.
    fn advancing(&mut self, topic: &str, recorded_ns: u64, event_ns: u64) -> u64 {
        let newest = self.newest_ns.get(topic).copied();
        let event_ns = match newest {
            Some((before_ns, newest_ns)) if recorded_ns > before_ns => event_ns.max(newest_ns + 1),
            _ => event_ns,
        };
        self.newest_ns
            .insert(topic.to_owned(), (recorded_ns, event_ns));
        event_ns
    }

    /// Takes the styluses away, so that a brush does not go on from where they were to where they are next.
    pub(super) fn lift(&mut self) -> Result<(), RecorderError> {
        let is_stylus = |topic: &&String| matches("stylus/*/sample", topic);
        let topics: Vec<String> = self.senders.keys().filter(is_stylus).cloned().collect();
        for topic in topics {
            let seq = self.senders.get(&topic).map_or(0, |(_, next)| *next);
            let times = [seq, self.member.bus.now_ns()];
            let bytes = self.encoded(&topic, Flags::NONE, times, &StylusSample::away())?;
            self.put(&topic, Qos::RealTime, bytes)?;
        }
        Ok(())
    }

    fn put(&mut self, topic: &str, qos: Qos, bytes: Vec<u8>) -> Result<(), RecorderError> {
        if !self.senders.contains_key(topic) {
            let key = format!("{}{topic}", self.member.topics.prefix());
            let publisher = self.member.bus.publisher(&key, qos)?;
            self.senders.insert(topic.to_owned(), (publisher, 0));
        }
        if let Some((publisher, next)) = self.senders.get_mut(topic) {
            publisher.put(bytes)?;
            *next += 1;
            let next = *next;
            if matches("stylus/*/sample", topic) {
                let (device, now_ns) = (self.origin(topic), self.member.bus.now_ns());
                self.pacing.sent(device, next, now_ns);
            }
        }
        Ok(())
    }
}

/// The first information of a stylus in a recording.
pub(super) fn first_info(mut recording: Recording) -> Result<Option<StylusInfo>, RecorderError> {
    let topics = recording.topics().iter();
    let infos = topics.filter(|(_, topic)| matches("stylus/*/info", &topic.name));
    let infos: Vec<u16> = infos.map(|(channel, _)| *channel).collect();
    let mut found = None;
    recording.messages([0, u64::MAX], &mut |message| {
        if infos.contains(&message.channel) {
            found = decode::<StylusInfo>(&message.bytes).ok();
        }
        found.is_none()
    })?;
    Ok(found.map(|(_, info)| info))
}
