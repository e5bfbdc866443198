//! The window.
//!
//! | module | holds |
//! | --- | --- |
//! | `actions` | actions of the painter: keys, clicks and gestures |
//! | `overlay` | what lies over the desk: panels, dialogs, help |
//! | [`rack`] | the brush rack at the edge |
//! | `first_run` | the line of help for a new painter |

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use eframe::egui::{self, CentralPanel, Context, CursorIcon, Frame, Visuals};
use eframe::egui_wgpu::RenderState;
use maulstick_brush::palette_place::Side;
use maulstick_bus::typed::{ask, random_epoch};
use maulstick_bus::{Bus, Class, Wake};
use maulstick_optics::PaintLibrary;
use maulstick_paint::picture::Export;
use maulstick_rig::{Fault, Member, Stop};
use maulstick_types::paint::{ThumbnailReply, ThumbnailRequest};
use maulstick_types::scene::Surface;
use maulstick_types::topics::Topics;
use maulstick_types::{Origin, name_hash};

use self::actions::side;
use crate::app::overlay::Shell;
use crate::input::clean_key::LiftingKey;
use crate::input::mouse_stylus::Mouse;
use crate::input::navigation::Hand;
use crate::input::palette_gesture::Wave;
use crate::render::device_loss::LostDevice;
use crate::render::display_transform::Tint;
use crate::render::frame_reports::Presenter;
use crate::render::scene::{Source, Stage};
use crate::rig::brushes::{Follower, SILENCE_NS};
use crate::rig::dispatcher::Courier;
use crate::rig::health::Watch;
use crate::rig::listener::Hearing;
use crate::rig::requests::Orders;
use crate::rig::state::Studio;
use crate::rig::stroke_barrier::Landing;
use crate::rig::thumbnails::{Picture, ThumbnailFetcher};
use crate::settings::preferences::Habits;
use crate::view::camera::{DESK_COLOUR, View};
use crate::view::palette_slide::Glide;
use crate::widgets::context::Work;
use crate::widgets::notifications::Toasts;
use crate::widgets::progress::Progress;

mod actions;
mod first_run;
pub(crate) mod overlay;
pub mod rack;

/// Longer side of a version's small picture, pixels, and how long one may take.
const THUMBNAIL: u32 = 128;
const FETCH: Duration = Duration::from_secs(1);
/// A pressed pointer that stands still is told this often: a longer silence would lift the brush.
const STILL: Duration = Duration::from_millis(30);

/// An order that waits for its stroke is looked at again after this, whatever comes.
const LANDING_LOOK: Duration = Duration::from_millis(50);

/// The painter's view.
pub struct App {
    bus: Arc<dyn Bus>,
    stop: Stop,
    wake: Wake,
    topics: Topics,
    hearing: Hearing,
    studio: Studio,
    stage: Stage,
    presenter: Option<Presenter>,
    lost: LostDevice,
    follower: Follower,
    progress: Progress,
    watch: Watch,
    mouse: Mouse,
    view: Option<View>,
    pressed: bool,
    hand: Hand,
    glide: Glide,
    lifting: LiftingKey,
    wave: Wave,
    /// The side of the palette as it was last looked at, and the start of the paint node then.
    side: Option<(Side, u64)>,
    shell: Shell,
    orders: Orders,
    landing: Landing,
    courier: Courier,
    fetcher: ThumbnailFetcher,
    toasts: Toasts,
    habits: Habits,
    /// Habits as they were last kept, and where.
    kept: (Habits, Option<PathBuf>),
    member: Option<Member>,
}

