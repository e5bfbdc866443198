//! Messages of chosen topics are sent again, as those of a sender of now: strokes for the brushes that are in the rig, brush
//! states for the paint, contact models for a device.

use std::collections::BTreeMap;
use std::time::Duration;

use maulstick_bus::typed::random_epoch;
use maulstick_device::player::Rate;
use maulstick_rig::NodeHandle;
use maulstick_streams::Recording;
use maulstick_streams::recording::RecordedMessage;
use maulstick_streams::topic_pattern::matches;
use maulstick_types::{Origin, name_hash};
use tokio::task::block_in_place;

use super::consent::{Consent, RENEWAL};
use super::driven::Driven;
use super::events::Events;
use super::pacing::Pacing;
use super::place::Place;
use super::playback::{Controls, Next, Playback};
use super::senders::{DRIVING, Senders, drives, first_info};
use super::settings::{Call, ReplaySettings};
use crate::error::RecorderError;
use crate::work::blocking;

/// Topics that are sent again where none is named.
const HANDS: [&str; 2] = ["stylus/*/sample", "control/*/sample"];
/// Pause between two repetitions: there may be nothing to play.
const PAUSE: Duration = Duration::from_millis(20);

/// Sends the messages of a recording again.
///
/// # Errors
/// A [`RecorderError`] where no rig runs, or the recording has none of the topics.
pub(super) async fn replay(
    call: &Call,
    recording: &Recording,
    controls: Controls,
) -> Result<(), RecorderError> {
    let settings = &call.settings;
    let patterns = patterns(settings, recording)?;
    let place = match settings.place {
        Some(place) => {
            let take = recording.path().to_owned();
            Some(blocking(move || place.of(&take)).await?)
        }
        None => None,
    };
    let [first_ns, last_ns] = recording.times_ns().unwrap_or_default();
    let range_ns = settings.range_ns(last_ns.saturating_sub(first_ns))?;
    let source = Source {
        recording,
        patterns,
        range_ns,
    };
    let playback = Playback::new(settings, range_ns, controls);
    let member = block_in_place(|| call.join())?;
    let done = send(settings, &source, playback, place, &member).await;
    block_in_place(|| member.leave());
    done
}

/// Plays as a member of the rig.
async fn send(
    settings: &ReplaySettings,
    source: &Source<'_>,
    playback: Playback,
    place: Option<Place>,
    member: &NodeHandle,
) -> Result<(), RecorderError> {
    let driven = match &settings.drive {
        Some(device) => Some(Driven::find(member, device).await?),
        None => None,
    };
    let driver = Origin {
        source: name_hash(&member.node),
        epoch: random_epoch(),
    };
    let consent = driven
        .as_ref()
        .map(|driven| block_in_place(|| Consent::ask(member, &driven.name, driver)))
        .transpose()?;
    let mut senders = Senders {
        member,
        driver,
        senders: BTreeMap::new(),
        renamed: &settings.renamed,
        device: settings.device.as_deref(),
        driven,
        place,
        pacing: Pacing::new(&*member.bus, &member.topics, &member.wake)?,
        newest_ns: BTreeMap::new(),
    };
    if let Some(device) = &settings.device {
        let recording = source.recording.clone();
        let recorded = blocking(move || first_info(recording)).await?;
        senders.introduce(recorded, device)?;
    }
    play(settings, source, playback, &mut senders, consent).await
}

/// Plays until the end, or until it is asked to stop.
async fn play(
    settings: &ReplaySettings,
    source: &Source<'_>,
    mut playback: Playback,
    senders: &mut Senders<'_>,
    mut consent: Option<Consent>,
) -> Result<(), RecorderError> {
    let member: &NodeHandle = senders.member;
    let mut events = source.events(source.range_ns[0]);
    let mut played_ns = 0;
    while !member.stop.requested() {
        if let Some(consent) = &mut consent {
            consent.renew(member)?;
        }
        let next_ns = events.next_ns().await?;
        let next = playback.follow(next_ns, played_ns);
        let has_ended = next_ns.is_none() && next == Next::On;
        let is_over = has_ended && (!settings.repeats || playback.transport.is_over());
        if matches!(next, Next::Leap(_)) || (is_over && settings.repeats) {
            if is_over {
                playback.transport.rewind();
                playback.controls.wait(&member.wake, PAUSE).await;
            }
            senders.lift()?;
            played_ns = playback.transport.position_ns();
            events = source.events(played_ns);
            continue;
        }
        if next == Next::End || is_over {
            break;
        }
        let at_ns = next_ns.filter(|at_ns| playback.transport.is_due(*at_ns));
        let Some(at_ns) = at_ns else {
            playback.wait(next_ns, &member.wake, RENEWAL).await;
            continue;
        };
        if playback.transport.rate() == Rate::Max
            && let Some(wait) = senders.wait_for_credit()
        {
            playback.controls.wait(&member.wake, wait).await;
            continue;
        }
        played_ns = at_ns;
        if let Some((topic, message)) = events.take() {
            senders.send(&topic, &message)?;
        }
    }
    senders.lift()
}

/// Patterns of the topics that are sent.
fn patterns(
    settings: &ReplaySettings,
    recording: &Recording,
) -> Result<Vec<String>, RecorderError> {
    let path = recording.path();
    let patterns = match settings.topics.is_empty() {
        true if settings.drive.is_some() => DRIVING.map(str::to_owned).to_vec(),
        true => HANDS.map(str::to_owned).to_vec(),
        false => settings.topics.clone(),
    };
    let is_meant = |topic: &str| patterns.iter().any(|pattern| matches(pattern, topic));
    let all = recording.topics().values().map(|topic| topic.name.clone());
    let all: Vec<String> = all.collect();
    if !all.iter().any(|topic| is_meant(topic)) {
        return Err(RecorderError::NoTopic {
            wanted: patterns,
            known: all,
            file: path.to_owned(),
        });
    }
    let mut driving: Vec<&String> = all.iter().filter(|topic| is_meant(topic)).collect();
    driving.retain(|topic| drives(topic));
    if !driving.is_empty() && settings.drive.is_none() {
        return Err(RecorderError::MovesHand);
    }
    let device = |topic: &str| topic.split('/').nth(1).map(str::to_owned);
    if let [one, others @ ..] = driving.as_slice()
        && others.iter().any(|other| device(other) != device(one))
    {
        return Err(RecorderError::SeveralDevices {
            device: device(one).unwrap_or_default(),
            file: path.to_owned(),
        });
    }
    Ok(patterns)
}

/// Part of a recording that is played.
struct Source<'a> {
    recording: &'a Recording,
    /// Patterns of its topics.
    patterns: Vec<String>,
    /// Beginning and end, ns.
    range_ns: [u64; 2],
}

impl Source<'_> {
    /// Its messages from a time on, as they come.
    fn events(&self, from_ns: u64) -> Events<(String, RecordedMessage)> {
        let mut recording = self.recording.clone();
        let (patterns, to_ns) = (self.patterns.clone(), self.range_ns[1]);
        Events::read(move |feed| {
            let topics = recording.topics().clone();
            let [first_ns, _] = recording.times_ns().unwrap_or_default();
            let range = [first_ns + from_ns, first_ns.saturating_add(to_ns)];
            Ok(recording.messages(range, &mut |message| {
                let topic = topics.get(&message.channel).map(|topic| &topic.name);
                let meant = topic.filter(|topic| patterns.iter().any(|own| matches(own, topic)));
                let at_ns = message.arrived_ns.saturating_sub(first_ns);
                meant.is_none_or(|topic| feed.push(at_ns, (topic.clone(), message)))
            })?)
        })
    }
}
