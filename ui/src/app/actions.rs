//! Actions of pointer and keys on the desk.

use eframe::egui::{self, Color32, Context, Event, Stroke};
use glam::{DVec2, DVec3};
use maulstick_brush::palette_place::{Side, beside, is_out, is_same, mirrored, over, size_m};
use maulstick_painting::edits::common;
use maulstick_types::scene::{CANVAS, PALETTE, Surface};

use maulstick_window_pen::mouse::Pointer;

use super::{App, STILL};
use crate::input::keys::Action;
use crate::input::navigation::{Around, is_panel, place};
use crate::settings::preferences::Preferences;
use crate::view::camera::View;
use crate::view::fit_crosses;
use crate::view::well_labels::{self, Shown};

/// Length of a newton's arrow, m.
const ARROW_M_N: f64 = 0.02;
const ARROW: Color32 = Color32::from_rgb(230, 120, 40);

impl App {
    /// Path of the pointer over the desk since the last frame.
    pub(super) fn pointer(&mut self, context: &Context) -> Vec<Pointer> {
        let (Some(scene), Some(view)) = (&self.studio.rig.live.scene, &self.desk.view) else {
            return Vec::new();
        };
        // Two fingers move the canvas.
        let fingers = context.input(|input| input.multi_touch().is_some());
        let pen = self.hands.pen.has_pointer(self.connection.bus.now_ns());
        if fingers || pen || self.hands.navigation.holds() || self.overlay.motions.is_placing() {
            self.hands.pointer_path.lift();
            return Vec::new();
        }
        let on_desk = |at: egui::Pos2| view.area.contains(at) && !is_panel(context, at);
        let input = context.input(Clone::clone);
        let keys = &self.studio.preferences.keys;
        let places = self
            .hands
            .pointer_path
            .follow(&input, keys, on_desk)
            .into_iter();
        let pointer = |(at, pressed): (egui::Pos2, bool)| Pointer {
            at: view.to_desk(at, &scene.surfaces).to_array(),
            pressed,
            twist_rad: 0.0,
        };
        places.map(pointer).collect()
    }

    /// Does an action of the desk.
    pub(super) fn act(&mut self, act: Action, context: &Context) {
        let (Some(canvas), Some(view)) = (self.studio.rig.live.canvas(), &self.desk.view) else {
            return;
        };
        self.hands.navigation.forget();
        match act {
            Action::Fit => place(&mut self.studio.requests, &view.fitted(canvas), CANVAS),
            Action::Hundred => {
                let lie = view.hundred(canvas, context.pixels_per_point());
                place(&mut self.studio.requests, &lie, CANVAS);
            }
            Action::Palette => self.slide(),
            Action::LoadFrom => self.load_from(context),
            _ => {}
        }
    }

    /// The point of the desk at the pointer.
    fn pointed_at(&self, context: &Context) -> Option<DVec3> {
        let (scene, view) = (
            self.studio.rig.live.scene.as_ref()?,
            self.desk.view.as_ref()?,
        );
        let at = context.input(|input| input.pointer.latest_pos())?;
        let is_on_desk = view.area.contains(at) && !is_panel(context, at);
        is_on_desk.then(|| view.to_desk(at, &scene.surfaces))
    }

    /// Loads the brush in the hand with the mixture under it.
    fn load_from(&mut self, context: &Context) {
        let name = self.studio.rig.brush_name();
        // The mouse's newest sample comes back a frame later: it is where its pointer is.
        let pointer = if self.connection.tracker.is_led_by_mouse(name) {
            self.pointed_at(context)
        } else {
            None
        };
        let aim = pointer.or(self.connection.tracker.aim(name).map(|(at, _)| at));
        let under = aim.and_then(|at| {
            let plane = self.studio.rig.desk.as_ref()?.under(at)?;
            let plane = plane.holds(at).then_some(plane)?;
            let at = plane.to_desk.inverse().point(at) / plane.zoom;
            Some((plane.id, [at.x, at.y]))
        });
        let thinner = self.studio.preferences.brushes.loading.share();
        let load = under.map(|place| common::load_from(name, place, thinner));
        match load {
            Some(Ok(load)) => self.studio.requests.send(load),
            _ => self.studio.notifications.fault(
                tr!("The brush is over neither the canvas nor the palette."),
                tr!("Move it over the mixture that it is to take up."),
            ),
        }
    }

