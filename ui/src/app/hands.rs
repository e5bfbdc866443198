//! The painter's hands over the window: mouse, pen, and the gestures of both.

use eframe::egui::Context;
use maulstick_rig::{NodeHandle, UserError};

use maulstick_window_pen::mouse::brush_turn::BrushTurn;
use maulstick_window_pen::mouse::{Mouse, Pointer};

use crate::app::studio::Studio;
use crate::input::clean_key::CleanKey;
use crate::input::navigation::Navigation;
use crate::input::palette_gesture::PaletteGesture;
use crate::input::pen::WindowPen;
use crate::input::pointer_path::PointerPath;
use crate::rig::brushes::BrushTracker;
use crate::rig::state::BrushContact;
use crate::view::camera::View;

/// Mouse, pen and gestures.
pub(super) struct Hands {
    pub(super) mouse: Mouse,
    pub(super) pen: WindowPen,
    pub(super) pointer_path: PointerPath,
    pub(super) navigation: Navigation,
    pub(super) clean_key: CleanKey,
    pub(super) palette_gesture: PaletteGesture,
    brush_turn: BrushTurn,
}

impl Hands {
    /// Mouse and pen as devices of these names in the rig of `member`.
    ///
    /// # Errors
    /// A [`UserError`] where the bus is closed.
    pub(super) fn new(member: &NodeHandle, [mouse, pen]: [&str; 2]) -> Result<Self, UserError> {
        let (bus, topics) = (&member.bus, &member.topics);
        let brush = member.config.brush.first();
        let brush = brush.map_or("main", |brush| &brush.name);
        let (me, pen_origin) = (member.origin(mouse), member.origin(pen));
        Ok(Self {
            mouse: Mouse::new(&**bus, topics, (mouse, pen_origin.source), brush, me)?,
            pen: WindowPen::new(bus, topics, pen, pen_origin)?,
            pointer_path: PointerPath::default(),
            navigation: Navigation::default(),
            clean_key: CleanKey::default(),
            palette_gesture: PaletteGesture::default(),
            brush_turn: BrushTurn::default(),
        })
    }

    /// Sends the path of the mouse since the last frame, and greets a pen that is new.
    pub(super) fn send(
        &mut self,
        context: &Context,
        path: &[Pointer],
        view: Option<&View>,
        (now_ns, studio): (u64, &mut Studio),
    ) {
        let taken = self.mouse.take(now_ns, studio.rig.brush_name());
        let grip = studio.preferences.brushes.mouse;
        let pixels_per_point = f64::from(context.pixels_per_point());
        let pixel_m = view.map_or(0.0, |view| 1.0 / (view.scale * pixels_per_point));
        let path = self.brush_turn.turned(now_ns, path, &grip, pixel_m);
        if let Err(error) = taken.and_then(|()| self.mouse.send(now_ns, &path, grip.pressure)) {
            tracing::warn!("the mouse: {error}");
        }
        self.pen
            .greet(&mut studio.preferences, &mut studio.notifications);
        studio.rig.pen_pressure = self.pen.pressure();
    }

    /// True while samples are due although the pointer stands still.
    pub(super) fn is_held(&self) -> bool {
        self.pointer_path.is_pressed() || self.brush_turn.is_waiting()
    }

    /// Contact of a brush with a surface. The mouse's own samples arrive late.
    pub(super) fn contact(&self, tracker: &BrushTracker, brush: &str) -> BrushContact {
        let is_held = if tracker.is_led_by_mouse(brush) {
            self.pointer_path.is_pressed()
        } else {
            tracker.aim(brush).is_some_and(|(_, in_air)| !in_air)
        };
        BrushContact::of(is_held)
    }

    /// True while a brush touches the desk: neither the view nor a surface is then moved under it, except by the
    /// painter's free hand.
    pub(super) fn holds_desk(&self, tracker: &BrushTracker) -> bool {
        self.pointer_path.is_pressed() || tracker.touches()
    }
}
