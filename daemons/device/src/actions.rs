//! What the switches of a stylus do, and its eraser end.
//!
//! The device's own thread only tells edges; a thread beside it asks the paint node for what they mean,
//! one after the other, however long that takes. The clutch is no command: the device itself lets go of
//! the desk by it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver as Edges, SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use glam::DVec3;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Class, Queue, Wake};
use maulstick_num::geometry::Rigid;
use maulstick_rig::Fault;
use maulstick_rig::config::DeviceSection;
use maulstick_types::Pose;
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushHandling, BrushMode, CANVAS, PALETTE, Scene, Surface};
use maulstick_types::stylus::{StylusSample, switch};
use maulstick_types::topics::Topics;

use crate::commander::Commander;

/// Switches of a stylus; the highest bit is its eraser end.
pub const SWITCHES: usize = 31;
/// Edges that may wait for the paint node.
const WAITING: usize = 32;
/// How long a command may take.
const PATIENCE: Duration = Duration::from_secs(2);
/// A command is asked again after this.
const ASK: Duration = Duration::from_millis(300);
/// How long the scene may take to show what was done.
const SHOWN: Duration = Duration::from_secs(1);
/// Height of the palette above the canvas, m: its board is 4 mm thick, and paint lies under it.
const OVER_M: f64 = 0.01;
/// Gap between the palette at rest and the canvas, m.
const BESIDE_M: f64 = 0.01;
/// Height of the palette at rest, m.
const REST_M: f64 = 4e-3;

/// What a switch does.
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

/// What each switch does.
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

/// Which way a switch has gone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Edge {
    Pressed,
    Released,
}

/// Something to do for the paint node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Deed {
    Switch(Action, Edge),
    /// The eraser end comes near, or goes.
    Eraser(Edge),
}

/// Does what the switches of one device ask for.
pub struct Actor {
    actions: Actions,
    /// Switches as they have been told.
    told: u32,
    deeds: Option<SyncSender<Deed>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// Whether it was said that the paint node does not keep up.
    warned: bool,
}

impl Actor {
    /// Starts the thread for a device that moves `brush`.
    ///
    /// # Errors
    /// A [`Fault`] where the rig or the system refuses.
    pub fn start(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        brush: &str,
        actions: Actions,
    ) -> Result<Self, Fault> {
        let (deeds, edges) = sync_channel(WAITING);
        let stop = Arc::new(AtomicBool::new(false));
        let wake = Wake::new();
        let scenes = Receiver::new(&*bus, &topics.scene(), Class::Cached, Queue::Latest, &wake)?;
        let mut worker = Worker {
            commander: Commander::new(bus, topics).asking(ASK),
            scenes,
            wake,
            scene: None,
            brush: brush.to_owned(),
            held: Held::default(),
            before: None,
            rest: None,
            stop: Arc::clone(&stop),
        };
        let thread = std::thread::Builder::new()
            .name("switches".into())
            .spawn(move || worker.run(&edges))
            .map_err(|error| Fault::failure(format!("no thread for the switches: {error}")))?;
        Ok(Self {
            actions,
            told: 0,
            deeds: Some(deeds),
            stop,
            thread: Some(thread),
            warned: false,
        })
    }

    /// Looks at a sample for switches that have gone down or up. It never waits: an edge for which there
    /// is no room is seen again in the next sample.
    pub fn hear(&mut self, sample: &StylusSample) {
        let near = match sample.in_range {
            true => u32::MAX,
            false => !switch::ERASER,
        };
        let changed = (sample.switches & near) ^ self.told;
        for place in (0..u32::BITS).filter(|place| changed & 1 << place != 0) {
            let bit = 1 << place;
            let edge = match self.told & bit == 0 {
                true => Edge::Pressed,
                false => Edge::Released,
            };
            let deed = match bit {
                switch::ERASER => Deed::Eraser(edge),
                _ => Deed::Switch(self.actions.of_bit(place as usize), edge),
            };
            if self.tell(deed) {
                self.told ^= bit;
            }
        }
    }

    fn tell(&mut self, deed: Deed) -> bool {
        if let Deed::Switch(Action::None | Action::Clutch, _) = deed {
            return true;
        }
        let Some(deeds) = &self.deeds else {
            return true;
        };
        match deeds.try_send(deed) {
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

/// What was begun by a switch that is still held is ended.
impl Drop for Actor {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::SeqCst);
        self.deeds = None;
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

impl std::fmt::Debug for Actor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Actor")
            .field("actions", &self.actions)
            .finish_non_exhaustive()
    }
}

/// What uses the brush in another way for as long as it lasts.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    picks: bool,
    erases: bool,
}

