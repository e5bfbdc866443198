//! A recording guides the hand at a device: its strokes are sent as guides, each as far as the hand has come along it.
//!
//! | module | holds |
//! | --- | --- |
//! | [`guiding`] | the loop that sends them |
//! | [`traced`] | how far a hand has traced the strokes |

mod guiding;
mod traced;

use glam::DVec3;
use maulstick_brush::BrushFile;
use maulstick_brush::desk::ferrule;
use maulstick_brush::solver::HalfSpace;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Qos, Queue};
use maulstick_device::brush_file;
use maulstick_rig::NodeHandle;
use maulstick_rig::config::BrushSection;
use maulstick_streams::Recording;
use maulstick_streams::topic_pattern::matches;
use maulstick_types::brush::BrushDef;
use maulstick_types::decode;
use maulstick_types::stylus::{StylusPose, StylusSample};
use tokio::task::block_in_place;
use tokio::time::timeout;

use self::guiding::Guidance;
use self::traced::{Touch, Traced};
use crate::error::RecorderError;
use crate::replay::driven::{Driven, PATIENCE};
use crate::replay::playback::Controls;
use crate::replay::settings::{Call, GuideSettings, ReplaySettings};
use crate::work::blocking;

/// Topics of the hands.
const HANDS: &str = "stylus/*/sample";

/// The brush at the guided device.
struct Brush {
    head_length_m: f64,
    depth_share: f64,
}

impl Brush {
    /// The brush of the device, as its node has it.
    async fn find(member: &NodeHandle, name: &str) -> Result<Self, RecorderError> {
        let topic = member.topics.brush_def(name);
        let mut defs: Receiver<BrushDef> = Receiver::new(
            &*member.bus,
            &topic,
            Qos::Cached,
            Queue::Ring(4),
            &member.wake,
        )?;
        let sections = &member.config.brush;
        let section = sections.iter().find(|section| section.name == name);
        let depth_share = section.map_or(0.0, |section| section.depth_share);
        let known = async {
            while !member.stop.requested() {
                let file = defs.newest().map(|def| BrushFile::parse(&def.message.toml));
                if let Some(Ok(file)) = file {
                    return Some(file.length_m());
                }
                member.wake.ringing().await;
            }
            None
        };
        let head_length_m = match timeout(PATIENCE, known).await.ok().flatten() {
            Some(length_m) => length_m,
            None => {
                let unknown = || RecorderError::NoBrush(name.to_owned());
                let section: &BrushSection = section.ok_or_else(unknown)?;
                brush_file(section)?.length_m()
            }
        };
        Ok(Self {
            head_length_m,
            depth_share,
        })
    }

    /// The undeformed tip, and whether the brush touches the canvas.
    fn tip(&self, sample: &StylusSample) -> (DVec3, Touch) {
        let length = self.head_length_m;
        let frame = ferrule(sample, length, self.depth_share, &HalfSpace::SURFACE);
        let tip = frame.point(DVec3::NEG_Z * length);
        let presses = match sample.pose {
            StylusPose::Contact { pressure, .. } => pressure > 0.0,
            StylusPose::Ferrule { .. } => tip.z < 0.0,
        };
        let touch = if presses && sample.in_range {
            Touch::Canvas
        } else {
            Touch::Air
        };
        (tip, touch)
    }
}

/// Guides the hand at a device along the recorded strokes.
///
/// # Errors
/// A [`RecorderError`] where no rig runs, the device is not in it, or the recording has no strokes of one hand.
pub(super) async fn guide(
    call: &Call,
    own: &GuideSettings,
    controls: Controls,
) -> Result<(), RecorderError> {
    let settings = &call.settings;
    let path = settings.recording.clone();
    let recording = blocking(move || Ok(Recording::open(&path)?)).await?;
    let hand = hand(settings, &recording)?;
    let member = block_in_place(|| call.join())?;
    let done = guide_as(settings, own, controls, (recording, hand), &member).await;
    block_in_place(|| member.leave());
    done
}

/// Guides as a member of the rig.
async fn guide_as(
    settings: &ReplaySettings,
    own: &GuideSettings,
    controls: Controls,
    (mut recording, hand): (Recording, u16),
    member: &NodeHandle,
) -> Result<(), RecorderError> {
    let [first_ns, last_ns] = recording.times_ns().unwrap_or_default();
    let range_ns = settings.range_ns(last_ns.saturating_sub(first_ns))?;
    let driven = Driven::find(member, &own.device).await?;
    let brush = Brush::find(member, &driven.brush).await?;
    let samples = blocking(move || {
        let mut samples = Vec::new();
        recording.messages(range_ns.map(|ns| first_ns + ns), &mut |message| {
            if message.channel == hand
                && let Ok((_, sample)) = decode::<StylusSample>(&message.bytes)
                && sample.fault().is_none()
            {
                samples.push((message.arrived_ns.saturating_sub(first_ns), sample));
            }
            true
        })?;
        Ok(samples)
    });
    let samples = samples.await?.into_iter().map(|(at_ns, sample)| {
        let (tip, touch) = brush.tip(&sample);
        (at_ns, tip, touch)
    });
    let traced = Traced::of(samples);
    if traced.counts()[0] == 0 {
        return Err(RecorderError::NoStroke(settings.recording.clone()));
    }
    let hand = (driven, brush, traced);
    let mut guidance = Guidance::new(member, hand, own.strength, controls)?;
    guidance.guide(settings.repeats).await
}

/// The channel of the one hand whose strokes guide.
fn hand(settings: &ReplaySettings, recording: &Recording) -> Result<u16, RecorderError> {
    let is_meant = |topic: &str| {
        let mut chosen = settings.topics.iter();
        matches(HANDS, topic)
            && (settings.topics.is_empty() || chosen.any(|own| matches(own, topic)))
    };
    let topics = recording.topics().iter();
    let hands: Vec<(u16, &str)> = topics
        .map(|(channel, topic)| (*channel, topic.name.as_str()))
        .filter(|(_, topic)| is_meant(topic))
        .collect();
    let file = settings.recording.clone();
    match hands.as_slice() {
        [(channel, _)] => Ok(*channel),
        [] => Err(RecorderError::NoHand(file)),
        [(_, one), ..] => {
            let one = (*one).to_owned();
            Err(RecorderError::SeveralHands { one, file })
        }
    }
}
