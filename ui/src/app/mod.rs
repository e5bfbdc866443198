//! The window.
//!
//! | module | holds |
//! | --- | --- |
//! | `actions` | actions of the painter: keys, clicks and gestures |
//! | `bar` | menu, undo, redo and help in a corner |
//! | `sides`, `column` | what stands at the sides of the window; the column of panels |
//! | `overlay` | what lies over the desk: panels, dialogs, help |
//! | [`rack`] | the brush rack at the edge |
//! | `sending`, `held_places` | requests, in their order among the strokes; placements that wait for a brush to lift |
//! | `first_run` | the line of help for a new painter |
//! | `help_pages` | a first painting in steps; what program this is |
//! | `window_memory` | title and size of the window, and the painter's habits |

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use eframe::egui::{self, CentralPanel, Context, CursorIcon, Frame, Visuals};
use eframe::egui_wgpu::RenderState;
use maulstick_appearance::picture::Export;
use maulstick_brush::palette_place::Side;
use maulstick_bus::typed::random_epoch;
use maulstick_bus::{Bus, Wake};
use maulstick_optics::PaintLibrary;
use maulstick_rig::{NodeHandle, Sketches, Stop, UserError};
use maulstick_types::scene::{PALETTE, Surface};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};
use maulstick_ui_kit::display_transform::DisplayTransform;
use maulstick_ui_kit::language;
use maulstick_ui_kit::notifications::Notifications;

use crate::app::held_places::HeldPlaces;
use crate::app::overlay::Overlay;
use crate::input::brush_turn::BrushTurn;
use crate::input::clean_key::CleanKey;
use crate::input::mouse_stylus::Mouse;
use crate::input::navigation::Navigation;
use crate::input::palette_gesture::PaletteGesture;
use crate::input::pen::WindowPen;
use crate::input::pointer_path::PointerPath;
use crate::input::presses;
use crate::render::device_loss::DeviceLoss;
use crate::render::frame_reports::Presenter;
use crate::render::scene::{SceneRenderer, Seen, Source};
use crate::rig::brushes::{BrushTracker, SILENCE_NS};
use crate::rig::device_commands::DeviceCommands;
use crate::rig::health::HealthMonitor;
use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::sessions::SessionProcesses;
use crate::settings::look::Look;
use crate::settings::preferences::Preferences;
use crate::tracing::TracingPicture;
use crate::view::camera::{DESK_COLOUR, View};
use crate::view::held_view::{self, HeldView};
use crate::view::palette_slide::PaletteSlide;
use crate::widgets::context::PanelContext;
use crate::widgets::progress::Progress;
use maulstick_client::dispatcher::CommandDispatcher;
use maulstick_client::listener::RigListener;
use maulstick_client::pending_orders::PendingSender;
use maulstick_client::stroke_barrier::StrokeBarrier;
use maulstick_client::thumbnails::ThumbnailFetcher;

mod actions;
pub(crate) mod bar;
mod column;
mod first_run;
mod held_places;
mod help_pages;
pub(crate) mod overlay;
pub mod rack;
mod sending;
pub(crate) mod sides;
#[cfg(test)]
mod tests;
mod window_memory;

/// Interval at which a pressed pointer that stands still is sent: a longer silence would lift the brush.
const STILL: Duration = Duration::from_millis(30);

/// Interval at which statuses are looked at while they show work.
const STATUS_LOOK: Duration = Duration::from_millis(100);
/// Time after which a silent device is away.
const SILENCE: Duration = Duration::from_nanos(SILENCE_NS);
/// Interval at which an idle window is drawn.
const IDLE_LOOK: Duration = Duration::from_secs(60);

/// The painter's view.
pub struct App {
    bus: Arc<dyn Bus>,
    stop: Stop,
    wake: Wake,
    topics: Topics,
    listener: RigListener,
    rig: RigState,
    scene_renderer: SceneRenderer,
    presenter: Option<Presenter>,
    lost: DeviceLoss,
    tracker: BrushTracker,
    progress: Progress,
    watch: HealthMonitor,
    mouse: Mouse,
    pen: WindowPen,
    brush_turn: BrushTurn,
    view: Option<View>,
    held_view: HeldView,
    held_places: HeldPlaces,
    pointer_path: PointerPath,
    navigation: Navigation,
    palette_slide: PaletteSlide,
    clean_key: CleanKey,
    palette_gesture: PaletteGesture,
    /// The side of the palette as it was last looked at, and the start of the paint node then.
    side: Option<(Side, u64)>,
    overlay: Overlay,
    tracing: TracingPicture,
    requests: Requests,
    barrier: StrokeBarrier,
    pending: PendingSender,
    dispatcher: CommandDispatcher,
    device_commands: DeviceCommands,
    session_processes: SessionProcesses,
    fetcher: ThumbnailFetcher,
    notifications: Notifications,
    preferences: Preferences,
    look: Look,
    /// The title of the window.
    title: String,
    /// Preferences as they were last saved, and their file.
    kept: (Preferences, Option<PathBuf>),
    member: Option<NodeHandle>,
}

