//! The thread that asks the paint node for the actions of switches.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver as Edges, RecvTimeoutError};
use std::time::{Duration, Instant};

use maulstick_brush::palette_place::{Side, beside, is_same, over};
use maulstick_brush::placement::place;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Qos, Queue, Wake};
use maulstick_rig::UserError;
use maulstick_rig::user_error::EXIT_USAGE;
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushHandling, BrushMode, CANVAS, PALETTE, Scene};
use maulstick_types::values::BrushName;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Edit, Pose};
use serde_json::json;

use maulstick_rig::command_client::CommandClient;

use super::{Action, Edge, SwitchEvent};

/// Longest wait for a command.
const PATIENCE: Duration = Duration::from_secs(2);
/// A command is asked again after this.
const ASK: Duration = Duration::from_millis(300);
/// Interval at which the restoring of a handling is requested again.
const AGAIN: Duration = Duration::from_secs(1);
/// Longest wait until the scene shows the result.
const SHOWN: Duration = Duration::from_secs(1);

/// Temporary brush modes, while a switch is pressed.
#[derive(Clone, Copy, Debug, Default)]
struct HeldModes {
    picks: bool,
    erases: bool,
}

impl HeldModes {
    fn mode(self) -> Option<BrushMode> {
        match self {
            Self { erases: true, .. } => Some(BrushMode::Vacuum),
            Self { picks: true, .. } => Some(BrushMode::Sampler),
            _ => None,
        }
    }
}

/// Outcome of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    Done,
    /// The node has said no.
    Refused,
    /// Nobody has answered: it may be done, or be done yet.
    Unknown,
}

/// Handling of the brush during a temporary mode, and the one restored since.
#[derive(Clone, Debug)]
struct Restored {
    held: BrushHandling,
    before: BrushHandling,
}

/// The thread that talks to the paint node.
pub(super) struct Worker {
    commander: CommandClient,
    scenes: Receiver<Scene>,
    wake: Wake,
    scene: Option<Scene>,
    brush: BrushName,
    held: HeldModes,
    /// Handling of the brush before the temporary mode, until it is restored.
    before: Option<BrushHandling>,
    /// Handling last requested by a temporary mode.
    asked: Option<BrushHandling>,
    /// The newest restoring: the scene may not show it yet.
    restored: Option<Restored>,
    /// Placement of the palette before it was slid over the canvas.
    rest: Option<Pose>,
    /// True once it was reported that nobody answers.
    unheard: bool,
    stop: Arc<AtomicBool>,
}

impl Worker {
    /// For the switches of a device that moves `brush`, until `stop` is set.
    pub(super) fn new(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        brush: &str,
        stop: Arc<AtomicBool>,
    ) -> Result<Self, UserError> {
        let wake = Wake::new();
        let topic = topics.scene();
        let scenes =
            Receiver::new(&*bus, &topic, Qos::Cached, Queue::Latest, &wake)?.checking(Scene::fault);
        Ok(Self {
            commander: CommandClient::new(bus, topics).asking(ASK),
            scenes,
            wake,
            scene: None,
            brush: BrushName::new(brush)?,
            held: HeldModes::default(),
            before: None,
            asked: None,
            restored: None,
            rest: None,
            unheard: false,
            stop,
        })
    }

