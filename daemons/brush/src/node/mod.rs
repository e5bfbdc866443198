//! The brush node: stylus samples in; brush states, credit and contact models out.

mod commands;
mod contact_publisher;
mod definition;
mod devices;
mod hold;
mod inputs;
mod output;
mod scene_feed;
mod settings;
mod solver;
mod takes;

use std::sync::Arc;
use std::time::Duration;

use maulstick_bus::typed::{CommandServer, Received};
use maulstick_bus::{Bus, BusError, CreditReceiver, Wake};
use maulstick_types::node::NodeWork;
use maulstick_types::stylus::StylusSample;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin, name_hash};

use crate::arbiter::{Range, Stroke};
use crate::fluid_force::Held;

use contact_publisher::{ContactPublisher, Hand};
use definition::Definition;
use devices::Devices;
use hold::Hold;
use inputs::{Input, Inputs};
use output::Output;
use scene_feed::SceneFeed;
pub use settings::{BrushDevices, BrushSettings};
use solver::Solver;

/// The paint node's name.
const PAINT: &str = "paint";

/// The brush node.
pub struct BrushNode {
    bus: Arc<dyn Bus>,
    topics: Topics,
    inputs: Inputs,
    samples: CreditReceiver<StylusSample>,
    scenes: SceneFeed,
    commands: CommandServer,
    devices: Devices,
    /// Orders of windows that strokes wait for.
    hold: Hold,
    definition: Definition,
    solver: Solver,
    output: Output,
    contacts: ContactPublisher,
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
        let name = settings.name.as_str();
        let me = Origin {
            source: name_hash(name),
            epoch: settings.epoch,
        };
        let b = &*bus;
        let brush = (name, &settings.file);
        Ok(Self {
            definition: Definition::new(b, topics, me, wake, brush)?,
            inputs: Inputs::new(b, topics, name, wake)?,
            samples: CreditReceiver::new(b, topics, &topics.sample("*"), me, wake)?,
            scenes: SceneFeed::new(b, topics, wake)?,
            commands: CommandServer::new(b, &topics.command(name), 16, me, wake)?,
            solver: Solver::new(&settings),
            output: Output::new(b, topics, name, me, wake)?,
            contacts: ContactPublisher::new(Arc::clone(&bus), topics, name, me),
            hold: Hold::default(),
            devices: Devices::new(settings.name, settings.devices),
            topics: topics.clone(),
            bus,
        })
    }

    /// Follows other devices, or the same by other priorities and laws of force, from now on.
    pub fn set_devices(&mut self, devices: BrushDevices) {
        self.devices.configure(devices);
    }

    /// Number of states sent.
    #[must_use]
    pub fn sent(&self) -> u64 {
        self.output.sent()
    }

    /// Work since the start, and what waits.
    #[must_use]
    pub fn work(&self) -> NodeWork {
        let counts = self.samples.counts();
        let waiting = (self.solver.backlog().len() + self.output.waiting()) as u64;
        // While paint has no room for more it is not this node that is late.
        let is_limiting = self.output.has_credit() && self.solver.is_exhausted();
        NodeWork {
            consumed: counts.received,
            produced: self.output.sent(),
            waiting: if is_limiting { waiting } else { 0 },
            held: if is_limiting { 0 } else { waiting },
            refused: counts.refused,
            lost: counts.lost + self.solver.backlog().dropped(),
            too_fast: self.solver.too_fast(),
        }
    }

    /// Does all there is to do and returns how long to wait at most.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn poll(&mut self) -> Result<Duration, BusError> {
        let now_ns = self.bus.now_ns();
        self.solver.begin_turn();
        self.drain_inputs(now_ns);
        self.serve_commands(now_ns)?;
        self.definition.serve(now_ns)?;
        self.samples.poll(&*self.bus)?;
        self.follow_scenes(now_ns)?;
        let before_ns = self.scenes.waiting_ns();
        while let Some(received) = self.next_sample(before_ns) {
            self.on_sample(received, now_ns)?;
        }
        self.flush(now_ns)?;
        self.adopt_brush(now_ns)?;
        self.definition.repeat(now_ns)?;
        self.output.serve(now_ns)?;
        for topic in self.samples.unheard() {
            let device = self.topics.middle(&topic).unwrap_or_default();
            self.output.report_again(device);
        }
        self.output.report(now_ns, self.solver.backlog())?;
        Ok(if self.solver.is_exhausted() {
            Duration::ZERO
        } else {
            Duration::from_millis(20)
        })
    }

    /// Notes presence, credit, pending orders, relief, and claims of devices.
    fn drain_inputs(&mut self, now_ns: u64) {
        while let Some(input) = self.inputs.next() {
            match input {
                Input::Presence { node, is_present } if node == PAINT => {
                    self.contacts.on_painter(is_present);
                }
                Input::Presence { node, is_present } => {
                    self.devices.on_presence(&node, is_present);
                    if !is_present && self.output.follows(&node) {
                        self.solver.lift();
                    }
                }
                Input::Consumed(consumed) => {
                    let me = self.output.source();
                    for credit in consumed.brushes.iter().filter(|it| it.brush == me) {
                        self.output.on_credit(credit, now_ns);
                        self.contacts.on_credit(credit);
                        self.definition.on_confirmed(credit.file);
                    }
                }
                Input::Pending(header, orders) => {
                    self.hold.on_pending(&header, orders.since_ns, now_ns);
                }
                Input::Relief(relief) => self.contacts.on_relief(relief),
                Input::Device { device, info } => self.devices.on_info(&device, info),
            }
        }
    }

    /// Follows the desk. Samples belong to the desk as it was when they were taken: moving the canvas does not move
    /// samples that wait to be solved.
    fn follow_scenes(&mut self, now_ns: u64) -> Result<(), BusError> {
        while let Some(scene) = self.scenes.next() {
            while let Some(received) = self.next_sample(Some(scene.header.event_ns)) {
                self.on_sample(received, now_ns)?;
            }
            self.solve(now_ns);
            if self.solver.is_exhausted() && !self.solver.backlog().is_empty() {
                self.scenes.put_back(scene);
                return Ok(());
            }
            self.scenes.follow(&scene);
            self.solver.set_scene(&scene.message);
            self.contacts.set_scene(&scene.message);
        }
        Ok(())
    }

    /// The next sample that may be consumed: a replayed one waits for credit, and all wait for a scene. No device waits
    /// for another's. A take that is played anew does not wait for samples owed to the one before. With a time given,
    /// only samples of a live hand before it.
    fn next_sample(&mut self, before_ns: Option<u64>) -> Option<Received<StylusSample>> {
        let (topics, devices) = (&self.topics, &self.devices);
        let is_mine = |next: &Received<StylusSample>| {
            let device = topics.middle(&next.key).unwrap_or_default();
            devices.priority(device).is_some()
        };
        let anew = Flags::REPLAY.with(Flags::FIRST);
        let is_anew = |next: &Received<StylusSample>| next.header.flags.has(anew) && is_mine(next);
        if self.samples.heads().any(is_anew) {
            self.output.reset_credit();
        }
        let has_scene = self.solver.model().has_scene();
        let has_room = self.output.has_room();
        self.samples.pop_where(|next| {
            let is_replayed = next.header.flags.has(Flags::REPLAY);
            if before_ns.is_some_and(|before| is_replayed || next.header.event_ns >= before) {
                return false;
            }
            !is_mine(next) || (has_scene && (has_room || !is_replayed))
        })
    }

    /// Consumes a sample: the brush follows it where its device has the brush.
    fn on_sample(&mut self, received: Received<StylusSample>, now_ns: u64) -> Result<(), BusError> {
        let (origin, seq) = (received.header.origin(), received.header.seq);
        let device = self.topics.middle(&received.key).unwrap_or_default();
        let Some(priority) = self.devices.priority(device) else {
            return Ok(());
        };
        let device = device.to_owned();
        self.output.note_consumed(&device, origin, seq);
        let fault = received.message.fault();
        if let Some(fault) = fault
            && self.devices.is_first_fault(&device)
        {
            tracing::warn!("{}: sample {seq} is dropped: {fault}", received.key);
        }
        let hand = Hand {
            device: &device,
            origin,
            held: Held::of(&received.message),
            law: self.devices.law(&device),
        };
        let is_replayed = received.header.flags.has(Flags::REPLAY);
        let moves = if is_replayed {
            self.replay(&device, &received, now_ns)?
        } else {
            fault.is_none() && self.admits((&device, priority), &received.message, now_ns)
        };
        if moves && !is_replayed {
            let event_ns = received.header.event_ns;
            self.solver
                .queue((origin, seq), event_ns, received.message, now_ns);
            self.flush(now_ns)?;
        }
        // A hand beside a take feels the brush that the take moves.
        let feels = moves || (!is_replayed && self.devices.is_held());
        if feels && self.devices.drives_force(&device) {
            let model = self.solver.model_mut();
            self.contacts.publish(&hand, model, now_ns)?;
        }
        Ok(())
    }

    /// True if a live sample moves the brush.
    fn admits(&mut self, device: (&str, i32), sample: &StylusSample, now_ns: u64) -> bool {
        if self.devices.is_held() {
            return false;
        }
        let range = if sample.in_range {
            Range::Near
        } else {
            Range::Away
        };
        let stroke = if self.solver.is_touching() {
            Stroke::GoesOn
        } else {
            Stroke::None
        };
        self.devices.admits(device, range, stroke, now_ns)
    }

    /// Sends what is solved while there is credit, and solves what waits, if paint keeps up: what
    /// has waited is one state.
    fn flush(&mut self, now_ns: u64) -> Result<(), BusError> {
        self.output.send(now_ns)?;
        if self.output.is_late(now_ns) || !self.output.has_room() {
            return Ok(());
        }
        self.solve(now_ns);
        self.output.send(now_ns)
    }

    /// Solves what waits, but for strokes that wait for an order or for another brush.
    fn solve(&mut self, now_ns: u64) {
        let orders = self.hold.since_ns(now_ns).into_iter();
        let since_ns = orders.chain(self.definition.since_ns(now_ns)).min();
        if let Some(solved) = self.solver.solve(now_ns, since_ns) {
            self.output.post_solved(solved);
        }
    }
}

#[cfg(test)]
mod tests;
