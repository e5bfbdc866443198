//! Current pose and bend of each brush.
//!
//! A state follows its sample by the time of a solve, which the painter would see. So the pose comes from the
//! newest sample, by the same functions as in the brush node, and only the bend from the newest state.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use glam::DVec3;
use maulstick_brush::desk::{Desk, Plane, aim, ferrule};
use maulstick_brush::{BrushFile, Head};
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_client::stroke_barrier::SampleNumber;
use maulstick_num::geometry::Rigid;
use maulstick_types::brush::{BrushDef, BrushLook, BrushState, Solve};
use maulstick_types::name_hash;
use maulstick_types::paint::PaintConsumed;
use maulstick_types::stylus::StylusSample;
use maulstick_types::wire::topics::Topics;

use crate::render::brush::paint_colour::PaintColour;
use crate::rig::carried_paint::CarriedPaint;

/// A device that is silent for this long holds no brush, ns.
pub const SILENCE_NS: u64 = 1_000_000_000;

/// A sample and when it came.
#[derive(Clone, Debug)]
struct Heard {
    sample: StylusSample,
    arrived_ns: u64,
    epoch: u32,
    seq: u64,
}

/// States that come more than this number of samples late say nothing of how a pen is led.
const RECENT: usize = 256;

/// A brush that made itself known.
#[derive(Debug)]
struct TrackedBrush {
    file: BrushFile,
    head: Head,
    /// The device that it follows.
    device: Option<u32>,
    angles: Vec<[f32; 2]>,
    /// Solve of the newest state, and the sample that it followed.
    led: Option<(Solve, StylusSample)>,
    /// The surface that it touches.
    touches: Option<u32>,
    /// Wetness, 0 to 1.
    wetness: f32,
    /// The paint on it, if that is known.
    coat: Option<Arc<PaintColour>>,
    /// The same as its gauge shows it.
    carried: Option<CarriedPaint>,
}

/// A brush in the hand.
#[derive(Clone, Debug, PartialEq)]
pub struct BrushPose<'a> {
    /// Name of the brush.
    pub name: &'a str,
    /// Description of the brush.
    pub file: &'a BrushFile,
    /// The surface below.
    pub plane: Plane,
    /// Brush frame to the frame of that surface, in desk lengths.
    pub brush: Rigid,
    /// Its joints, as its newest state has them; straight before the first.
    pub angles: Vec<[f32; 2]>,
    /// Wetness, 0 to 1: wet bristles clump.
    pub wetness: f32,
    /// The paint on it, if that is known.
    pub coat: Option<Arc<PaintColour>>,
}

/// Follows all brushes of a rig.
pub struct BrushTracker {
    topics: Topics,
    samples: Receiver<StylusSample>,
    states: Receiver<BrushState>,
    defs: Receiver<BrushDef>,
    credit: Receiver<PaintConsumed>,
    looks: Receiver<BrushLook>,
    coats: BTreeMap<String, Option<Arc<PaintColour>>>,
    depth_shares: BTreeMap<String, f64>,
    /// The source that sends only while it moves.
    quiet: u32,
    newest: BTreeMap<u32, Heard>,
    /// The newest samples of all devices by source and time, the newest first.
    recent: VecDeque<((u32, u64), StylusSample)>,
    known: BTreeMap<String, TrackedBrush>,
}