    /// Handles the edges one after the other, until no further switch can be pressed.
    pub(super) fn run(&mut self, edges: &Edges<SwitchEvent>) {
        loop {
            let next = if self.owes() {
                edges.recv_timeout(AGAIN)
            } else {
                edges.recv().map_err(RecvTimeoutError::from)
            };
            // A press of long ago that is still pending at the end is dropped.
            if self.stop.load(Ordering::SeqCst) {
                break;
            }
            match next {
                Ok(event) => self.act(event),
                Err(RecvTimeoutError::Timeout) => self.follow(),
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        self.held = HeldModes::default();
        self.follow();
    }

    /// True while the former handling is to be restored.
    fn owes(&self) -> bool {
        self.before.is_some() && self.held.mode().is_none()
    }

    fn act(&mut self, event: SwitchEvent) {
        let brush = self.brush.clone();
        match event {
            SwitchEvent::Eraser(edge) => {
                self.held.erases = edge == Edge::Pressed;
                self.follow();
            }
            SwitchEvent::Switch(Action::Pick, edge) => {
                self.held.picks = edge == Edge::Pressed;
                self.follow();
            }
            SwitchEvent::Switch(Action::Undo, Edge::Pressed) => {
                self.send(of_brush("undo", &brush));
            }
            SwitchEvent::Switch(Action::Clean, Edge::Pressed) => {
                self.send(of_brush("clean", &brush));
            }
            SwitchEvent::Switch(Action::Palette, Edge::Pressed) => self.slide(),
            SwitchEvent::Switch(..) => {}
        }
    }

    /// Sets the temporary mode of the pressed switches, or restores the former handling.
    ///
    /// The former handling is kept until the node has answered that it is restored: a command that nobody answers may
    /// have been done.
    fn follow(&mut self) {
        let Some(mode) = self.held.mode() else {
            let Some(before) = self.before.clone() else {
                return;
            };
            match self.handle(before.clone()) {
                Answer::Done => {
                    let restored = |held| Restored { held, before };
                    self.restored = self.asked.take().map(restored);
                    self.before = None;
                }
                Answer::Refused => self.before = None,
                Answer::Unknown => {}
            }
            return;
        };
        let begins = self.before.is_none();
        if begins {
            self.before = Some(self.now());
        }
        let wanted = BrushHandling {
            mode,
            ..BrushHandling::normal(&self.brush)
        };
        match self.handle(wanted.clone()) {
            Answer::Refused if begins => self.before = None,
            Answer::Refused => {}
            Answer::Done | Answer::Unknown => self.asked = Some(wanted),
        }
    }

    /// Handling of the brush without temporary modes.
    fn now(&mut self) -> BrushHandling {
        let brush = self.brush.clone();
        let scene = self.look(SHOWN, |_| true);
        let now = scene.map(|scene| handling(scene, &brush));
        let now = now.unwrap_or_else(|| BrushHandling::normal(&brush));
        if let Some(Restored { held, before }) = &self.restored
            && *held == now
        {
            return before.clone();
        }
        match now.mode {
            // Another device's switch, or that of a daemon that was killed: nobody would end it.
            BrushMode::Vacuum | BrushMode::Sampler => BrushHandling {
                mode: BrushMode::Normal,
                ..now
            },
            _ => now,
        }
    }

    fn handle(&mut self, handling: BrushHandling) -> Answer {
        let most = (handling.most_m != 0.0).then_some(handling.most_m);
        let fields = json!({
            "brush": handling.brush, "mode": handling.mode, "flow": handling.flow, "most": most,
        });
        self.send(Edit::named("handle", &fields))
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
        let (over, beside) = (over(canvas, palette), beside(canvas, palette, Side::Left));
        let (zoom, now) = (palette.zoom, palette.pose.clone());
        // The canvas may have moved since; what was slid over it goes back all the same.
        let (to, rest) = match &self.rest {
            Some(rest) => (rest.clone(), None),
            None if is_same(&now, &over) => (beside, None),
            None => (over, Some(now)),
        };
        let told = match place(PALETTE, &to, zoom) {
            Ok(edit) => self.send(edit),
            Err(error) => return tracing::warn!("the palette stays where it is: {error}"),
        };
        if told == Answer::Done {
            self.rest = rest;
            // The next slide asks the scene where the palette is: it has to have come.
            self.look(SHOWN, |scene| {
                let mut surfaces = scene.surfaces.iter();
                surfaces.any(|surface| surface.id == PALETTE && is_same(&surface.pose, &to))
            });
        }
    }

    /// The newest scene, once it is as `wanted`; `None` if it is not in time.
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

    /// Sends a command. A failure is reported.
    fn send(&mut self, edit: impl Into<Command>) -> Answer {
        let stop = Arc::clone(&self.stop);
        let stopped = || stop.load(Ordering::SeqCst);
        let fault = match self.commander.send(edit, None, PATIENCE, &stopped) {
            Ok(_) => {
                self.unheard = false;
                return Answer::Done;
            }
            Err(fault) => fault,
        };
        // None of these commands fails but by its node's word or its silence.
        let told = match fault.code {
            EXIT_USAGE => Answer::Refused,
            _ => Answer::Unknown,
        };
        // Silence is reported once: a value to restore is asked for again and again.
        let unheard = told == Answer::Unknown;
        if !(std::mem::replace(&mut self.unheard, unheard) && unheard) {
            let help = fault.help.map(|help| format!("; {help}"));
            tracing::warn!("a switch: {}{}", fault.what, help.unwrap_or_default());
        }
        told
    }
}

/// An edit that names a brush alone.
fn of_brush(name: &str, brush: &BrushName) -> Edit {
    Edit::named(name, &json!({ "brush": brush }))
}

/// Handling of a brush in a scene.
fn handling(scene: &Scene, brush: &str) -> BrushHandling {
    let mut handlings = scene.handlings.iter();
    handlings
        .find(|handling| handling.brush == brush)
        .cloned()
        .unwrap_or_else(|| BrushHandling::normal(brush))
}
