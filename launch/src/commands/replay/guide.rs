//! A recording guides the hand at a device: its strokes are sent as guides, each as far as the hand has come along it.

use std::time::{Duration, Instant};

use glam::DVec3;
use maulstick_brush::BrushFile;
use maulstick_brush::desk::ferrule;
use maulstick_brush::solver::HalfSpace;
use maulstick_bus::typed::{Receiver, Sender};
use maulstick_bus::{Qos, Queue};
use maulstick_rig::config::BrushSection;
use maulstick_rig::{NodeHandle, UserError};
use maulstick_streams::Recording;
use maulstick_streams::topic_pattern::matches;
use maulstick_types::brush::BrushDef;
use maulstick_types::decode;
use maulstick_types::haptics::GuideModel;
use maulstick_types::stylus::{StylusPose, StylusSample};
use serde_json::json;

use super::consent::Consent;
use super::driven::{Driven, PATIENCE};
use super::orders::{GUIDE_KEYS, Orders};
use super::traced::{Touch, Traced};
use super::transport::Order;
use super::{REPORT_PERIOD, ReplayOptions};
use crate::EXIT_INTERRUPTED;
use crate::commands::print_json_line;
use crate::performance::brush_file;

/// Topics of the hands.
const HANDS: &str = "stylus/*/sample";
/// Time between two guides.
const PERIOD: Duration = Duration::from_millis(10);
/// Lifetime of a guide: ten periods.
const TIME_TO_LIVE_NS: u64 = 100_000_000;
/// Stiffness, damping and largest force of a guide at full strength.
const STIFFNESS_N_M: f64 = 100.0;
const DAMPING_N_S_M: f64 = 0.5;
const MOST_N: f64 = 0.6;
/// A brush that is higher above the canvas is let go, m.
const NEAR_M: f64 = 0.03;
/// Step of a key that changes the strength.
pub(super) const STRONGER: f64 = 0.1;

/// The brush at the guided device.
struct Brush {
    head_length_m: f64,
    depth_share: f64,
}

impl Brush {
    /// The brush of the device, as its node has it.
    fn find(member: &NodeHandle, name: &str) -> Result<Self, UserError> {
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
        let give_up = Instant::now() + PATIENCE;
        let head_length_m = loop {
            if let Some(def) = defs.newest()
                && let Ok(file) = BrushFile::parse(&def.message.toml)
            {
                break file.length_m();
            }
            if Instant::now() >= give_up || member.stop.requested() {
                let unknown = || UserError::usage(format!("the rig has no brush '{name}'"));
                let section: &BrushSection = section.ok_or_else(unknown)?;
                break brush_file(section)?.length_m();
            }
            member.wake.wait(PERIOD);
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
        match presses && sample.in_range {
            true => (tip, Touch::Canvas),
            false => (tip, Touch::Air),
        }
    }
}

/// Guides the hand at the device `name` along the recorded strokes.
///
/// # Errors
/// A [`UserError`] where no rig runs, the device is not in it, or the recording has no strokes of one hand.
pub(super) fn guide(options: &ReplayOptions, name: &str) -> Result<i32, UserError> {
    let path = options.recording.display().to_string();
    let mut recording = Recording::open(&options.recording)?;
    let [first_ns, last_ns] = recording.times_ns().unwrap_or_default();
    let range_ns = options.range_ns(last_ns.saturating_sub(first_ns))?;
    let hand = hand(options, &recording)?;
    let member = options.join()?;
    let driven = Driven::find(&member, name)?;
    let brush = Brush::find(&member, &driven.brush)?;
    let mut samples = Vec::new();
    recording.messages(range_ns.map(|ns| first_ns + ns), &mut |message| {
        if message.channel == hand
            && let Ok((_, sample)) = decode::<StylusSample>(&message.bytes)
            && sample.fault().is_none()
        {
            let (tip, touch) = brush.tip(&sample);
            samples.push((message.arrived_ns.saturating_sub(first_ns), tip, touch));
        }
        true
    })?;
    let traced = Traced::of(samples);
    if traced.counts()[0] == 0 {
        return Err(UserError::usage("it has no stroke on the canvas")
            .at(path)
            .help("a stroke is longer than 2 mm; `maulstick recording info` shows what there is"));
    }
    let mut guide = Guiding::new(options, &member, driven, brush, traced)?;
    while !member.stop.requested() && guide.turn()? {
        member.wake.wait(PERIOD);
    }
    if guide.orders.are_keys() {
        eprintln!();
    }
    drop(guide);
    let code = member.stop.exit_code(EXIT_INTERRUPTED);
    member.leave();
    Ok(code)
}

/// The channel of the one hand whose strokes guide.
fn hand(options: &ReplayOptions, recording: &Recording) -> Result<u16, UserError> {
    let is_meant = |topic: &str| {
        let mut chosen = options.topic.iter();
        matches(HANDS, topic) && (options.topic.is_empty() || chosen.any(|own| matches(own, topic)))
    };
    let topics = recording.topics().iter();
    let hands: Vec<(u16, &str)> = topics
        .map(|(channel, topic)| (*channel, topic.name.as_str()))
        .filter(|(_, topic)| is_meant(topic))
        .collect();
    let wrong = |what: &str| UserError::usage(what).at(options.recording.display().to_string());
    match hands.as_slice() {
        [(channel, _)] => Ok(*channel),
        [] => Err(wrong("it has no samples of a hand")
            .help("record a hand that paints: `maulstick recording record -o hand.mcap`")),
        [(_, one), ..] => Err(wrong("it has the samples of several hands, and one guides")
            .help(format!("choose one: --topic {one}"))),
    }
}

/// What guides.
struct Guiding<'a> {
    options: &'a ReplayOptions,
    member: &'a NodeHandle,
    device: Driven,
    brush: Brush,
    traced: Traced,
    samples: Receiver<StylusSample>,
    guides: Sender<GuideModel>,
    consent: Consent,
    orders: Orders,
    strength: f64,
    paused: bool,
    /// When the next guide is due, and the next line.
    due: Instant,
    report: Instant,
}