impl App {
    /// The view of a rig whose paints are those of `library`.
    ///
    /// # Errors
    /// A [`UserError`] where the bus is closed.
    pub fn new(
        member: &NodeHandle,
        [mouse, pen]: [&str; 2],
        library: PaintLibrary,
    ) -> Result<Self, UserError> {
        let (bus, topics, brushes) = (&member.bus, &member.topics, &member.config.brush);
        let names: Vec<String> = brushes.iter().map(|brush| brush.name.clone()).collect();
        let brush = names.first().map_or("main", String::as_str);
        let depth_shares = brushes
            .iter()
            .map(|brush| (brush.name.clone(), brush.depth_share));
        let (me, pen_origin) = (member.origin(mouse), member.origin(pen));
        let mut notifications = Notifications::default();
        let place = Preferences::place();
        let read = place
            .as_deref()
            .map_or_else(|| Ok(Preferences::default()), Preferences::read);
        let preferences = read.unwrap_or_else(|fault| {
            notifications.of(&fault);
            Preferences::default()
        });
        language::choose(preferences.language.as_deref());
        if let Some(what) = preferences.keys.fault() {
            notifications.fault(
                what,
                tr!("All else is as you left it; Settings has the keys."),
            );
        }
        let lost = DeviceLoss::new(&member.folder);
        if let Some(why) = lost.word() {
            notifications.fault(
                tr!("The graphics device was lost: {why}", why),
                tr!("The window was opened again, and nothing is missing."),
            );
        }
        Ok(Self {
            mouse: Mouse::new(&**bus, topics, (mouse, pen_origin.source), brush, me)?,
            pen: WindowPen::new(bus, topics, pen, pen_origin)?,
            tracker: BrushTracker::new(
                &**bus,
                topics,
                &member.wake,
                depth_shares.collect(),
                me.source,
            )?,
            progress: Progress::default(),
            watch: HealthMonitor::default(),
            listener: RigListener::new(&**bus, topics, &member.wake)?,
            rig: RigState {
                sketches: Sketches::of_user().ok(),
                ..RigState::new(&member.config.rig.name, &names, Arc::new(library))
            },
            dispatcher: CommandDispatcher::new(Arc::clone(bus), topics, &member.wake),
            device_commands: DeviceCommands::own(),
            session_processes: SessionProcesses::own(),
            fetcher: ThumbnailFetcher::of_rig(member),
            bus: Arc::clone(bus),
            stop: member.stop.clone(),
            wake: member.wake.clone(),
            topics: topics.clone(),
            brush_turn: BrushTurn::default(),
            navigation: Navigation::default(),
            palette_slide: PaletteSlide::default(),
            clean_key: CleanKey::default(),
            palette_gesture: PaletteGesture::default(),
            side: None,
            scene_renderer: SceneRenderer::default(),
            presenter: None,
            lost,
            view: None,
            held_view: HeldView::default(),
            held_places: HeldPlaces::default(),
            pointer_path: PointerPath::default(),
            overlay: Overlay::default(),
            tracing: TracingPicture::default(),
            requests: Requests::default(),
            barrier: StrokeBarrier::new(&**bus, topics)?,
            pending: PendingSender::new(&**bus, topics)?,
            notifications,
            title: String::new(),
            look: Look::default(),
            kept: (preferences.clone(), place),
            preferences,
            member: None,
        })
    }

    /// Keeps the membership for as long as the window lives.
    #[must_use]
    pub fn with_member(mut self, member: NodeHandle) -> Self {
        self.member = Some(member);
        self
    }

    /// Width and height that the window had, points.
    #[must_use]
    pub fn size(&self) -> [f32; 2] {
        self.preferences.size
    }

    /// Monitor of the graphics device.
    #[must_use]
    pub fn lost(&self) -> DeviceLoss {
        self.lost.clone()
    }

