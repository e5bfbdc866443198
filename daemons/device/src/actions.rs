//! Actions of a stylus's switches and its eraser end.
//!
//! The device's own thread only reports edges; another thread asks the paint node for their actions, one after the
//! other, however long that takes. The clutch is no command: it decouples the device itself from the desk.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;

use maulstick_bus::Bus;
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_rig::thread::start;
use maulstick_types::stylus::{StylusSample, switch};
use maulstick_types::wire::topics::Topics;

use self::worker::Worker;

mod worker;

/// Switches of a stylus; the highest bit is its eraser end.
pub const SWITCHES: usize = 31;
/// Edges that may wait for the paint node.
const WAITING: usize = 32;

/// Action of a switch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Action {
    /// Nothing.
    #[default]
    None,
    /// While it is held, the hand moves without the brush.
    Clutch,
    /// While it is held, the brush takes on the colours that it touches.
    Pick,
    /// Slides the palette over the canvas, and back.
    Palette,
    /// Takes the brush's newest step back.
    Undo,
    /// Takes all paint off the brush.
    Clean,
}

/// Action of each switch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Actions([Action; SWITCHES]);

impl Actions {
    /// As a section of `rig.toml` says; names that it does not know do nothing.
    #[must_use]
    pub fn of(device: &DeviceSection) -> Self {
        let mut actions = [Action::None; SWITCHES];
        for (action, name) in actions.iter_mut().zip(device.actions()) {
            *action = match name {
                "clutch" => Action::Clutch,
                "pick" => Action::Pick,
                "palette" => Action::Palette,
                "undo" => Action::Undo,
                "clean" => Action::Clean,
                _ => Action::None,
            };
        }
        Self(actions)
    }

    /// The bits of the switches that do `action`.
    #[must_use]
    pub fn bits(&self, action: Action) -> u32 {
        let bits = self.0.iter().enumerate();
        bits.filter(|(_, does)| **does == action)
            .fold(0, |all, (place, _)| all | 1 << place)
    }

    fn of_bit(&self, place: usize) -> Action {
        self.0.get(place).copied().unwrap_or_default()
    }
}

/// Direction of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Edge {
    Pressed,
    Released,
}

/// Something to do for the paint node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SwitchEvent {
    Switch(Action, Edge),
    /// The eraser end comes near, or goes.
    Eraser(Edge),
}

/// Does what the switches of one device ask for.
pub struct Actor {
    actions: Actions,
    /// Switches as last reported.
    told: u32,
    events: Option<SyncSender<SwitchEvent>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// True once it was reported that the paint node does not keep up.
    warned: bool,
}

impl Actor {
    /// Starts the thread for a device that moves `brush`.
    ///
    /// # Errors
    /// A [`UserError`] where the rig or the system refuses.
    pub fn start(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        brush: &str,
        actions: Actions,
    ) -> Result<Self, UserError> {
        let (events, edges) = sync_channel(WAITING);
        let stop = Arc::new(AtomicBool::new(false));
        let mut worker = Worker::new(bus, topics, brush, Arc::clone(&stop))?;
        let thread = start("switches", move || worker.run(&edges))?;
        Ok(Self {
            actions,
            told: 0,
            events: Some(events),
            stop,
            thread: Some(thread),
            warned: false,
        })
    }

    /// Looks at a sample for switches that have gone down or up. It never waits: an edge for which there
    /// is no room is seen again in the next sample.
    pub fn receive(&mut self, sample: &StylusSample) {
        let near = if sample.in_range {
            u32::MAX
        } else {
            !switch::ERASER
        };
        self.follow(sample.switches & near);
    }

    /// The same of a device that is no stylus: only as many switches as a stylus has count.
    pub fn press(&mut self, switches: u64) {
        self.follow(switches as u32 & !switch::ERASER);
    }

    fn follow(&mut self, switches: u32) {
        let changed = switches ^ self.told;
        for place in (0..u32::BITS).filter(|place| changed & 1 << place != 0) {
            let bit = 1 << place;
            let edge = if self.told & bit == 0 {
                Edge::Pressed
            } else {
                Edge::Released
            };
            let event = match bit {
                switch::ERASER => SwitchEvent::Eraser(edge),
                _ => SwitchEvent::Switch(self.actions.of_bit(place as usize), edge),
            };
            if self.tell(event) {
                self.told ^= bit;
            }
        }
    }