impl BrushTracker {
    /// Follows the brushes on `bus`, each with the depth share of its name; `quiet` is the source of
    /// the window's own mouse, which says nothing while it keeps still.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(
        bus: &dyn Bus,
        topics: &Topics,
        wake: &Wake,
        depth_shares: BTreeMap<String, f64>,
        quiet: u32,
    ) -> Result<Self, BusError> {
        let (samples, states, defs, looks) = (
            topics.sample("*"),
            topics.brush_state("*"),
            topics.brush_def("*"),
            topics.brush_look("*"),
        );
        Ok(Self {
            // A sample of the device that moves a brush becomes a state of it; others change nothing that is seen.
            samples: Receiver::new(bus, &samples, Qos::RealTime, Queue::Ring(256), &Wake::new())?,
            states: Receiver::new(bus, &states, Qos::RealTime, Queue::Ring(64), wake)?,
            defs: Receiver::new(bus, &defs, Qos::Cached, Queue::Ring(16), wake)?,
            looks: Receiver::new(bus, &looks, Qos::Cached, Queue::Ring(16), wake)?,
            coats: BTreeMap::new(),
            credit: Receiver::new(
                bus,
                &topics.paint_consumed(),
                Qos::Control,
                Queue::Ring(16),
                &Wake::new(),
            )?,
            topics: topics.clone(),
            depth_shares,
            quiet,
            newest: BTreeMap::new(),
            recent: VecDeque::new(),
            known: BTreeMap::new(),
        })
    }

    /// Reads what has come.
    pub fn drain(&mut self, now_ns: u64) {
        self.drain_definitions();
        self.drain_paint();
        self.drain_samples(now_ns);
        self.drain_states();
    }

    fn drain_definitions(&mut self) {
        while let Some(def) = self.defs.try_recv() {
            match BrushFile::parse(&def.message.toml) {
                Ok(file) => {
                    // It is in the hand that had the one before, which may keep still.
                    let before = self.known.get(&def.message.brush);
                    let head = Head::of(&file);
                    let known = TrackedBrush {
                        angles: vec![[0.0; 2]; head.joints()],
                        head,
                        file,
                        device: before.and_then(|before| before.device),
                        led: None,
                        touches: None,
                        wetness: 0.0,
                        coat: None,
                        carried: None,
                    };
                    self.known.insert(def.message.brush, known);
                }
                Err(error) => tracing::warn!("{}: {error}", def.key),
            }
        }
    }

    fn drain_paint(&mut self) {
        while let Some(look) = self.looks.try_recv() {
            let name = self.topics.middle(&look.key).unwrap_or_default();
            // Its file may still be in flight.
            self.coats.insert(
                name.to_owned(),
                PaintColour::of(&look.message).map(Arc::new),
            );
        }
        for (name, known) in &mut self.known {
            let coat = self.coats.get(name).and_then(Option::as_ref);
            if coat.map(Arc::as_ptr) != known.coat.as_ref().map(Arc::as_ptr) {
                known.carried = coat.map(|coat| CarriedPaint::of(coat, &known.head));
                known.coat = coat.cloned();
            }
        }
        while let Some(credit) = self.credit.try_recv() {
            for (name, known) in &mut self.known {
                let source = name_hash(name);
                let mut brushes = credit.message.brushes.iter();
                if let Some(brush) = brushes.find(|brush| brush.brush == source) {
                    known.wetness = brush.wetness;
                }
            }
        }
    }

    fn drain_samples(&mut self, now_ns: u64) {
        while let Some(sample) = self.samples.try_recv() {
            if sample.message.fault().is_none() {
                let heard = Heard {
                    sample: sample.message,
                    arrived_ns: sample.arrived_ns,
                    epoch: sample.header.epoch,
                    seq: sample.header.seq,
                };
                let of = (sample.header.source, sample.header.event_ns);
                self.recent.truncate(RECENT - 1);
                self.recent.push_front((of, heard.sample.clone()));
                self.newest.insert(sample.header.source, heard);
            }
        }
        let quiet = self.quiet;
        self.newest.retain(|source, heard| {
            *source == quiet || now_ns < heard.arrived_ns.saturating_add(SILENCE_NS)
        });
    }

    fn drain_states(&mut self) {
        while let Some(state) = self.states.try_recv() {
            let name = self.topics.middle(&state.key).unwrap_or_default();
            let known = self.known.get_mut(name);
            if let (Some(known), Some(solve)) = (known, state.message.solves.last())
                && let Some(angles) = known.head.angles(solve)
            {
                known.device = Some(state.message.device);
                known.touches = (!solve.contacts.is_empty()).then_some(solve.surface);
                angles.clone_into(&mut known.angles);
                let of = (state.message.device, solve.event_ns);
                let sample = self.recent.iter().find(|recent| recent.0 == of);
                known.led = sample.map(|(_, sample)| (solve.clone(), sample.clone()));
            }
        }
    }

    /// The brushes over a desk, by name.
    pub fn held<'a>(&'a self, desk: &'a Desk) -> impl Iterator<Item = BrushPose<'a>> {
        self.known.iter().filter_map(|(name, known)| {
            let heard = self.newest.get(&known.device?)?;
            if !heard.sample.in_range {
                return None;
            }
            let depth_share = self.depth_shares.get(name).copied().unwrap_or_default();
            known.held(name, &heard.sample, depth_share, desk)
        })
    }

    /// Point on the desk at which the stylus of a brush points, m, and true if it touches nothing; `None` if no stylus
    /// is in range.
    #[must_use]
    pub fn aim(&self, name: &str) -> Option<(DVec3, bool)> {
        let known = self.known.get(name)?;
        let sample = &self.newest.get(&known.device?)?.sample;
        let length = known.file.length_m();
        let touches = known.touches.is_some() && !sample.in_air();
        sample.in_range.then(|| (aim(sample, length), !touches))
    }

    /// True while any brush touches a surface.
    #[must_use]
    pub fn touches(&self) -> bool {
        let mut names = self.known.keys();
        names.any(|name| self.aim(name).is_some_and(|(_, in_air)| !in_air))
    }

    /// True if the window's own mouse has a brush in its hand.
    #[must_use]
    pub fn is_led_by_mouse(&self, name: &str) -> bool {
        let known = self.known.get(name).and_then(|known| known.device);
        known == Some(self.quiet)
    }

    /// True while a device other than the window's own mouse is in range.
    #[must_use]
    pub fn hears_another(&self) -> bool {
        let others = self
            .newest
            .iter()
            .filter(|(source, _)| **source != self.quiet);
        others.into_iter().any(|(_, heard)| heard.sample.in_range)
    }

    /// Time of the newest sample, rig clock, ns; 0 before the first.
    #[must_use]
    pub fn heard_until_ns(&self) -> u64 {
        self.recent
            .front()
            .map_or(0, |((_, event_ns), _)| *event_ns)
    }

    /// The newest sample of each device received within the last second.
    pub fn newest(&self, now_ns: u64) -> impl Iterator<Item = SampleNumber> {
        let is_new = move |heard: &Heard| now_ns < heard.arrived_ns.saturating_add(SILENCE_NS);
        let newest = self.newest.iter().filter(move |(_, heard)| is_new(heard));
        newest.map(|(device, heard)| SampleNumber {
            device: *device,
            epoch: heard.epoch,
            seq: heard.seq,
        })
    }

    /// The paint on a brush as its gauge shows it, if that is known.
    #[must_use]
    pub fn carried(&self, name: &str) -> Option<&CarriedPaint> {
        self.known.get(name)?.carried.as_ref()
    }

    /// The head of a brush.
    #[must_use]
    pub fn head(&self, name: &str) -> Option<&Head> {
        self.known.get(name).map(|known| &known.head)
    }
}

