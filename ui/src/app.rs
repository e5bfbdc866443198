//! The window.

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use eframe::egui::{
    self, CentralPanel, Context, CursorIcon, Event, Frame, PointerButton, Shape, Visuals,
};
use eframe::egui_wgpu::{RenderState, wgpu};
use maulstick_brush::desk::Desk;
use maulstick_bus::typed::{Receiver, random_epoch};
use maulstick_bus::{Bus, Class, Queue, Wake};
use maulstick_paint::lamp::lamp_over;
use maulstick_paint::picture::Export;
use maulstick_rig::{Fault, Member, Stop};
use maulstick_types::scene::{CANVAS, PALETTE, Scene, Surface};
use maulstick_types::{Origin, name_hash};

use crate::backdrop::Backdrop;
use crate::brushes::Brushes;
use crate::follow::{Follower, SILENCE_NS};
use crate::frames::{FrameInbox, FrameSource, pull};
use crate::gpu::Gpu;
use crate::mouse::{Mouse, Pointer};
use crate::progress::WorkProgress;
use crate::show_surface::Place;
use crate::surface::{Passes, SurfaceView};
use crate::view::{DESK_COLOUR, View, are_alike, at_rest, level};

/// A pressed pointer that stands still is told this often: a longer silence would lift the brush.
const STILL: Duration = Duration::from_millis(30);
/// The window is drawn anew at most this often for frames and samples, of which a device sends up to
/// 1,000 a second; where the processor draws, less often, for the paint needs it too.
const REPAINT: Duration = Duration::from_millis(16);
const REPAINT_BY_PROCESSOR: Duration = Duration::from_millis(40);
/// The surfaces that are shown, the lowest first.
const SURFACES: [u32; 2] = [CANVAS, PALETTE];

/// Frames of a surface and what they make.
#[derive(Debug, Default)]
struct Pulled {
    inbox: FrameInbox,
    view: SurfaceView,
}

/// What draws.
#[derive(Debug)]
struct Painter {
    gpu: Gpu,
    passes: Passes,
    backdrop: Backdrop,
    brushes: Brushes,
}

/// The painter's view.
pub struct App {
    bus: Arc<dyn Bus>,
    stop: Stop,
    wake: Wake,
    frame_topic: String,
    scenes: Receiver<Scene>,
    scene: Option<(Scene, Desk)>,
    /// What the view holds: the surfaces as they lay when they were first seen, so that one sees them move.
    framed: Vec<Surface>,
    surfaces: [Pulled; SURFACES.len()],
    follower: Follower,
    progress: WorkProgress,
    mouse: Mouse,
    view: Option<View>,
    pressed: bool,
    painter: Option<Painter>,
    threads: Vec<JoinHandle<()>>,
    member: Option<Member>,
}

impl App {
    /// The view of a rig.
    ///
    /// # Errors
    /// A [`Fault`] where the bus is closed.
    pub fn new(member: &Member, mouse: &str) -> Result<Self, Fault> {
        let (bus, topics, brushes) = (&member.bus, &member.topics, &member.config.brush);
        let brush = brushes.first().map_or("main", |brush| brush.name.as_str());
        let depth_shares = brushes
            .iter()
            .map(|brush| (brush.name.clone(), brush.depth_share));
        let me = member.origin(mouse);
        Ok(Self {
            mouse: Mouse::new(&**bus, topics, mouse, brush, me)?,
            follower: Follower::new(
                &**bus,
                topics,
                &member.wake,
                depth_shares.collect(),
                me.source,
            )?,
            progress: WorkProgress::new(&**bus, topics, &member.wake)?,
            scenes: Receiver::new(
                &**bus,
                &topics.scene(),
                Class::Cached,
                Queue::Ring(16),
                &member.wake,
            )?,
            bus: Arc::clone(bus),
            stop: member.stop.clone(),
            wake: member.wake.clone(),
            frame_topic: topics.frame(),
            scene: None,
            framed: Vec::new(),
            surfaces: Default::default(),
            view: None,
            pressed: false,
            painter: None,
            threads: Vec::new(),
            member: None,
        })
    }