    fn tell(&mut self, event: SwitchEvent) -> bool {
        if let SwitchEvent::Switch(Action::None | Action::Clutch, _) = event {
            return true;
        }
        let Some(events) = &self.events else {
            return true;
        };
        match events.try_send(event) {
            Ok(()) | Err(TrySendError::Disconnected(_)) => {
                self.warned = false;
                true
            }
            Err(TrySendError::Full(_)) => {
                if !self.warned {
                    self.warned = true;
                    tracing::warn!(
                        "the paint node does not keep up with the switches; what is pressed now waits"
                    );
                }
                false
            }
        }
    }
}

/// Ends the actions of switches that are still pressed.
impl Drop for Actor {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::SeqCst);
        self.events = None;
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::Receiver as Edges;

    use super::*;

    #[test]
    fn switches_do_what_rig_toml_says_and_the_rest_nothing() {
        let mut device = DeviceSection::new("arm", "polhem", "main");
        let actions = Actions::of(&device);
        assert_eq!(actions.bits(Action::Clutch), 1);
        assert_eq!(actions.bits(Action::Undo), 2);
        device.switches = Some(
            ["none", "clutch", "pick", "clutch"]
                .map(String::from)
                .into(),
        );
        let actions = Actions::of(&device);
        assert_eq!(actions.bits(Action::Clutch), 0b1010);
        assert_eq!(actions.bits(Action::Pick), 0b100);
        device.switches = Some(vec!["undo".into(); 40]);
        assert_eq!(Actions::of(&device).bits(Action::Undo), !switch::ERASER);
    }

    /// An actor without a thread, with room for `room` deeds.
    fn deaf(room: usize, actions: &[&str]) -> (Actor, Edges<SwitchEvent>) {
        let mut device = DeviceSection::new("arm", "polhem", "main");
        device.switches = Some(actions.iter().map(ToString::to_string).collect());
        let (events, edges) = sync_channel(room);
        let actor = Actor {
            actions: Actions::of(&device),
            told: 0,
            events: Some(events),
            stop: Arc::default(),
            thread: None,
            warned: false,
        };
        (actor, edges)
    }

    fn sample(switches: u32, in_range: bool) -> StylusSample {
        StylusSample {
            switches,
            in_range,
            ..StylusSample::away()
        }
    }

    #[test]
    fn edges_are_told_once_in_order_and_the_clutch_never() {
        let (mut actor, edges) = deaf(32, &["undo", "clutch", "pick"]);
        for switches in [0, 1, 1, 0b101, 0b111, 0b110, 0] {
            actor.receive(&sample(switches, true));
        }
        let told: Vec<SwitchEvent> = edges.try_iter().collect();
        let expected = [
            (Action::Undo, Edge::Pressed),
            (Action::Pick, Edge::Pressed),
            (Action::Undo, Edge::Released),
            (Action::Pick, Edge::Released),
        ];
        assert_eq!(
            told,
            expected.map(|(action, edge)| SwitchEvent::Switch(action, edge))
        );
    }

    #[test]
    fn the_eraser_counts_while_it_is_near() {
        let (mut actor, edges) = deaf(32, &[]);
        actor.receive(&sample(switch::ERASER, false));
        assert_eq!(edges.try_iter().count(), 0);
        actor.receive(&sample(switch::ERASER, true));
        actor.receive(&sample(switch::ERASER, false));
        let told: Vec<SwitchEvent> = edges.try_iter().collect();
        assert_eq!(
            told,
            [
                SwitchEvent::Eraser(Edge::Pressed),
                SwitchEvent::Eraser(Edge::Released)
            ]
        );
    }

    #[test]
    fn a_release_for_which_there_was_no_room_is_told_later() {
        let (mut actor, edges) = deaf(1, &["pick"]);
        actor.receive(&sample(1, true));
        for _ in 0..100 {
            actor.receive(&sample(0, true));
        }
        let pressed = SwitchEvent::Switch(Action::Pick, Edge::Pressed);
        assert_eq!(edges.try_recv(), Ok(pressed));
        assert!(edges.try_recv().is_err());
        actor.receive(&sample(0, true));
        assert_eq!(
            edges.try_recv(),
            Ok(SwitchEvent::Switch(Action::Pick, Edge::Released))
        );
    }
}