    /// Starts to pull frames and to draw them, for a window on the display of `export`.
    pub fn begin(&mut self, context: &Context, state: &RenderState, export: &Export) {
        let me = Origin {
            source: name_hash("ui"),
            epoch: random_epoch(),
        };
        let presenter = Presenter::new(Arc::clone(&self.bus), &self.topics, me, &state.device);
        self.presenter = presenter
            .inspect_err(|error| tracing::warn!("frames are not told of: {error}"))
            .ok();
        let completion = self.presenter.as_ref().map(Presenter::completion);
        let source = Source {
            bus: Arc::clone(&self.bus),
            topic: self.topics.frame(),
            wake: self.wake.clone(),
            stop: self.stop.clone(),
            completion: completion.unwrap_or_default(),
        };
        self.rig.tint = Arc::new(DisplayTransform::new(export));
        self.scene_renderer.begin(context, state, export, source);
        self.lost.follow(&state.device, context);
    }

    /// Starts to read the pens over the window.
    pub fn follow_pens(&mut self, window: &eframe::CreationContext<'_>) {
        self.pen.begin(window);
    }

    fn take_in(&mut self, now_ns: u64) {
        self.rig.drain(&mut self.listener, now_ns);
        self.tracker.take_in(now_ns);
        for brush in &mut self.rig.brushes {
            brush.carried = self.tracker.carried(&brush.name).cloned();
        }
        let (rig, notifications) = (&mut self.rig, &mut self.notifications);
        self.watch.look(rig, &self.topics, notifications);
        self.scene_renderer.take_in(&mut self.rig);
        self.fetcher.exchange(&mut self.rig.live.thumbnails, now_ns);
        for outcome in self.dispatcher.outcomes() {
            self.overlay.on_reply(
                &outcome,
                &mut PanelContext {
                    rig: &mut self.rig,
                    requests: &mut self.requests,
                    preferences: &mut self.preferences,
                    notifications: &mut self.notifications,
                },
            );
        }
    }

    /// True while the panel of the devices is open.
    fn shows_devices(&self) -> bool {
        self.preferences.panels && self.preferences.is_open("Device")
    }

    /// Time until statuses, and devices that fall silent, are looked at again: nothing signals them.
    fn next_look(&self) -> Duration {
        let status = self.rig.live.paint.as_ref().map(|node| &node.status);
        let works = status.is_some_and(|status| {
            status.baked < status.baking
                || status.drying.is_some()
                || status.export.is_some()
                || status.lag_ns > 0
                // What is in memory alone is never saved.
                || !status.path.is_empty() && !status.all_committed
        });
        match works || self.shows_devices() || !self.dispatcher.waits().is_empty() {
            true => STATUS_LOOK,
            false if self.preferences.panels || self.tracker.hears_another() => SILENCE,
            false => IDLE_LOOK,
        }
    }
}

impl eframe::App for App {
    fn raw_input_hook(&mut self, context: &Context, input: &mut egui::RawInput) {
        self.pen.take_in(context, input);
    }

