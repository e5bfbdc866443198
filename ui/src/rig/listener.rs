//! Subscribers that fill the [`RigState`].

use maulstick_brush::BrushFile;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_types::brush::BrushDef;
use maulstick_types::paint::{Entry, JournalEntry, PaintStatus};
use maulstick_types::scene::Scene;
use maulstick_types::stylus::{StylusInfo, StylusSample, StylusStatus};
use maulstick_types::wire::topics::Topics;

use crate::rig::health::RigEvent;
use crate::rig::requests::PAINT;
use crate::rig::state::{PaintNode, RigState};
use crate::rig::thumbnails::Thumbnails;

/// Subscribers of the window besides samples and brush states.
pub(crate) struct RigListener {
    topics: Topics,
    scenes: Receiver<Scene>,
    paint: Receiver<PaintStatus>,
    defs: Receiver<BrushDef>,
    infos: Receiver<StylusInfo>,
    statuses: Receiver<StylusStatus>,
    samples: Receiver<StylusSample>,
    journal: Receiver<JournalEntry>,
    tokens: maulstick_bus::bus::Subscription,
}

impl RigListener {
    /// Listens on `bus`, and rings `wake`.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub(crate) fn new(bus: &dyn Bus, topics: &Topics, wake: &Wake) -> Result<Self, BusError> {
        let quiet = Qos::Background;
        Ok(Self {
            scenes: Receiver::new(bus, &topics.scene(), Qos::Cached, Queue::Latest, wake)?
                .checking(Scene::fault),
            // Statuses come for ever: the window looks at them as often as it shows them.
            paint: Receiver::new(
                bus,
                &topics.paint_status(),
                quiet,
                Queue::Latest,
                &Wake::new(),
            )?,
            defs: Receiver::new(
                bus,
                &topics.brush_def("*"),
                Qos::Cached,
                Queue::Ring(16),
                wake,
            )?,
            infos: Receiver::new(
                bus,
                &topics.stylus_info("*"),
                Qos::Cached,
                Queue::Ring(32),
                wake,
            )?,
            statuses: Receiver::new(
                bus,
                &topics.stylus_status("*"),
                quiet,
                Queue::Ring(32),
                &Wake::new(),
            )?,
            samples: Receiver::new(
                bus,
                &topics.sample("*"),
                Qos::RealTime,
                Queue::Ring(1024),
                &Wake::new(),
            )?,
            journal: Receiver::new(
                bus,
                &topics.journal(),
                Qos::Data,
                Queue::Ring(256),
                &Wake::new(),
            )?,
            tokens: bus.watch(&topics.node("*"), wake)?,
            topics: topics.clone(),
        })
    }

    /// Takes in what has come; `true` where the scene is another.
    pub(crate) fn take_in(&mut self, now_ns: u64, rig: &mut RigState) -> bool {
        rig.now_ns = now_ns;
        while let Some(token) = self.tokens.try_recv() {
            let Some(node) = self.topics.node_of(&token.key) else {
                continue;
            };
            rig.nodes.retain(|known| known != node);
            if token.present {
                rig.nodes.push(node.to_owned());
                if node == PAINT {
                    rig.starts += 1;
                    rig.thumbnails = Thumbnails::default();
                }
            }
        }
        while let Some(def) = self.defs.try_recv() {
            let epoch = def.header.epoch;
            let BrushDef { brush, toml, .. } = def.message;
            // The renderer of the brush reports a file that cannot be read.
            let Ok(file) = BrushFile::parse(&toml) else {
                continue;
            };
            let known = rig.brushes.iter_mut().find(|known| known.name == brush);
            if let Some(known) = known {
                known.asked.take_if(|asked| *asked == file);
                (known.file, known.epoch) = (Some((file, toml)), epoch);
            }
        }
        while let Some(info) = self.infos.try_recv() {
            let name = info.message.device.clone();
            let device = rig.devices.entry(name).or_default();
            (device.info, device.heard_ns) = (Some(info.message), now_ns);
        }
        while let Some(status) = self.statuses.try_recv() {
            let Some(name) = self.topics.middle(&status.key) else {
                continue;
            };
            let device = rig.devices.entry(name.to_owned()).or_default();
            (device.status, device.heard_ns) = (Some(status.message), now_ns);
        }
        while let Some(sample) = self.samples.try_recv() {
            let Some(name) = self.topics.middle(&sample.key) else {
                continue;
            };
            let device = rig.devices.entry(name.to_owned()).or_default();
            device.forces.hear(sample.arrived_ns, &sample.message);
            let event_ns = sample.header.event_ns;
            device.samples.hear(now_ns, event_ns, &sample.message);
        }
        while let Some(entry) = self.journal.try_recv() {
            if let Entry::Decision { what } = entry.message.entry {
                rig.events.push(RigEvent::Decided(what));
            }
        }
        if let Some(status) = self.paint.newest() {
            rig.paint = Some(PaintNode {
                status: status.message,
                heard_ns: now_ns,
            });
        }
        let scene = self.scenes.newest();
        let refused = [
            self.scenes.refusals(),
            self.paint.refusals(),
            self.defs.refusals(),
            self.infos.refusals(),
            self.statuses.refusals(),
            self.samples.refusals(),
            self.journal.refusals(),
        ];
        let refused = refused.into_iter().flatten();
        rig.events.extend(refused.map(RigEvent::Refused));
        let is_new = scene.is_some();
        if let Some(scene) = scene {
            rig.lay(scene.message);
        }
        is_new
    }
}