    /// Keeps the membership for as long as the window lives.
    #[must_use]
    pub fn with_member(mut self, member: Member) -> Self {
        self.member = Some(member);
        self
    }

    /// Starts to pull frames and to draw them, for a window on the display of `export`.
    pub fn begin(&mut self, context: &Context, state: &RenderState, export: &Export) {
        let gpu = Gpu {
            device: state.device.clone(),
            queue: state.queue.clone(),
            target: state.target_format,
        };
        self.painter = Some(Painter {
            passes: Passes::new(&gpu, export),
            backdrop: Backdrop::new(&gpu),
            brushes: Brushes::new(&gpu, export),
            gpu,
        });
        let me = Origin {
            source: name_hash("ui"),
            epoch: random_epoch(),
        };
        for (pulled, surface) in self.surfaces.iter().zip(SURFACES) {
            let source = FrameSource {
                bus: Arc::clone(&self.bus),
                topic: self.frame_topic.clone(),
                me,
                surface,
            };
            let inbox = pulled.inbox.clone();
            let (wake, stop) = (self.wake.clone(), self.stop.clone());
            let run = move || pull(&source, &inbox, &wake, &stop);
            self.threads.extend(thread("frames", run));
        }
        let (wake, context, stop) = (self.wake.clone(), context.clone(), self.stop.clone());
        let rest = match state.adapter.get_info().device_type {
            wgpu::DeviceType::Cpu => REPAINT_BY_PROCESSOR,
            _ => REPAINT,
        };
        let run = move || repaint(&wake, &context, &stop, rest);
        self.threads.extend(thread("repaint", run));
    }

    fn take_in(&mut self, now_ns: u64) {
        while let Some(scene) = self.scenes.try_recv() {
            let desk = Desk::of(&scene.message);
            let surfaces = &scene.message.surfaces;
            if !are_alike(&self.framed, surfaces) {
                self.framed = at_rest(surfaces);
            }
            self.scene = Some((scene.message, desk));
        }
        self.follower.take_in(now_ns);
        self.progress.take_in();
        let (Some(painter), Some((scene, _))) = (&self.painter, &self.scene) else {
            return;
        };
        for (pulled, id) in self.surfaces.iter_mut().zip(SURFACES) {
            for shown in pulled.inbox.take() {
                pulled.view.update(&painter.gpu, &painter.passes, &shown);
            }
            if let Some(surface) = find(scene, id) {
                let lamp = lamp_over(scene, id);
                let (gpu, passes) = (&painter.gpu, &painter.passes);
                pulled.view.light(gpu, passes, &lamp, surface.cell_m);
            }
        }
    }

    /// Where the pointer went since the last frame, on the desk.
    fn pointer(&mut self, context: &Context) -> Vec<Pointer> {
        let (Some((scene, _)), Some(view)) = (&self.scene, &self.view) else {
            return Vec::new();
        };
        let mut pressed = self.pressed;
        let place = |at: egui::Pos2, pressed: bool| {
            let counts = view.area.contains(at) || pressed;
            counts.then(|| Pointer {
                at: view.to_desk(at, &scene.surfaces).to_array(),
                pressed,
            })
        };
        let places = context.input(|input| {
            let mut places = Vec::new();
            for event in &input.events {
                match event {
                    Event::PointerMoved(at) => places.extend(place(*at, pressed)),
                    Event::PointerButton {
                        pos,
                        button: PointerButton::Primary,
                        pressed: p,
                        ..
                    } => {
                        pressed = *p && view.area.contains(*pos);
                        places.extend(place(*pos, pressed));
                    }
                    _ => {}
                }
            }
            // A still pointer is still there.
            if places.is_empty() {
                places.extend(input.pointer.latest_pos().and_then(|at| place(at, pressed)));
            }
            places
        });
        self.pressed = pressed;
        places
    }