    /// Slides the palette over the canvas, or back beside it.
    pub(super) fn slide(&mut self) {
        let (Some(canvas), Some(palette)) = (
            self.studio.rig.live.canvas(),
            self.studio.rig.live.palette(),
        ) else {
            return;
        };
        let side = side(&self.studio.preferences);
        let pose = if is_out(canvas, palette, side) {
            beside(canvas, palette, side)
        } else {
            over(canvas, palette)
        };
        if let Ok(edit) = common::lay_palette(pose, palette.zoom) {
            self.studio.requests.send(edit);
        }
    }

    /// Carries out navigation, the cleaning key and the palette gesture.
    pub(super) fn follow(&mut self, context: &Context, now_ns: u64) {
        let Some(view) = &self.desk.view else {
            return;
        };
        let scene = self.studio.rig.live.scene.as_ref();
        let surfaces = scene.map(|scene| &scene.surfaces[..]);
        let around = Around {
            view,
            surfaces: surfaces.unwrap_or_default(),
            free: self.hands.mouse.is_free(now_ns) && !self.hands.pen.has_pointer(now_ns),
            // The wheel and the buttons are those of a motion that follows the pointer.
            over_panel: over_panel(context) || self.overlay.motions.is_placing(),
            keys: &self.studio.preferences.keys,
        };
        let navigation = &mut self.hands.navigation;
        context.input(|input| navigation.follow(input, &around));
        let aim = self.connection.tracker.aim(self.studio.rig.brush_name());
        let now_s = context.input(|input| input.time);
        let painting = aim.is_some_and(|(_, in_air)| !in_air);
        let wide_m = f64::from(view.area.width()) / view.scale;
        let at = aim.map(|(at, _)| (at.truncate() - view.middle) / wide_m);
        let at = gone(context, view).or(at);
        self.follow_clean_key(context, painting);
        let free = !painting && !self.hands.navigation.holds();
        if self.hands.palette_gesture.follow(
            now_s,
            at,
            wide_m,
            free,
            side(&self.studio.preferences),
        ) {
            self.slide();
        }
    }

    /// Follows the cleaning key; `painting` while the brush touches something.
    fn follow_clean_key(&mut self, context: &Context, painting: bool) {
        let now_s = context.input(|input| input.time);
        let typing = context.memory(|memory| memory.focused().is_some());
        // A tap may be shorter than a frame.
        let clean = self.studio.preferences.keys.key_of(Action::Clean);
        let is_down = clean.is_some_and(|key| {
            let key = key.logical_key;
            !typing && context.input(|input| input.key_down(key) || input.key_pressed(key))
        });
        if painting && typing {
            // A stylus that is no pointer takes the keyboard from no field.
            context.memory_mut(|memory| {
                if let Some(focused) = memory.focused() {
                    memory.surrender_focus(focused);
                }
            });
        }
        let handling = self.studio.rig.handling();
        self.hands
            .clean_key
            .follow(now_s, is_down, painting, &handling);
        if self.hands.clean_key.is_down() {
            context.request_repaint_after(STILL);
        }
    }

    /// Labels the wells on the displayed palette.
    pub(super) fn name_wells(&self, painter: &egui::Painter, view: &View, seen: &[Surface]) {
        let palette = seen.iter().find(|surface| surface.id == PALETTE);
        let (Some(canvas), Some(palette)) = (self.studio.rig.live.canvas(), palette) else {
            return;
        };
        let aim = self.connection.tracker.aim(self.studio.rig.brush_name());
        let shown = if is_out(canvas, palette, side(&self.studio.preferences)) {
            Some(Shown::All)
        } else {
            aim.map(|(at, _)| Shown::Under(at))
        };
        if let Some(shown) = shown {
            well_labels::draw(painter, view, palette, shown);
        }
    }