    fn logic(&mut self, context: &Context, _frame: &mut eframe::Frame) {
        let ends = self.stop.requested() || self.lost.is_lost();
        if ends {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        let is_asked = context.input(|input| input.viewport().close_requested());
        if is_asked && !ends && !self.overlay.may_close(&self.rig) {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            context.request_repaint();
        }
        presses::return_keyboard(context);
        let places = self.pointer(context);
        let now_ns = self.bus.now_ns();
        let brush = self.rig.brush_name();
        let taken = self.mouse.take(now_ns, brush);
        let grip = self.preferences.mouse;
        let pixels_per_point = f64::from(context.pixels_per_point());
        let pixel_m = |view: &View| 1.0 / (view.scale * pixels_per_point);
        let pixel_m = self.view.as_ref().map_or(0.0, pixel_m);
        let places = self.brush_turn.turned(now_ns, &places, &grip, pixel_m);
        if let Err(error) = taken.and_then(|()| self.mouse.send(now_ns, &places, grip.pressure)) {
            tracing::warn!("the mouse: {error}");
        }
        self.pen
            .greet(&mut self.preferences, &mut self.notifications);
        self.rig.pen_pressure = self.pen.pressure();
        // After the mouse has sent its position: its brush is drawn there.
        self.take_in(now_ns);
        self.barrier.drain(now_ns);
        self.rig.contact = self.contact();
        self.send(context);
        self.follow(context, now_ns);
        if self.pointer_path.is_pressed() || self.brush_turn.is_waiting() {
            context.request_repaint_after(STILL);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.look.follow(ui.ctx(), &mut self.preferences);
        self.preferences.is_narrow = ui.max_rect().width() < sides::NARROW;
        CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
            let side = match self.preferences.rack_is_left() {
                false => Side::Left,
                true => Side::Right,
            };
            let (canvas, palette) = (self.rig.live.canvas(), self.rig.live.palette());
            let [left, right] = self.overlay.taken(&self.preferences);
            // Beside the palette the desk itself is narrower.
            let mut area = ui.max_rect();
            let taken = match side {
                Side::Left => {
                    area.min.x += left;
                    right
                }
                Side::Right => {
                    area.max.x -= right;
                    left
                }
            };
            let mut wanted = canvas.and_then(|canvas| View::of(area, canvas, palette, side, taken));
            if self.preferences.mirrored {
                wanted = wanted.map(View::mirrored);
            }
            let pixels_per_point = ui.ctx().pixels_per_point();
            let corner = ui.input(|input| input.viewport().inner_rect.map(|rect| rect.min));
            let frame = held_view::Frame {
                pixels_per_point,
                corner_px: corner.unwrap_or_default() * pixels_per_point,
            };
            let is_held = self.holds_desk();
            self.view = self.held_view.follow(wanted, frame, is_held);
            let surfaces = self
                .rig
                .live
                .scene
                .as_ref()
                .map(|scene| &scene.surfaces[..]);
            let shown = self.view.as_ref().zip(surfaces);
            let brush = self.rig.brush_name();
            self.pen.set_pointing(self.overlay.motions.is_placing());
            self.pen.show(ui.ctx(), shown, brush, &self.preferences);
            self.pen.draw(ui.ctx());
            let Some(view) = self.view else {
                ui.centered_and_justified(|ui| ui.label(tr!("waiting for the paint …")));
                return;
            };
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
            let surfaces = self.rig.live.scene.iter().flat_map(|scene| &scene.surfaces);
            let mut surfaces: Vec<Surface> = surfaces.cloned().collect();
            let now_s = ui.input(|input| input.time);
            if self.palette_slide.show(now_s, &mut surfaces) {
                ui.ctx().request_repaint();
            }
            let work = &mut PanelContext {
                rig: &mut self.rig,
                requests: &mut self.requests,
                preferences: &mut self.preferences,
                notifications: &mut self.notifications,
            };
            let seen = Seen {
                view: &view,
                pixels_per_point,
                tracing: self.tracing.follow(ui.ctx(), work),
            };
            let shapes = self
                .scene_renderer
                .shapes(&self.rig, &surfaces, &self.tracker, &seen);
            ui.painter().extend(shapes);
            self.name_wells(ui.painter(), &view, &surfaces);
            self.show_fit(ui.painter(), &view);
            self.overlay.motions.place(
                ui.ctx(),
                ui.painter(),
                (&view, &surfaces),
                &mut PanelContext {
                    rig: &mut self.rig,
                    requests: &mut self.requests,
                    preferences: &mut self.preferences,
                    notifications: &mut self.notifications,
                },
            );
            let palette = surfaces.iter().find(|surface| surface.id == PALETTE);
            self.overlay.palette = palette.map(|palette| view.covered(palette));
            self.draw_force(ui.painter(), &view);
            if let Some(presenter) = &mut self.presenter {
                let (begun_ns, holding) = (self.rig.live.now_ns, self.scene_renderer.holding());
                ui.painter()
                    .add(presenter.shape(view.area, begun_ns, holding));
            }
            ui.ctx().request_repaint_after(self.next_look());
        });
        let waits = self.dispatcher.waits();
        let work = &mut PanelContext {
            rig: &mut self.rig,
            requests: &mut self.requests,
            preferences: &mut self.preferences,
            notifications: &mut self.notifications,
        };
        if self.progress.show(ui.ctx(), work, &waits) {
            self.dispatcher.give_up();
        }
        let acts = self.overlay.show(
            ui,
            &mut PanelContext {
                rig: &mut self.rig,
                requests: &mut self.requests,
                preferences: &mut self.preferences,
                notifications: &mut self.notifications,
            },
        );
        for act in acts {
            self.act(act, ui.ctx());
        }
        if self.overlay.closes() {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
        self.change_hands();
        self.remember_size(ui.ctx());
        self.name_window(ui.ctx());
        self.send(ui.ctx());
        self.keep();
    }

    fn clear_color(&self, _visuals: &Visuals) -> [f32; 4] {
        DESK_COLOUR.to_normalized_gamma_f32()
    }

    fn on_exit(&mut self) {
        self.pen.end();
        self.stop.request();
        self.wake.ring();
        self.scene_renderer.end();
        if let Some(member) = self.member.take() {
            member.leave();
        }
    }
}
