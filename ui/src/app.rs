//! The window.

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use eframe::egui::{self, CentralPanel, Color32, Context, Event, Frame, PointerButton, Rect, pos2};
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Class, Queue};
use maulstick_rig::{Fault, Member, Stop};
use maulstick_types::scene::{CANVAS, Scene, Surface};

use crate::canvas::{Canvas, DESK_COLOUR, fit, level, to_desk};
use crate::frames::{FrameInbox, pull};
use crate::mouse::{Mouse, Pointer};

/// A pressed pointer that stands still is told this often: a longer silence would lift the brush.
const STILL: Duration = Duration::from_millis(30);

/// The painter's view.
pub struct App {
    bus: Arc<dyn Bus>,
    stop: Stop,
    frame_topic: String,
    inbox: FrameInbox,
    scene: Receiver<Scene>,
    surface: Option<Surface>,
    canvas: Canvas,
    mouse: Mouse,
    rect: Rect,
    pressed: bool,
    puller: Option<JoinHandle<()>>,
    member: Option<Member>,
}

impl App {
    /// The view of a rig.
    ///
    /// # Errors
    /// A [`Fault`] where the bus is closed.
    pub fn new(member: &Member, mouse: &str) -> Result<Self, Fault> {
        let (bus, topics) = (&member.bus, &member.topics);
        let brush = member
            .config
            .brush
            .first()
            .map_or("main", |brush| brush.name.as_str());
        Ok(Self {
            mouse: Mouse::new(&**bus, topics, mouse, brush, member.origin(mouse))?,
            scene: Receiver::new(
                &**bus,
                &topics.scene(),
                Class::Cached,
                Queue::Ring(16),
                &member.wake,
            )?,
            bus: Arc::clone(bus),
            stop: member.stop.clone(),
            frame_topic: topics.frame(),
            inbox: FrameInbox::default(),
            surface: None,
            canvas: Canvas::default(),
            rect: Rect::ZERO,
            pressed: false,
            puller: None,
            member: None,
        })
    }

    /// Keeps the membership for as long as the window lives.
    #[must_use]
    pub fn with_member(mut self, member: Member) -> Self {
        self.member = Some(member);
        self
    }

    /// Starts to pull frames for a window.
    pub fn begin(&mut self, context: &Context) {
        let (bus, topic, inbox) = (
            Arc::clone(&self.bus),
            self.frame_topic.clone(),
            self.inbox.clone(),
        );
        let (context, stop) = (context.clone(), self.stop.clone());
        let me = maulstick_types::Origin {
            source: maulstick_types::name_hash("ui"),
            epoch: maulstick_bus::typed::random_epoch(),
        };
        let thread = std::thread::Builder::new()
            .name("frames".into())
            .spawn(move || pull(&*bus, &topic, me, &inbox, &context, &stop));
        match thread {
            Ok(thread) => self.puller = Some(thread),
            Err(error) => tracing::error!("frames cannot be pulled: {error}"),
        }
    }

    fn take_in(&mut self, context: &Context) {
        while let Some(scene) = self.scene.try_recv() {
            let mut surfaces = scene.message.surfaces.into_iter();
            self.surface = surfaces.find(|surface| surface.id == CANVAS);
        }
        for shown in self.inbox.take() {
            self.canvas.update(context, &shown);
        }
    }

    /// Where the pointer went since the last frame, on the desk.
    fn pointer(&mut self, context: &Context) -> Vec<Pointer> {
        let Some(surface) = &self.surface else {
            return Vec::new();
        };
        let rect = self.rect;
        let mut pressed = self.pressed;
        let place = |at: egui::Pos2, pressed: bool| {
            let counts = rect.contains(at) || pressed;
            counts.then(|| Pointer {
                at: to_desk(at, rect, surface).to_array(),
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
                        pressed = *p && rect.contains(*pos);
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
}

impl eframe::App for App {
    fn logic(&mut self, context: &Context, _frame: &mut eframe::Frame) {
        if self.stop.requested() {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        self.take_in(context);
        let places = self.pointer(context);
        if let Err(error) = self.mouse.send(self.bus.now_ns(), &places) {
            tracing::warn!("the mouse: {error}");
        }
        if self.pressed {
            context.request_repaint_after(STILL);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        CentralPanel::default()
            .frame(Frame::new().fill(DESK_COLOUR))
            .show(ui, |ui| {
                let area = ui.max_rect();
                let cells = self
                    .surface
                    .as_ref()
                    .map_or([1, 1], |surface| surface.cells);
                self.rect = fit(area, cells);
                self.inbox
                    .want_level(level(cells, self.rect, ui.ctx().pixels_per_point()));
                match self.canvas.texture() {
                    Some(texture) => {
                        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                        ui.painter()
                            .image(texture.id(), self.rect, whole, Color32::WHITE);
                    }
                    None => {
                        ui.centered_and_justified(|ui| ui.label("waiting for the paint …"));
                    }
                }
            });
    }

    fn on_exit(&mut self) {
        self.stop.request();
        if let Some(puller) = self.puller.take() {
            puller.join().ok();
        }
        if let Some(member) = self.member.take() {
            member.leave();
        }
    }
}

impl std::fmt::Debug for App {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("App")
            .field("canvas", &self.canvas)
            .finish_non_exhaustive()
    }
}
