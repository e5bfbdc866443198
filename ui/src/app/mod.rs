//! The window.
//!
//! | module | holds |
//! | --- | --- |
//! | `actions` | actions of the painter: keys, clicks and gestures |
//! | `studio` | the window's state of the rig, and the painter's requests |
//! | `connection`, `sending` | messages of the rig; requests, in their order among the strokes |
//! | `hands` | mouse, pen and gestures |
//! | `desk_view` | the displayed desk |
//! | `sides` | tools at the sides of the window |
//! | `overlay` | overlay of the desk: panels, dialogs, help |
//! | [`rack`] | the brush rack at the edge |
//! | `held_places` | placements that wait for a brush to lift |
//! | `window_memory` | title and size of the window, and the painter's habits |

use std::sync::Arc;
use std::time::Duration;

use eframe::egui::{self, CentralPanel, Context, CursorIcon, Frame, Ui, Visuals};
use eframe::egui_wgpu::RenderState;
use maulstick_appearance::picture::Export;
use maulstick_optics::PaintLibrary;
use maulstick_rig::{NodeHandle, Sketches, UserError};
use maulstick_types::scene::PALETTE;
use maulstick_ui_kit::notifications::Notifications;

use crate::app::connection::Connection;
use crate::app::desk_view::DeskView;
use crate::app::hands::Hands;
use crate::app::overlay::Overlay;
use crate::app::sending::Sending;
use crate::app::studio::Studio;
use crate::app::window_memory::WindowMemory;
use crate::input::presses;
use crate::render::device_loss::DeviceLoss;
use crate::rig::brushes::SILENCE_NS;
use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::settings::look::Look;
use crate::view::camera::DESK_COLOUR;
use crate::widgets::progress::Progress;

mod actions;
mod connection;
mod desk_view;
mod hands;
mod held_places;
pub(crate) mod overlay;
pub mod rack;
mod sending;
pub(crate) mod sides;
mod studio;
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
    connection: Connection,
    studio: Studio,
    hands: Hands,
    sending: Sending,
    desk: DeskView,
    overlay: Overlay,
    progress: Progress,
    lost: DeviceLoss,
    look: Look,
    memory: WindowMemory,
}

impl App {
    /// The view of a rig whose paints are those of `library`; `pointers` are the names of mouse and pen as devices.
    ///
    /// # Errors
    /// A [`UserError`] where the bus is closed.
    pub fn new(
        member: &NodeHandle,
        pointers: [&str; 2],
        library: PaintLibrary,
    ) -> Result<Self, UserError> {
        let mut notifications = Notifications::default();
        let memory = WindowMemory::read(&mut notifications);
        let lost = DeviceLoss::new(&member.folder);
        if let Some(why) = lost.word() {
            notifications.fault(
                tr!("The graphics device was lost: {why}", why),
                tr!("The window was opened again, and nothing is missing."),
            );
        }
        let brushes = member.config.brush.iter();
        let names: Vec<String> = brushes.map(|brush| brush.name.clone()).collect();
        Ok(Self {
            connection: Connection::new(member, member.origin(pointers[0]).source)?,
            studio: Studio {
                rig: RigState {
                    sketches: Sketches::of_user().ok(),
                    ..RigState::new(&member.config.rig.name, &names, Arc::new(library))
                },
                requests: Requests::default(),
                preferences: memory.preferences(),
                notifications,
            },
            hands: Hands::new(member, pointers)?,
            sending: Sending::new(member)?,
            desk: DeskView::default(),
            overlay: Overlay::default(),
            progress: Progress::default(),
            lost,
            look: Look::default(),
            memory,
        })
    }

    /// Keeps the membership for as long as the window lives.
    #[must_use]
    pub fn with_member(mut self, member: NodeHandle) -> Self {
        self.connection.member = Some(member);
        self
    }

    /// Width and height that the window had, points.
    #[must_use]
    pub fn size(&self) -> [f32; 2] {
        self.studio.preferences.window.size
    }

    /// Monitor of the graphics device.
    #[must_use]
    pub fn lost(&self) -> DeviceLoss {
        self.lost.clone()
    }

    /// Starts to pull frames and to draw them, for a window on the display of `export`.
    pub fn begin(&mut self, context: &Context, state: &RenderState, export: &Export) {
        let shown = (&self.connection, &mut self.studio.rig);
        self.desk.begin(context, state, export, shown);
        self.lost.follow(&state.device, context);
    }

    /// Starts to read the pens over the window.
    pub fn follow_pens(&mut self, window: &eframe::CreationContext<'_>) {
        self.hands.pen.begin(window);
    }

    fn drain(&mut self, now_ns: u64) {
        self.connection.drain(now_ns, &mut self.studio);
        self.desk.scene_renderer.take_in(&mut self.studio.rig);
        for outcome in self.sending.dispatcher.outcomes() {
            self.overlay.on_reply(&outcome, &mut self.studio.context());
        }
        self.sending.drain(now_ns);
    }

    fn send(&mut self, context: &Context) {
        let (studio, hands) = (&mut self.studio, &mut self.hands);
        self.sending.send(context, studio, hands, &self.connection);
    }