impl App {
    /// The view of a rig whose paints are those of `library`.
    ///
    /// # Errors
    /// A [`Fault`] where the bus is closed.
    pub fn new(member: &Member, mouse: &str, library: PaintLibrary) -> Result<Self, Fault> {
        let (bus, topics, brushes) = (&member.bus, &member.topics, &member.config.brush);
        let names: Vec<String> = brushes.iter().map(|brush| brush.name.clone()).collect();
        let brush = names.first().map_or("main", String::as_str);
        let depth_shares = brushes
            .iter()
            .map(|brush| (brush.name.clone(), brush.depth_share));
        let me = member.origin(mouse);
        let mut toasts = Toasts::default();
        let place = Habits::place();
        let read = place
            .as_deref()
            .map_or_else(|| Ok(Habits::default()), Habits::read);
        let habits = read.unwrap_or_else(|fault| {
            toasts.of(&fault);
            Habits::default()
        });
        let lost = LostDevice::new(&member.folder);
        if let Some(why) = lost.word() {
            toasts.fault(
                format!("The graphics device was lost: {why}"),
                "The window was opened again, and nothing is missing.",
            );
        }
        Ok(Self {
            mouse: Mouse::new(&**bus, topics, mouse, brush, me)?,
            follower: Follower::new(
                &**bus,
                topics,
                &member.wake,
                depth_shares.collect(),
                me.source,
            )?,
            progress: Progress::default(),
            watch: Watch::default(),
            hearing: Hearing::new(&**bus, topics, &member.wake)?,
            studio: Studio::new(&member.config.rig.name, &names, Arc::new(library)),
            courier: Courier::new(Arc::clone(bus), topics, &member.wake),
            fetcher: fetcher(member),
            bus: Arc::clone(bus),
            stop: member.stop.clone(),
            wake: member.wake.clone(),
            topics: topics.clone(),
            hand: Hand::default(),
            glide: Glide::default(),
            lifting: LiftingKey::default(),
            wave: Wave::default(),
            side: None,
            stage: Stage::default(),
            presenter: None,
            lost,
            view: None,
            pressed: false,
            shell: Shell::default(),
            orders: Orders::default(),
            landing: Landing::new(&**bus, topics, &member.wake)?,
            toasts,
            kept: (habits.clone(), place),
            habits,
            member: None,
        })
    }

    /// Keeps the membership for as long as the window lives.
    #[must_use]
    pub fn with_member(mut self, member: Member) -> Self {
        self.member = Some(member);
        self
    }

    /// Width and height that the window had, points.
    #[must_use]
    pub fn size(&self) -> [f32; 2] {
        self.habits.size
    }

    /// What watches over the graphics device.
    #[must_use]
    pub fn lost(&self) -> LostDevice {
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
        self.studio.tint = Arc::new(Tint::new(export));
        self.stage.begin(context, state, export, source);
        self.lost.follow(&state.device, context);
    }

    fn take_in(&mut self, now_ns: u64) {
        self.hearing.take_in(now_ns, &mut self.studio);
        self.follower.take_in(now_ns);
        let (studio, toasts) = (&mut self.studio, &mut self.toasts);
        self.watch.look(studio, &self.topics, toasts);
        self.stage.take_in(&mut self.studio);
        self.fetcher.exchange(&mut self.studio.thumbnails, now_ns);
        for told in self.courier.told() {
            self.shell.hear(
                &told,
                &mut Work {
                    studio: &mut self.studio,
                    orders: &mut self.orders,
                    habits: &mut self.habits,
                    toasts: &mut self.toasts,
                },
            );
        }
    }

    /// Sends what is asked for, as soon as the strokes before it have landed.
    fn send(&mut self, context: &Context) {
        let now_ns = self.bus.now_ns();
        for order in self.orders.take() {
            self.landing
                .give(now_ns, order, self.follower.newest(now_ns));
        }
        while let Some(due) = self.landing.due(now_ns) {
            self.courier.send(due);
        }
        if self.landing.holds() {
            context.request_repaint_after(LANDING_LOOK);
        }
    }

    /// Remembers how large the window is, once nobody drags at it.
    fn remember_size(&mut self, context: &Context) {
        let size = context.input(|input| {
            let whole = input.viewport().fullscreen.unwrap_or(false);
            let rests = !whole && !input.pointer.any_down() && input.stable_dt < 0.5;
            rests.then(|| input.content_rect().size())
        });
        if let Some(size) = size {
            self.habits.size = size.round().into();
        }
    }