impl Held {
    fn mode(self) -> Option<BrushMode> {
        match self {
            Self { erases: true, .. } => Some(BrushMode::Vacuum),
            Self { picks: true, .. } => Some(BrushMode::Sampler),
            _ => None,
        }
    }
}

/// The thread that talks to the paint node.
struct Worker {
    commander: Commander,
    scenes: Receiver<Scene>,
    wake: Wake,
    scene: Option<Scene>,
    brush: String,
    held: Held,
    /// How the brush was used before something was held.
    before: Option<BrushHandling>,
    /// Where the palette was before it was slid over the canvas.
    rest: Option<Pose>,
    stop: Arc<AtomicBool>,
}

impl Worker {
    fn run(&mut self, edges: &Edges<Deed>) {
        while let Ok(deed) = edges.recv() {
            // What was pressed long ago and is still to do at the end is no longer wanted.
            if self.stop.load(Ordering::SeqCst) {
                break;
            }
            self.act(deed);
        }
        self.held = Held::default();
        self.follow();
    }

    fn act(&mut self, deed: Deed) {
        let brush = self.brush.clone();
        match deed {
            Deed::Eraser(edge) => {
                self.held.erases = edge == Edge::Pressed;
                self.follow();
            }
            Deed::Switch(Action::Pick, edge) => {
                self.held.picks = edge == Edge::Pressed;
                self.follow();
            }
            Deed::Switch(Action::Undo, Edge::Pressed) => {
                self.send(Command::Undo { brush: Some(brush) });
            }
            Deed::Switch(Action::Clean, Edge::Pressed) => {
                self.send(Command::Clean { brush });
            }
            Deed::Switch(Action::Palette, Edge::Pressed) => self.slide(),
            Deed::Switch(..) => {}
        }
    }

    /// Uses the brush as what is held says, or as before.
    fn follow(&mut self) {
        let Some(mode) = self.held.mode() else {
            if let Some(handling) = self.before.take() {
                self.handle(handling);
            }
            return;
        };
        let begins = self.before.is_none();
        if begins {
            let brush = self.brush.clone();
            let scene = self.look(SHOWN, |_| true);
            let now = scene.map(|scene| handling(scene, &brush));
            self.before = Some(now.unwrap_or_else(|| BrushHandling::normal(&brush)));
        }
        let told = self.handle(BrushHandling {
            mode,
            ..BrushHandling::normal(&self.brush)
        });
        if !told && begins {
            self.before = None;
        }
    }

    /// Says how the brush is used; whether it is so then.
    fn handle(&mut self, wanted: BrushHandling) -> bool {
        let brush = self.brush.clone();
        let command = Command::Handle {
            handling: wanted.clone(),
        };
        // The next that is held asks the scene how the brush is used: it has to have come.
        self.send(command)
            && self
                .look(SHOWN, |scene| handling(scene, &brush) == wanted)
                .is_some()
    }

    /// Slides the palette over the canvas, or back to where it was.
    fn slide(&mut self) {
        let Some(scene) = self.look(SHOWN, |_| true) else {
            tracing::warn!("the palette stays where it is: there is no painting yet");
            return;
        };
        let surface = |id| scene.surfaces.iter().find(|surface| surface.id == id);
        let (Some(canvas), Some(palette)) = (surface(CANVAS), surface(PALETTE)) else {
            return;
        };
        let (over, beside) = (over(canvas, palette), beside(canvas, palette));
        let (zoom, now) = (palette.zoom, palette.pose.clone());
        let to = match is_same(&now, &over) {
            true => self.rest.take().unwrap_or(beside),
            false => {
                self.rest = Some(now);
                over
            }
        };
        let told = self.send(Command::Place {
            surface: PALETTE,
            pose: to.clone(),
            zoom,
        });
        if told {
            self.look(SHOWN, |scene| {
                let mut surfaces = scene.surfaces.iter();
                surfaces.any(|surface| surface.id == PALETTE && is_same(&surface.pose, &to))
            });
        }
    }

    /// The newest scene, once it is as `wanted`; none where it is not in time.
    fn look(&mut self, patience: Duration, wanted: impl Fn(&Scene) -> bool) -> Option<&Scene> {
        let give_up = Instant::now() + patience;
        loop {
            if let Some(received) = self.scenes.newest() {
                self.scene = Some(received.message);
            }
            let left = give_up.saturating_duration_since(Instant::now());
            let shown = self.scene.as_ref().is_some_and(&wanted);
            if shown || left.is_zero() || self.stop.load(Ordering::SeqCst) {
                return self.scene.as_ref().filter(|_| shown);
            }
            // Short enough that a daemon's end does not wait for it.
            self.wake.wait(left.min(Duration::from_millis(50)));
        }
    }

