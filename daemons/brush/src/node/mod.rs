//! The brush node: stylus samples in; brush states, credit and contact models out.

mod commands;
mod contact_publisher;
mod haste;
mod hold;
mod pace;
mod progress;
mod settings;
mod solving;
mod takes;

use std::sync::Arc;
use std::time::Duration;

use glam::DVec3;
use maulstick_brush::BrushModel;
use maulstick_brush::desk::aim;
use maulstick_bus::sender_arbiter::Once;
use maulstick_bus::typed::{Reader, Received, Receiver, Sender};
use maulstick_bus::{
    Announcer, Bus, BusError, CreditReceiver, CreditSender, Qos, Queue, Recent, Server,
    Subscription, Wake,
};
use maulstick_types::brush::{BrushConsumed, BrushDef, BrushRelief, BrushState};
use maulstick_types::command::reply_cache::ReplyCache;
use maulstick_types::haptics::{ContactModel, Grain};
use maulstick_types::paint::PaintConsumed;
use maulstick_types::scene::Scene;
use maulstick_types::stylus::{StylusInfo, StylusPose, StylusSample};
use maulstick_types::window::PendingOrders;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin, name_hash};

use crate::arbiter::{Arbiter, Range, Stroke};
use crate::contact_model::{NO_GRAIN, grain};
use crate::fluid_force::{Held, drag};
use crate::outbox::Outbox;
use crate::path_simplifier::{PathSimplifier, Place, Waiting};

use commands::{AskedBrush, ToldFile};
use contact_publisher::DragSent;
use haste::Haste;
use hold::Hold;
use pace::Pace;
use progress::Progress;
pub use settings::{BrushDevices, BrushSettings};
use settings::{DeviceClaims, moved_by};
use takes::Take;

/// Live, states older than this are not added to: the brush merges, ns.
const OLDEST_NS: u64 = 50_000_000;

/// Solves of a turn at most, but for those of its last sample: the node hears what comes meanwhile.
const SOLVES_A_TURN: usize = 256;

/// The paint node's name.
const PAINT: &str = "paint";

/// Presence of the paint node: without it nothing is painted and there is no force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Painter {
    /// It is there, or never sent anything.
    There,
    /// It has gone.
    Gone,
}

/// The brush node.
pub struct BrushNode {
    bus: Arc<dyn Bus>,
    topics: Topics,
    settings: BrushSettings,
    model: BrushModel,
    samples: CreditReceiver<StylusSample>,
    states: CreditSender<BrushState>,
    credit: Receiver<PaintConsumed>,
    scene: Receiver<Scene>,
    /// The next scene, while samples from before it wait to be solved.
    next_scene: Option<Received<Scene>>,
    /// When the scene that is followed was sent, ns.
    scene_ns: u64,
    infos: Receiver<StylusInfo>,
    consumed: Sender<BrushConsumed>,
    /// Claims of each device about itself.
    devices: Recent<DeviceClaims>,
    models: Recent<(Sender<ContactModel>, u64)>,
    fluids: Recent<DragSent>,
    arbiter: Arbiter,
    backlog: PathSimplifier,
    /// Solves left in this turn.
    solves_left: usize,
    /// Warnings of samples that are too fast, or dropped, that were logged.
    told_haste: Haste,
    pace: Pace,
    outbox: Outbox,
    progress: Progress,
    /// The take that has this brush to itself.
    take: Option<Take>,
    /// Devices that are gone: their takes have ended.
    gone: Recent<()>,
    /// Presence of the paint node, as far as it is known.
    painter: Painter,
    tokens: Subscription,
    /// True while the brush touches at its newest solve.
    touching: bool,
    /// Drag of the paint under the brush, N·s/m.
    drag_n_s_m: f64,
    /// Grain of the canvas.
    grain: Grain,
    reliefs: Receiver<BrushRelief>,
    /// The newest relief below the brush.
    relief: Option<BrushRelief>,
    /// Number of the newest state that touches.
    newest_contact: Option<u64>,
    /// Devices of whose faulty samples it was said.
    faulty: Once,
    def: Announcer<BrushDef>,
    /// The brush that is taken up when the strokes before it are painted.
    asked_brush: Option<AskedBrush>,
    /// The file that was told, until the painting has it.
    told_file: Option<ToldFile>,
    orders: Receiver<PendingOrders>,
    /// What windows say is pending.
    hold: Hold,
    /// True while a stroke waits for what was asked for before it.
    holds: bool,
    commands: Server,
    replies: ReplyCache,
    reader: Reader,
}

