//! The thread that asks the paint node for what switches mean.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver as Edges;
use std::time::{Duration, Instant};

use glam::DVec3;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Class, Queue, Wake};
use maulstick_num::geometry::Rigid;
use maulstick_rig::Fault;
use maulstick_types::Pose;
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushHandling, BrushMode, CANVAS, PALETTE, Scene, Surface};
use maulstick_types::topics::Topics;

use super::{Action, Deed, Edge};
use crate::commander::Commander;

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
pub(super) struct Worker {
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
    /// For the switches of a device that moves `brush`, until `stop` is set.
    pub(super) fn new(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        brush: &str,
        stop: Arc<AtomicBool>,
    ) -> Result<Self, Fault> {
        let wake = Wake::new();
        let topic = topics.scene();
        let scenes = Receiver::new(&*bus, &topic, Class::Cached, Queue::Latest, &wake)?;
        Ok(Self {
            commander: Commander::new(bus, topics).asking(ASK),
            scenes,
            wake,
            scene: None,
            brush: brush.to_owned(),
            held: Held::default(),
            before: None,
            rest: None,
            stop,
        })
    }

    /// Does what comes, one after the other, until nobody can press a switch any more.
    pub(super) fn run(&mut self, edges: &Edges<Deed>) {
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