    /// Sends a command; whether it was done. What is refused is told.
    fn send(&mut self, command: Command) -> bool {
        let stop = Arc::clone(&self.stop);
        let stopped = || stop.load(Ordering::SeqCst);
        match self.commander.send(command, None, PATIENCE, &stopped) {
            Ok(_) => true,
            Err(fault) => {
                let help = fault.help.map(|help| format!("; {help}"));
                tracing::warn!("a switch: {}{}", fault.what, help.unwrap_or_default());
                false
            }
        }
    }
}

/// How a brush is used in a scene.
fn handling(scene: &Scene, brush: &str) -> BrushHandling {
    let mut handlings = scene.handlings.iter();
    handlings
        .find(|handling| handling.brush == brush)
        .cloned()
        .unwrap_or_else(|| BrushHandling::normal(brush))
}

/// Width and height of a surface on the desk, m.
fn size_m(surface: &Surface) -> DVec3 {
    let [across, up] = surface.cells.map(f64::from);
    DVec3::new(across, up, 0.0) * (surface.cell_m * surface.zoom)
}

/// A place of the canvas, from its middle, for the middle of the palette.
fn at(canvas: &Surface, palette: &Surface, from_middle: DVec3) -> Pose {
    let corner = 0.5 * size_m(canvas) + from_middle - 0.5 * size_m(palette);
    let canvas = Rigid::from(&canvas.pose);
    Rigid {
        translation: canvas.point(corner),
        ..canvas
    }
    .to_pose()
}

/// The palette over the middle of the canvas.
fn over(canvas: &Surface, palette: &Surface) -> Pose {
    at(canvas, palette, DVec3::Z * OVER_M)
}

/// The palette to the left of the canvas, where a painting begins with it.
fn beside(canvas: &Surface, palette: &Surface) -> Pose {
    let aside = 0.5 * (size_m(canvas).x + size_m(palette).x) + BESIDE_M;
    at(canvas, palette, DVec3::new(-aside, 0.0, REST_M))
}

/// Whether two poses differ by rounding alone.
fn is_same(a: &Pose, b: &Pose) -> bool {
    let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    near(&a.position_m, &b.position_m) && near(&a.orientation, &b.orientation)
}

#[cfg(test)]
mod tests {
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
    fn deaf(room: usize, actions: &[&str]) -> (Actor, Edges<Deed>) {
        let mut device = DeviceSection::new("arm", "polhem", "main");
        device.switches = Some(actions.iter().map(ToString::to_string).collect());
        let (deeds, edges) = sync_channel(room);
        let actor = Actor {
            actions: Actions::of(&device),
            told: 0,
            deeds: Some(deeds),
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
            actor.hear(&sample(switches, true));
        }
        let told: Vec<Deed> = edges.try_iter().collect();
        let expected = [
            (Action::Undo, Edge::Pressed),
            (Action::Pick, Edge::Pressed),
            (Action::Undo, Edge::Released),
            (Action::Pick, Edge::Released),
        ];
        assert_eq!(
            told,
            expected.map(|(action, edge)| Deed::Switch(action, edge))
        );
    }

    #[test]
    fn the_eraser_counts_while_it_is_near() {
        let (mut actor, edges) = deaf(32, &[]);
        actor.hear(&sample(switch::ERASER, false));
        assert_eq!(edges.try_iter().count(), 0);
        actor.hear(&sample(switch::ERASER, true));
        actor.hear(&sample(switch::ERASER, false));
        let told: Vec<Deed> = edges.try_iter().collect();
        assert_eq!(
            told,
            [Deed::Eraser(Edge::Pressed), Deed::Eraser(Edge::Released)]
        );
    }

    #[test]
    fn a_release_for_which_there_was_no_room_is_told_later() {
        let (mut actor, edges) = deaf(1, &["pick"]);
        actor.hear(&sample(1, true));
        for _ in 0..100 {
            actor.hear(&sample(0, true));
        }
        let pressed = Deed::Switch(Action::Pick, Edge::Pressed);
        assert_eq!(edges.try_recv(), Ok(pressed));
        assert!(edges.try_recv().is_err());
        actor.hear(&sample(0, true));
        assert_eq!(
            edges.try_recv(),
            Ok(Deed::Switch(Action::Pick, Edge::Released))
        );
    }
}