impl<'a> Guiding<'a> {
    fn new(
        options: &'a ReplayOptions,
        member: &'a NodeHandle,
        device: Driven,
        brush: Brush,
        traced: Traced,
    ) -> Result<Self, UserError> {
        let (bus, topics) = (&*member.bus, &member.topics);
        let sample = topics.sample(&device.name);
        let topic = topics.guide(&device.name);
        let me = member.origin(&member.node);
        let consent = Consent::ask(member, &device.name, me)?;
        let orders = Orders::listen(options.json)?;
        if orders.are_keys() {
            eprintln!("{GUIDE_KEYS}");
        }
        Ok(Self {
            samples: Receiver::new(bus, &sample, Qos::RealTime, Queue::Ring(16), &member.wake)?,
            guides: Sender::new(bus, &topic, Qos::RealTime, me)?,
            consent,
            options,
            member,
            device,
            brush,
            traced,
            orders,
            strength: options.strength,
            paused: false,
            due: Instant::now(),
            report: Instant::now(),
        })
    }

    /// Follows the hand and sends its guide; false at the end.
    fn turn(&mut self) -> Result<bool, UserError> {
        while let Some(order) = self.orders.next() {
            if order == Order::End {
                return Ok(false);
            }
            self.obey(order);
        }
        let now = Instant::now();
        if now < self.due {
            return Ok(true);
        }
        self.due = now + PERIOD;
        self.consent.renew(self.member)?;
        let Some(sample) = self.samples.newest() else {
            return Ok(true);
        };
        // It may have been started anew.
        self.device.origin = sample.header.origin();
        let (tip, touch) = self.brush.tip(&sample.message);
        self.traced.follow(tip, touch);
        let [count, traced] = self.traced.counts();
        if count == traced {
            self.tell(now)?;
            if self.options.again {
                self.traced.seek(0);
            }
            return Ok(self.options.again);
        }
        if !self.paused && self.strength > 0.0 {
            let strength = match sample.message.in_range && tip.z < NEAR_M {
                true => self.strength,
                false => 0.0,
            };
            self.send(strength)?;
        }
        if now >= self.report {
            self.tell(now)?;
        }
        Ok(true)
    }

    fn obey(&mut self, order: Order) {
        match order {
            Order::Pause => self.paused = !self.paused,
            Order::Strength(strength) => self.strength = strength,
            Order::Stronger(by) => self.strength = (self.strength + by).clamp(0.0, 1.0),
            Order::Seek(s) => self.traced.seek((s.max(0.0) * 1e9) as u64),
            Order::Skip(by_s) => {
                let s = self.traced.position_ns().unwrap_or(0) as f64 * 1e-9 + by_s;
                self.traced.seek((s.max(0.0) * 1e9) as u64);
            }
            // The hand's own pace is the rate.
            Order::Step | Order::Rate(_) | Order::Faster(_) | Order::End => {}
        }
        self.report = Instant::now();
    }

    fn send(&mut self, strength: f64) -> Result<(), UserError> {
        let Some(points_m) = self.traced.piece() else {
            return Ok(());
        };
        let now_ns = self.member.bus.now_ns();
        let model = GuideModel {
            device: self.device.origin.source,
            device_epoch: self.device.origin.epoch,
            points_m,
            normal: [0.0, 0.0, 1.0],
            head_length_m: self.brush.head_length_m,
            stiffness_n_m: STIFFNESS_N_M * strength,
            damping_n_s_m: DAMPING_N_S_M * strength,
            max_force_n: MOST_N * strength,
            time_to_live_ns: TIME_TO_LIVE_NS,
        };
        self.guides.send(now_ns, now_ns, &model)?;
        Ok(())
    }

    /// Says how far the hand has come.
    fn tell(&mut self, now: Instant) -> Result<(), UserError> {
        self.report = now + REPORT_PERIOD;
        let [count, traced] = self.traced.counts();
        let s = self.traced.position_ns().map(|ns| ns as f64 * 1e-9);
        let (strength, paused) = (self.strength, self.paused);
        if self.options.json {
            return print_json_line(&json!({
                "position_s": s,
                "strokes": count,
                "traced": traced,
                "strength": strength,
                "paused": paused,
            }));
        }
        if self.orders.are_keys() {
            let percent = (100.0 * strength).round();
            let paused = if paused { "  paused" } else { "        " };
            eprint!("\r{traced} of {count} strokes  strength {percent} %{paused}  ");
        }
        Ok(())
    }
}
