//! Subscribers that fill the [`LiveRig`].

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_types::brush::BrushDef;
use maulstick_types::command::PAINT_NODE;
use maulstick_types::paint::{Entry, JournalEntry, PaintStatus};
use maulstick_types::scene::Scene;
use maulstick_types::stylus::{StylusInfo, StylusSample, StylusStatus};
use maulstick_types::wire::topics::Topics;

use crate::state::{BrushDefinition, LiveRig, PaintNode, RigEvent};
use crate::thumbnails::Thumbnails;

/// Subscribers of the window besides samples and brush states.
pub struct RigListener {
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
    pub fn new(bus: &dyn Bus, topics: &Topics, wake: &Wake) -> Result<Self, BusError> {
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

    /// Reads what has come; `true` if the scene has changed.
    pub fn drain(&mut self, now_ns: u64, rig: &mut LiveRig) -> bool {
        rig.now_ns = now_ns;
        self.drain_nodes(rig);
        self.drain_devices(rig);
        while let Some(def) = self.defs.try_recv() {
            rig.definitions.push(BrushDefinition {
                epoch: def.header.epoch,
                brush: def.message.brush,
                toml: def.message.toml,
            });
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
            rig.scene = Some(scene.message);
        }
        is_new
    }

    fn drain_nodes(&self, rig: &mut LiveRig) {
        while let Some(token) = self.tokens.try_recv() {
            let Some(node) = self.topics.node_of(&token.key) else {
                continue;
            };
            rig.nodes.retain(|known| known != node);
            if token.present {
                rig.nodes.push(node.to_owned());
                if node == PAINT_NODE {
                    rig.starts += 1;
                    rig.thumbnails = Thumbnails::default();
                }
            }
        }
    }

    fn drain_devices(&mut self, rig: &mut LiveRig) {
        let now_ns = rig.now_ns;
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
            device.forces.add(sample.arrived_ns, &sample.message);
            let event_ns = sample.header.event_ns;
            device.samples.add(now_ns, event_ns, &sample.message);
        }
    }
}