    /// Shows the target of a device during its fitting.
    pub(super) fn show_fit(&self, painter: &egui::Painter, view: &View) {
        if let (Some(fit), Some(canvas)) =
            (&self.studio.rig.setup.fit, self.studio.rig.live.canvas())
        {
            fit_crosses::draw(painter, view, canvas, fit.asked_corner());
        }
    }

    /// Draws the force on the hand as an arrow from the brush, while its panel is visible.
    pub(super) fn draw_force(&self, painter: &egui::Painter, view: &View) {
        let seen =
            self.studio.preferences.window.panels && self.studio.preferences.is_open("Device");
        let rig = &self.studio.rig;
        let arrow = rig.live.force_arrow(rig.brush_name());
        let Some((place_m, force_n)) = arrow.filter(|_| seen) else {
            return;
        };
        let from = DVec3::from_array(place_m);
        let to = from + DVec3::from_array(force_n) * ARROW_M_N;
        let [from, to] = [from, to].map(|at| view.to_window(at));
        painter.arrow(from, to - from, Stroke::new(2.5, ARROW));
        // A force straight up is drawn as a ring.
        let ring = (force_n[2].max(0.0) * ARROW_M_N * view.scale) as f32;
        painter.circle_stroke(from, ring, Stroke::new(1.5, ARROW));
    }

    /// Moves palette and wells to the side of the painting hand, if the painter has changed it.
    pub(super) fn change_hands(&mut self) {
        let side = side(&self.studio.preferences);
        let (Some(canvas), Some(palette)) = (
            self.studio.rig.live.canvas(),
            self.studio.rig.live.palette(),
        ) else {
            return;
        };
        let other = match side {
            Side::Left => Side::Right,
            Side::Right => Side::Left,
        };
        // Once for each start of the paint node, and when the painter has changed hands.
        let key = (side, self.studio.rig.live.starts);
        let before = self.desk.side.replace(key);
        let rests = is_same(&palette.pose, &beside(canvas, palette, other));
        let changes = before == Some((other, self.studio.rig.live.starts));
        if before == Some(key) || !(rests || changes) {
            return;
        }
        // A palette over the canvas stays.
        let pose = if rests {
            beside(canvas, palette, side)
        } else {
            palette.pose.clone()
        };
        let wells = mirrored(&palette.wells, size_m(palette));
        if let (Ok(laid), Ok(wells)) = (
            common::lay_palette(pose, palette.zoom),
            common::lay_wells(wells),
        ) {
            self.studio.requests.send(laid);
            self.studio.requests.send(wells);
        }
    }
}

/// True while the pointer is over a panel or another control.
fn over_panel(context: &Context) -> bool {
    let at = context.input(|input| input.pointer.latest_pos());
    at.is_some_and(|at| is_panel(context, at))
}

/// The side of the palette for the hand that paints.
fn side(preferences: &Preferences) -> Side {
    if preferences.window.left_handed {
        Side::Right
    } else {
        Side::Left
    }
}

/// A pointer that has just left the window at its side, a little beyond: shares of the view's width.
fn gone(context: &Context, view: &View) -> Option<DVec2> {
    let (at, speed) = context.input(|input| {
        let gone = input.events.contains(&Event::PointerGone);
        let at = input.pointer.interact_pos().or(input.pointer.latest_pos());
        gone.then_some((at?, input.pointer.velocity()))
    })?;
    let sideways = speed.x.abs() > speed.y.abs();
    // Its position a twentieth of a second ahead.
    let share = (at + 0.05 * speed - view.area.center()) / view.area.width();
    (sideways && share.x.abs() > 0.5)
        .then(|| DVec2::new(view.seen_x(share.x.into()), (-share.y).into()))
}
