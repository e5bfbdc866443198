//! Messages of chosen topics are sent again, as those of a sender of now: strokes for the brushes that are in the rig, brush
//! states for the paint, contact models for a device.

use std::collections::BTreeMap;

use maulstick_bus::Qos;
use maulstick_bus::bus::Publish;
use maulstick_bus::typed::random_epoch;
use maulstick_device::player::Rate;
use maulstick_rig::{NodeHandle, UserError};
use maulstick_streams::Recording;
use maulstick_streams::recording::RecordedMessage;
use maulstick_streams::topic_pattern::matches;
use maulstick_types::stylus::{StylusInfo, StylusSample};
use maulstick_types::wire::header::HEADER_BYTES;
use maulstick_types::{Flags, Header, Origin, decode, encode, name_hash};

use super::consent::Consent;
use super::driven::Driven;
use super::events::Events;
use super::pacing::Pacing;
use super::place::Place;
use super::{Playback, ReplayOptions, TURN, Turn};

/// Topics that are sent again where none is named.
const HANDS: [&str; 2] = ["stylus/*/sample", "control/*/sample"];
/// Topics that move the hand at a device: contact models and forces of paint.
const DRIVING: [&str; 2] = [MODELS, FLUIDS];
const MODELS: &str = "haptics/*/model";
const FLUIDS: &str = "haptics/*/fluid";

/// Sends the messages of a recording again.
///
/// # Errors
/// A [`UserError`] where no rig runs, or the recording has none of the topics.
pub(super) fn replay(options: &ReplayOptions, recording: &Recording) -> Result<i32, UserError> {
    let path = recording.path();
    let patterns = match options.topic.is_empty() {
        true if options.drive.is_some() => DRIVING.map(str::to_owned).to_vec(),
        true => HANDS.map(str::to_owned).to_vec(),
        false => options.topic.clone(),
    };
    let is_meant = |topic: &str| patterns.iter().any(|pattern| matches(pattern, topic));
    let all = recording.topics().values().map(|topic| topic.name.clone());
    let all: Vec<String> = all.collect();
    if !all.iter().any(|topic| is_meant(topic)) {
        let what = format!("it has no topic {}", patterns.join(", "));
        return Err(UserError::usage(what)
            .at(path.display().to_string())
            .help(format!("it has {}", all.join(", "))));
    }
    let mut driving: Vec<&String> = all.iter().filter(|topic| is_meant(topic)).collect();
    driving.retain(|topic| drives(topic));
    if !driving.is_empty() && options.drive.is_none() {
        return Err(UserError::usage(
            "contact models and forces of paint move the hand that holds the device",
        )
        .help("name the device, with a hand at it that expects it: --drive DEVICE"));
    }
    let device = |topic: &str| topic.split('/').nth(1).map(str::to_owned);
    if let [one, others @ ..] = driving.as_slice()
        && others.iter().any(|other| device(other) != device(one))
    {
        let what = "it has the contact models of several devices, and one hand feels one";
        return Err(UserError::usage(what)
            .at(path.display().to_string())
            .help(format!(
                "choose one: --topic 'haptics/{}/*'",
                device(one).unwrap_or_default()
            )));
    }
    let renamed = renamed(&options.remap)?;
    let place = options.place.of(path)?;
    let [first_ns, last_ns] = recording.times_ns().unwrap_or_default();
    let range_ns = options.range_ns(last_ns.saturating_sub(first_ns))?;
    let member = options.join()?;
    let driven = match &options.drive {
        Some(device) => Some(Driven::find(&member, device)?),
        None => None,
    };
    let driver = Origin {
        source: name_hash(&member.node),
        epoch: random_epoch(),
    };
    let mut consent = match &driven {
        Some(driven) => Some(Consent::ask(&member, &driven.name, driver)?),
        None => None,
    };
    let mut senders = Senders {
        member: &member,
        driver,
        senders: BTreeMap::new(),
        renamed,
        device: options.device.as_deref(),
        driven,
        place,
        pacing: Pacing::new(&*member.bus, &member.topics, &member.wake)?,
        newest_ns: BTreeMap::new(),
    };
    if let Some(device) = &options.device {
        senders.introduce(recording, device)?;
    }
    let mut playback = Playback::new(options, range_ns)?;
    let mut events = events(recording, &patterns, range_ns)?;
    let mut played_ns = 0;
    while !member.stop.requested() {
        if let Some(consent) = &mut consent {
            consent.renew(&member)?;
        }
        let next_ns = events.next_ns()?;
        let turn = playback.turn(next_ns, played_ns)?;
        let has_ended = next_ns.is_none() && turn == Turn::On;
        let is_over = has_ended && (!options.again || playback.transport.is_over());
        if matches!(turn, Turn::Leap(_)) || (is_over && options.again) {
            if is_over {
                playback.transport.rewind();
                // There may be nothing to play.
                member.wake.wait(TURN);
            }
            senders.lift()?;
            played_ns = playback.transport.position_ns();
            events = self::events(recording, &patterns, [played_ns, range_ns[1]])?;
            continue;
        }
        if turn == Turn::End || is_over {
            break;
        }
        let fastest = playback.transport.rate() == Rate::Max;
        match next_ns {
            Some(at_ns)
                if playback.transport.is_due(at_ns) && (!fastest || senders.has_credit()) =>
            {
                played_ns = at_ns;
                if let Some((topic, message)) = events.take() {
                    senders.send(&topic, &message)?;
                }
            }
            _ => {
                member.wake.wait(TURN / 20);
            }
        }
    }
    senders.lift()?;
    let code = playback.end(&member);
    senders.senders.clear();
    member.leave();
    Ok(code)
}