    /// Keeps the habits where they have changed.
    fn keep(&mut self) {
        let (kept, place) = &mut self.kept;
        if *kept == self.habits {
            return;
        }
        kept.clone_from(&self.habits);
        if let Some(Err(fault)) = place.as_deref().map(|place| kept.keep(place)) {
            self.toasts.of(&fault);
        }
    }
}

/// Fetches small pictures of versions from the paint node.
fn fetcher(member: &Member) -> ThumbnailFetcher {
    let (bus, topic) = (Arc::clone(&member.bus), member.topics.thumbnail());
    let me = member.origin("ui");
    let fetch = move |version: &str| {
        let request = ThumbnailRequest {
            version: version.to_owned(),
            side: THUMBNAIL,
        };
        let reply = ask(&*bus, &topic, Class::Data, me, &request, FETCH).ok()?;
        let ThumbnailReply {
            width, height, rgb, ..
        } = reply;
        Picture::new([width as usize, height as usize], rgb.into_vec())
    };
    ThumbnailFetcher::new(fetch, &member.wake)
}

impl eframe::App for App {
    fn logic(&mut self, context: &Context, _frame: &mut eframe::Frame) {
        if self.stop.requested() || self.lost.is_lost() {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        let places = self.pointer(context);
        let now_ns = self.bus.now_ns();
        let brush = self.studio.brush_name();
        let taken = self.mouse.take(now_ns, brush);
        if let Err(error) = taken.and_then(|()| self.mouse.send(now_ns, &places)) {
            tracing::warn!("the mouse: {error}");
        }
        // After the mouse has told where it is: its brush is drawn there.
        self.take_in(now_ns);
        self.landing.take_in();
        self.send(context);
        self.follow(context, now_ns);
        if self.pressed {
            context.request_repaint_after(STILL);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
            let side = side(&self.habits);
            let (canvas, palette) = (self.studio.canvas(), self.studio.palette());
            self.view = canvas
                .and_then(|canvas| View::of(ui.max_rect(), canvas, palette, side, rack::WIDTH));
            let Some(view) = self.view else {
                ui.centered_and_justified(|ui| ui.label("waiting for the paint …"));
                return;
            };
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
            let surfaces = self.studio.scene.iter().flat_map(|scene| &scene.surfaces);
            let mut surfaces: Vec<Surface> = surfaces.cloned().collect();
            let now_s = ui.input(|input| input.time);
            if self.glide.show(now_s, &mut surfaces) {
                ui.ctx().request_repaint();
            }
            let pixels_per_point = ui.ctx().pixels_per_point();
            let shapes = self.stage.shapes(
                &self.studio,
                &surfaces,
                &self.follower,
                &view,
                pixels_per_point,
            );
            ui.painter().extend(shapes);
            self.name_wells(ui.painter(), &view, &surfaces);
            self.draw_force(ui.painter(), &view);
            if let Some(presenter) = &mut self.presenter {
                let (begun_ns, holding) = (self.studio.now_ns, self.stage.holding());
                ui.painter()
                    .add(presenter.shape(view.area, begun_ns, holding));
            }
            // Nothing tells when a device falls silent.
            let silence = Duration::from_nanos(SILENCE_NS);
            ui.ctx().request_repaint_after(silence);
        });
        let waits = self.courier.waits();
        let work = &mut Work {
            studio: &mut self.studio,
            orders: &mut self.orders,
            habits: &mut self.habits,
            toasts: &mut self.toasts,
        };
        if self.progress.show(ui.ctx(), work, &waits) {
            self.courier.give_up();
        }
        let acts = self.shell.show(
            ui,
            &mut Work {
                studio: &mut self.studio,
                orders: &mut self.orders,
                habits: &mut self.habits,
                toasts: &mut self.toasts,
            },
        );
        for act in acts {
            self.act(act, ui.ctx().pixels_per_point());
        }
        self.change_hands();
        self.remember_size(ui.ctx());
        self.send(ui.ctx());
        self.keep();
    }

    fn clear_color(&self, _visuals: &Visuals) -> [f32; 4] {
        DESK_COLOUR.to_normalized_gamma_f32()
    }

    fn on_exit(&mut self) {
        self.stop.request();
        self.wake.ring();
        self.stage.end();
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