impl TrackedBrush {
    fn held<'a>(
        &'a self,
        name: &'a str,
        sample: &StylusSample,
        depth_share: f64,
        desk: &Desk,
    ) -> Option<BrushPose<'a>> {
        let length = self.file.length_m();
        // A stroke stays on its surface.
        let touched = self.touches.and_then(|surface| desk.plane(surface));
        let plane = *touched.or_else(|| desk.under(aim(sample, length)))?;
        let place = |sample: &StylusSample| {
            let on_desk = ferrule(sample, length, depth_share, &plane.half_space());
            plane.to_desk.inverse().after(&on_desk)
        };
        let mut brush = place(sample);
        // A pen's brush stands beside its point, or hovers above it, as far as in its newest state.
        if let Some((solve, then)) = &self.led
            && solve.surface == plane.id
            && then.in_air() == sample.in_air()
        {
            let led = DVec3::from_array(solve.pose.position_m) * solve.zoom;
            let shift = led - place(then).translation;
            brush.translation += if sample.in_air() {
                DVec3::new(0.0, 0.0, shift.z)
            } else {
                DVec3::new(shift.x, shift.y, 0.0)
            };
        }
        let far = brush.translation.abs().max_element();
        (far < 100.0).then(|| BrushPose {
            name,
            file: &self.file,
            plane,
            brush,
            angles: self.angles.clone(),
            wetness: self.wetness,
            coat: self.coat.clone(),
        })
    }
}

impl BrushPose<'_> {
    /// A point of the surface's frame, in desk lengths, on the desk.
    #[must_use]
    pub fn on_desk(&self, local: [f64; 3]) -> DVec3 {
        self.plane.to_desk.point(DVec3::from_array(local))
    }
}

#[cfg(test)]
mod tests;