    /// Time until statuses, and silent devices, are checked again, which nothing signals.
    fn next_look(&self) -> Duration {
        let status = self.studio.rig.live.paint.as_ref().map(|node| &node.status);
        let works = status.is_some_and(|status| {
            status.baked < status.baking
                || status.drying.is_some()
                || status.export.is_some()
                || status.lag_ns > 0
                // A painting in memory alone is never saved.
                || !status.path.is_empty() && !status.all_committed
        });
        let waits = !self.sending.dispatcher.waits().is_empty();
        if works || waits || self.studio.shows_devices() {
            STATUS_LOOK
        } else if self.studio.preferences.window.panels || self.connection.tracker.hears_another() {
            SILENCE
        } else {
            IDLE_LOOK
        }
    }

    /// Shows the desk: surfaces, brushes, and marks on it.
    fn show_desk(&mut self, ui: &mut Ui) {
        let is_held = self.hands.holds_desk(&self.connection.tracker);
        let taken = self.overlay.taken(&self.studio.preferences);
        self.desk.place(ui, &self.studio, taken, is_held);
        let rig = &self.studio.rig;
        let scene = rig.live.scene.as_ref();
        let surfaces = scene.map(|scene| &scene.surfaces[..]);
        let shown = self.desk.view.as_ref().zip(surfaces);
        let pen = &mut self.hands.pen;
        pen.set_pointing(self.overlay.motions.is_placing());
        pen.show(ui.ctx(), shown, rig.brush_name(), &self.studio.preferences);
        pen.draw(ui.ctx());
        let Some(view) = self.desk.view else {
            ui.centered_and_justified(|ui| ui.label(tr!("waiting for the paint …")));
            return;
        };
        ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        let surfaces = self.desk.surfaces(ui, rig);
        let shown = (&view, &surfaces[..]);
        self.desk
            .draw(ui, shown, (&self.connection, &mut self.studio));
        self.name_wells(ui.painter(), &view, &surfaces);
        self.show_fit(ui.painter(), &view);
        let work = &mut self.studio.context();
        self.overlay
            .motions
            .place(ui.ctx(), ui.painter(), shown, work);
        let palette = surfaces.iter().find(|surface| surface.id == PALETTE);
        self.overlay.palette = palette.map(|palette| view.covered(palette));
        self.draw_force(ui.painter(), &view);
        let begun_ns = self.studio.rig.live.now_ns;
        self.desk.report(ui.painter(), &view, begun_ns);
        ui.ctx().request_repaint_after(self.next_look());
    }

    /// Shows the overlay, and does its requests.
    fn show_overlay(&mut self, ui: &mut Ui) {
        let waits = self.sending.dispatcher.waits();
        let work = &mut self.studio.context();
        if self.progress.show(ui.ctx(), work, &waits) {
            self.sending.dispatcher.give_up();
        }
        for act in self.overlay.show(ui, work) {
            self.act(act, ui.ctx());
        }
        if self.overlay.closes() {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }
}

impl eframe::App for App {
    fn raw_input_hook(&mut self, context: &Context, input: &mut egui::RawInput) {
        self.hands.pen.take_in(context, input);
    }

    fn logic(&mut self, context: &Context, _frame: &mut eframe::Frame) {
        let ends = self.connection.stop.requested() || self.lost.is_lost();
        if ends {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        presses::return_keyboard(context);
        let path = self.pointer(context);
        let now_ns = self.connection.bus.now_ns();
        let (view, studio) = (self.desk.view.as_ref(), &mut self.studio);
        self.hands.send(context, &path, view, (now_ns, studio));
        // After the mouse has sent its position: its brush is drawn there.
        self.drain(now_ns);
        // The newest status has been read: it may say that there is something to lose.
        let is_asked = context.input(|input| input.viewport().close_requested());
        if is_asked && !ends && !self.overlay.may_close(&self.studio.rig) {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            context.request_repaint();
        }
        let brush = self.studio.rig.brush_name();
        self.studio.rig.contact = self.hands.contact(&self.connection.tracker, brush);
        self.send(context);
        self.follow(context, now_ns);
        if self.hands.is_held() {
            context.request_repaint_after(STILL);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let preferences = &mut self.studio.preferences;
        self.look.follow(
            ui.ctx(),
            preferences.window.theme,
            &mut preferences.window.text_size,
        );
        preferences.window.is_narrow = ui.max_rect().width() < sides::NARROW;
        CentralPanel::default()
            .frame(Frame::NONE)
            .show(ui, |ui| self.show_desk(ui));
        self.show_overlay(ui);
        self.change_hands();
        self.memory.follow(ui.ctx(), &mut self.studio);
        self.send(ui.ctx());
    }

    fn clear_color(&self, _visuals: &Visuals) -> [f32; 4] {
        DESK_COLOUR.to_normalized_gamma_f32()
    }

    fn on_exit(&mut self) {
        self.sending.end();
        self.hands.pen.end();
        self.connection.stop.request();
        self.connection.wake.ring();
        self.desk.scene_renderer.end();
        self.connection.leave();
    }
}