    /// The desk from the bottom: surfaces, brushes.
    fn shapes(&mut self, view: &View, pixels_per_point: f32) -> Vec<Shape> {
        let (Some(painter), Some((scene, desk))) = (&mut self.painter, &self.scene) else {
            return Vec::new();
        };
        let mut laid = Vec::new();
        for (pulled, id) in self.surfaces.iter_mut().zip(SURFACES) {
            let Some(surface) = find(scene, id) else {
                continue;
            };
            let [across, _] = Place::pixels(surface, view, pixels_per_point);
            pulled.inbox.want_level(level(surface.cells[0], across));
            let gpu = &painter.gpu;
            laid.extend(pulled.view.lay(gpu, surface, view, pixels_per_point));
        }
        let size = view.pixels(pixels_per_point);
        let (gpu, passes) = (&painter.gpu, &painter.passes);
        painter.backdrop.update(gpu, passes, size, &laid);
        let mut shapes: Vec<Shape> = painter.backdrop.shape(view).into_iter().collect();
        for held in self.follower.held(desk) {
            if let Some(head) = self.follower.head(held.name) {
                let lamp = lamp_over(scene, held.plane.id);
                let brushes = &mut painter.brushes;
                shapes.extend(brushes.shapes(
                    &painter.gpu,
                    &held,
                    head,
                    &lamp,
                    view,
                    pixels_per_point,
                ));
            }
        }
        shapes
    }
}

/// Draws the window anew when something has come, but not too often: whatever comes, nothing is drawn
/// for `rest` after a request.
fn repaint(wake: &Wake, context: &Context, stop: &Stop, rest: Duration) {
    while !stop.requested() {
        if wake.wait(Duration::from_millis(200)) {
            context.request_repaint();
            std::thread::sleep(rest);
        }
    }
    context.request_repaint();
}

fn thread(name: &str, run: impl FnOnce() + Send + 'static) -> Option<JoinHandle<()>> {
    let thread = std::thread::Builder::new().name(name.into()).spawn(run);
    thread
        .inspect_err(|error| tracing::error!("the thread '{name}' cannot be started: {error}"))
        .ok()
}

fn find(scene: &Scene, id: u32) -> Option<&Surface> {
    scene.surfaces.iter().find(|surface| surface.id == id)
}

impl eframe::App for App {
    fn logic(&mut self, context: &Context, _frame: &mut eframe::Frame) {
        if self.stop.requested() {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        let places = self.pointer(context);
        let now_ns = self.bus.now_ns();
        if let Err(error) = self.mouse.send(now_ns, &places) {
            tracing::warn!("the mouse: {error}");
        }
        // After the mouse has told where it is: its brush is drawn there.
        self.take_in(now_ns);
        if self.pressed {
            context.request_repaint_after(STILL);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.progress.show(ui.ctx());
        CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
            let area = ui.max_rect();
            self.view = View::fit(area, &self.framed);
            match self.view {
                Some(view) => {
                    ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
                    let pixels_per_point = ui.ctx().pixels_per_point();
                    let shapes = self.shapes(&view, pixels_per_point);
                    ui.painter().extend(shapes);
                    // Nothing tells when a device falls silent.
                    let silence = Duration::from_nanos(SILENCE_NS);
                    ui.ctx().request_repaint_after(silence);
                }
                None => {
                    ui.centered_and_justified(|ui| ui.label("waiting for the paint …"));
                }
            }
        });
    }

    fn clear_color(&self, _visuals: &Visuals) -> [f32; 4] {
        DESK_COLOUR.to_normalized_gamma_f32()
    }

    fn on_exit(&mut self) {
        self.stop.request();
        self.wake.ring();
        for thread in self.threads.drain(..) {
            thread.join().ok();
        }
        if let Some(member) = self.member.take() {
            member.leave();
        }
    }
}

impl std::fmt::Debug for App {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("App")
            .field("view", &self.view)
            .field("follower", &self.follower)
            .finish_non_exhaustive()
    }
}