/// Topics by the names that they are to have.
fn renamed(pairs: &[String]) -> Result<BTreeMap<String, String>, UserError> {
    let pair = |pair: &String| {
        let (from, to) = pair.split_once('=')?;
        let is_topic =
            |topic: &str| !topic.is_empty() && topic.split('/').all(|part| !part.is_empty());
        (is_topic(from) && is_topic(to)).then(|| (from.to_owned(), to.to_owned()))
    };
    let pairs = pairs.iter().map(|own| {
        pair(own).ok_or_else(|| {
            UserError::usage(format!("--remap {own} is not A=B"))
                .help("two topics, such as stylus/pen/sample=stylus/other/sample")
        })
    });
    pairs.collect()
}

/// True if what a topic has moves the hand at a device.
fn drives(topic: &str) -> bool {
    DRIVING.iter().any(|pattern| matches(pattern, topic))
}

/// The messages of the topics of `patterns` within a range of times, as they come.
fn events(
    recording: &Recording,
    patterns: &[String],
    [from_ns, to_ns]: [u64; 2],
) -> Result<Events<(String, RecordedMessage)>, UserError> {
    let mut recording = recording.clone();
    let patterns = patterns.to_vec();
    Events::read(move |feed| {
        let topics = recording.topics().clone();
        let [first_ns, _] = recording.times_ns().unwrap_or_default();
        let range = [first_ns + from_ns, first_ns.saturating_add(to_ns)];
        recording.messages(range, &mut |message| {
            let topic = topics.get(&message.channel).map(|topic| &topic.name);
            let meant = topic.filter(|topic| patterns.iter().any(|own| matches(own, topic)));
            let at_ns = message.arrived_ns.saturating_sub(first_ns);
            meant.is_none_or(|topic| feed.push(at_ns, (topic.clone(), message)))
        })
    })
}

/// Senders by topic, each with the number of its next message.
struct Senders<'a> {
    member: &'a NodeHandle,
    /// As whom contact models and forces of paint are sent.
    driver: Origin,
    senders: BTreeMap<String, (Box<dyn Publish>, u64)>,
    renamed: BTreeMap<String, String>,
    device: Option<&'a str>,
    driven: Option<Driven>,
    /// Where samples of a stylus are put.
    place: Option<Place>,
    pacing: Pacing,
    /// Times of sampling of the newest message of each topic, as recorded and as sent, ns.
    newest_ns: BTreeMap<String, (u64, u64)>,
}

impl Senders<'_> {
    /// True if the brushes have credit for another sample.
    fn has_credit(&mut self) -> bool {
        self.pacing.has_credit(self.member.bus.now_ns())
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

    /// Tells the rig of the device as which samples are sent.
    fn introduce(&mut self, recording: &Recording, device: &str) -> Result<(), UserError> {
        let infos: Vec<u16> = recording
            .topics()
            .iter()
            .filter(|(_, topic)| matches("stylus/*/info", &topic.name))
            .map(|(channel, _)| *channel)
            .collect();
        let mut told = None;
        recording.clone().messages([0, u64::MAX], &mut |message| {
            if infos.contains(&message.channel) {
                told = decode::<StylusInfo>(&message.bytes).ok();
            }
            told.is_none()
        })?;
        let Some((_, info)) = told else {
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
    ) -> Result<Vec<u8>, UserError> {
        let now_ns = self.member.bus.now_ns();
        encode(&self.origin(topic), flags, seq, event_ns, now_ns, message)
            .map_err(|error| UserError::failure(error.to_string()))
    }

    /// Sends a message as one of now: its number and its times are new.
    fn send(&mut self, recorded: &str, message: &RecordedMessage) -> Result<(), UserError> {
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
        let qos = match topic.starts_with("haptics/") || topic.ends_with("/sample") {
            true => Qos::RealTime,
            false => Qos::Data,
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
    fn lift(&mut self) -> Result<(), UserError> {
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

    fn put(&mut self, topic: &str, qos: Qos, bytes: Vec<u8>) -> Result<(), UserError> {
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