impl BrushNode {
    /// A node on `bus`; it rings `wake` when there is something to do.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn new(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        wake: &Wake,
        settings: BrushSettings,
    ) -> Result<Self, BusError> {
        let me = Origin {
            source: name_hash(&settings.name),
            epoch: settings.epoch,
        };
        let b = &*bus;
        let name = settings.name.as_str();
        let mut def = Announcer::new(b, &topics.brush_def(name), me, wake)?;
        commands::define(&mut def, b.now_ns(), name, &settings.file)?;
        Ok(Self {
            samples: CreditReceiver::new(b, topics, &topics.sample("*"), me, wake)?,
            states: CreditSender::new(b, topics, &topics.brush_state(name), me, wake)?,
            credit: Receiver::new(
                b,
                &topics.paint_consumed(),
                Qos::Control,
                Queue::Ring(64),
                wake,
            )?,
            scene: Receiver::new(b, &topics.scene(), Qos::Cached, Queue::Ring(16), wake)?
                .checking(Scene::fault),
            next_scene: None,
            scene_ns: 0,
            infos: Receiver::new(
                b,
                &topics.stylus_info("*"),
                Qos::Cached,
                Queue::Ring(64),
                wake,
            )?,
            consumed: Sender::new(b, &topics.brush_consumed(name), Qos::Control, me)?,
            model: BrushModel::new(settings.file.clone(), settings.depth_share),
            devices: Recent::default(),
            models: Recent::default(),
            fluids: Recent::default(),
            arbiter: Arbiter::default(),
            backlog: PathSimplifier::new(settings.file.length_m()),
            solves_left: 0,
            told_haste: Haste::default(),
            pace: Pace::default(),
            outbox: Outbox::default(),
            progress: Progress::default(),
            take: None,
            gone: Recent::default(),
            painter: Painter::There,
            tokens: b.watch(&topics.node("*"), wake)?,
            touching: false,
            drag_n_s_m: 0.0,
            grain: NO_GRAIN,
            reliefs: Receiver::new(
                b,
                &topics.brush_relief(name),
                Qos::RealTime,
                Queue::Ring(4),
                wake,
            )?
            .checking(BrushRelief::fault),
            relief: None,
            newest_contact: None,
            faulty: Once::default(),
            def,
            asked_brush: None,
            told_file: None,
            orders: Receiver::new(
                b,
                &topics.pending_orders(),
                Qos::Control,
                Queue::Ring(16),
                wake,
            )?,
            hold: Hold::default(),
            holds: false,
            commands: b.serve(&topics.command(name), 16, wake)?,
            replies: ReplyCache::default(),
            reader: Reader::default(),
            topics: topics.clone(),
            settings,
            bus,
        })
    }

    /// Follows other devices, or the same by other priorities and laws of force, from now on.
    pub fn set_devices(&mut self, devices: BrushDevices) {
        self.settings.devices = devices;
    }

    /// Number of states sent.
    #[must_use]
    pub fn sent(&self) -> u64 {
        self.states.next_seq()
    }

    /// Does all there is to do and returns how long to wait at most.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn turn(&mut self) -> Result<Duration, BusError> {
        let bus = Arc::clone(&self.bus);
        let now_ns = bus.now_ns();
        self.solves_left = SOLVES_A_TURN;
        self.take_in(now_ns);
        self.serve_commands(now_ns)?;
        self.def.turn(now_ns)?;
        self.samples.poll(&*bus)?;
        self.follow_scene(now_ns)?;
        let before_ns = self.next_scene.as_ref().map(|next| next.header.event_ns);
        while let Some(received) = self.next_sample(before_ns) {
            self.sample(received, now_ns)?;
        }
        self.flush(now_ns)?;
        self.take_up_asked_brush(now_ns)?;
        self.tell_file_again(now_ns)?;
        self.states.serve(now_ns)?;
        for topic in self.samples.unheard() {
            let device = self.topics.middle(&topic).unwrap_or_default();
            self.progress.forget_told(device);
        }
        let backlog = &self.backlog;
        let first = |device: Origin| backlog.first_of(device);
        self.progress.tell(now_ns, &mut self.consumed, first)?;
        Ok(match self.solves_left {
            0 => Duration::ZERO,
            _ => Duration::from_millis(20),
        })
    }

    /// Follows the desk. Samples belong to the desk as it was when they were taken: moving the canvas does not move
    /// samples that wait to be solved.
    fn follow_scene(&mut self, now_ns: u64) -> Result<(), BusError> {
        while let Some(scene) = self.next_scene.take().or_else(|| self.scene.try_recv()) {
            // Only a late scene is passed over: another painting counts its own anew.
            let sent_ns = scene.header.sent_ns.min(scene.arrived_ns);
            if sent_ns < self.scene_ns {
                continue;
            }
            while let Some(received) = self.next_sample(Some(scene.header.event_ns)) {
                self.sample(received, now_ns)?;
            }
            self.solve(now_ns);
            if self.solves_left == 0 && !self.backlog.is_empty() {
                // In the turns to come.
                self.next_scene = Some(scene);
                return Ok(());
            }
            self.scene_ns = sent_ns;
            self.model.set_scene(&scene.message);
            self.grain = grain(&scene.message);
            self.model.tune(scene.message.tuning(&self.settings.name));
            self.model.soak(scene.message.wetness(&self.settings.name));
        }
        Ok(())
    }

    /// Time after which no stroke begins before something that was asked for is done, ns; absent if all is done.
    fn pending_since_ns(&self, now_ns: u64) -> Option<u64> {
        let asked = self.asked_brush.as_ref().map(AskedBrush::since_ns);
        let told = self.told_file.as_ref();
        let told = told.and_then(|told| told.since_ns(now_ns));
        asked
            .into_iter()
            .chain(told)
            .chain(self.hold.since_ns(now_ns))
            .min()
    }

    /// Takes in who is there, credit, pending orders, the relief, and what the devices say they are.
    fn take_in(&mut self, now_ns: u64) {
        while let Some(token) = self.tokens.try_recv() {
            let node = self.topics.node_of(&token.key).unwrap_or_default();
            if node == PAINT {
                self.painter = match token.present {
                    true => Painter::There,
                    false => Painter::Gone,
                };
            } else if token.present {
                self.gone.remove(node);
            } else {
                self.gone.set(node, ());
                if self.progress.follows(node) {
                    self.touching = false;
                }
            }
        }
        while let Some(credit) = self.credit.try_recv() {
            let me = self.states.origin();
            for brush in credit
                .message
                .brushes
                .iter()
                .filter(|b| b.brush == me.source)
            {
                self.states.consumed(brush.epoch, brush.next, now_ns);
                self.drag_n_s_m = drag(brush);
                self.told_file.take_if(|told| told.hash == brush.file);
            }
        }
        while let Some(orders) = self.orders.try_recv() {
            let since_ns = orders.message.since_ns;
            self.hold.hear(&orders.header, since_ns, now_ns);
        }
        if let Some(relief) = self.reliefs.newest() {
            self.relief = Some(relief.message);
        }
        while let Some(info) = self.infos.try_recv() {
            let device = self.topics.middle(&info.key).unwrap_or_default();
            self.devices.set(device, DeviceClaims::of(info.message));
        }
    }

    /// The next sample that may be consumed: a replayed one waits for credit, and all wait for a scene. No device waits
    /// for another's. A take that is played anew does not wait for samples owed to the one before. With a time given,
    /// only samples of a live hand before it.
    fn next_sample(&mut self, before_ns: Option<u64>) -> Option<Received<StylusSample>> {
        let (topics, settings, devices) = (&self.topics, &self.settings, &self.devices);
        let mine = |next: &Received<StylusSample>| {
            let device = topics.middle(&next.key).unwrap_or_default();
            let moves = moved_by(devices, device);
            settings
                .devices
                .priority(&settings.name, device, moves)
                .is_some()
        };
        let anew = Flags::REPLAY.with(Flags::FIRST);
        if self
            .samples
            .heads()
            .any(|next| next.header.flags.has(anew) && mine(next))
        {
            self.states.reset_credit();
        }
        let has_scene = self.model.has_scene();
        let has_credit = self.outbox.is_empty() && self.states.has_credit();
        self.samples.pop_where(|next| {
            let replayed = next.header.flags.has(Flags::REPLAY);
            if before_ns.is_some_and(|before| replayed || next.header.event_ns >= before) {
                return false;
            }
            !mine(next) || (has_scene && (has_credit || !replayed))
        })
    }

    fn sample(&mut self, received: Received<StylusSample>, now_ns: u64) -> Result<(), BusError> {
        let origin = received.header.origin();
        let (seq, event_ns) = (received.header.seq, received.header.event_ns);
        let device = self
            .topics
            .middle(&received.key)
            .unwrap_or_default()
            .to_owned();
        let moves = moved_by(&self.devices, &device);
        let Some(priority) = self
            .settings
            .devices
            .priority(&self.settings.name, &device, moves)
        else {
            return Ok(());
        };
        let (brush, next) = (self.states.origin(), self.states.next_seq());
        self.progress.note(&device, origin, seq, brush.epoch, next);
        if let Some(fault) = received.message.fault()
            && self.faulty.say(&device)
        {
            tracing::warn!("{}: sample {seq} is dropped: {fault}", received.key);
        }
        let held = Held::of(&received.message);
        let moved = if received.header.flags.has(Flags::REPLAY) {
            self.replay(&device, &received, now_ns)?
        } else if received.message.fault().is_some() || self.is_held() {
            false
        } else {
            let range = match received.message.in_range {
                true => Range::Near,
                false => Range::Away,
            };
            let stroke = match self.touching {
                true => Stroke::GoesOn,
                false => Stroke::None,
            };
            self.arbiter.hear(&device, priority, range, stroke, now_ns)
        };
        if !moved {
            // A hand feels the brush that a take moves.
            return match self.is_held() && !received.header.flags.has(Flags::REPLAY) {
                true => self.feel(&device, origin, &held, now_ns),
                false => Ok(()),
            };
        }
        if !received.header.flags.has(Flags::REPLAY) {
            let sample = received.message;
            let place = self.place(&sample);
            self.pace.note(now_ns, place);
            if !self.backlog.push(Waiting {
                origin,
                seq,
                event_ns,
                sample,
                place,
            }) {
                self.tell_haste();
            }
            self.flush(now_ns)?;
        }
        self.feel(&device, origin, &held, now_ns)
    }

    /// Placement of the brush by a sample: a pen without pressure hovers, a head that is higher than it is long does
    /// not reach.
    fn place(&self, sample: &StylusSample) -> Place {
        let clear = !sample.in_range
            || match &sample.pose {
                StylusPose::Contact { pressure, .. } => *pressure == 0.0,
                StylusPose::Ferrule { pose } => {
                    let length_m = self.model.file().length_m();
                    let desk = self.model.desk();
                    let plane = desk.and_then(|desk| desk.under(aim(sample, length_m)));
                    plane.is_some_and(|plane| {
                        let above =
                            DVec3::from_array(pose.position_m) - plane.to_desk.point(DVec3::ZERO);
                        above.dot(plane.normal()) > 1.5 * length_m
                    })
                }
            };
        match clear {
            true => Place::Air,
            false => Place::Surface,
        }
    }
}

#[cfg(test)]
mod tests;
