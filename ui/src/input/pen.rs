//! The pen over the window: its target, and the part of its pointer that the window gets.

use std::sync::Arc;

use eframe::CreationContext;
use eframe::egui::{
    Color32, Context, Event, Id, LayerId, Order, PointerButton, Pos2, RawInput, Stroke, TouchPhase,
    pos2,
};
use maulstick_bus::{Bus, BusError};
use maulstick_types::Origin;
use maulstick_types::scene::Surface;
use maulstick_types::wire::topics::Topics;
use maulstick_ui_kit::notifications::Notifications;
use maulstick_window_pen::{
    DeskView, PenLink, PenState, PenThread, PointerEvent, WindowStylus, pens_of,
};
use raw_window_handle::{HasDisplayHandle as _, HasWindowHandle as _};

use crate::input::keys::Action;
use crate::input::navigation::is_panel;
use crate::input::presses;
use crate::panels::device;
use crate::settings::preferences::Preferences;
use crate::view::camera::View;

/// Time after a pen's departure during which the pointer is still its own, ns: the window receives the two events
/// separately.
const LINGERS_NS: u64 = 200_000_000;

/// The desk as the window shows it.
struct ShownDesk {
    context: Context,
    view: View,
    surfaces: Vec<Surface>,
    /// Units of the window system a point.
    per_point: f64,
    /// False while a key is held that makes something else of a drag than a stroke.
    paints: bool,
}

impl ShownDesk {
    fn at(&self, point: [f64; 2]) -> Pos2 {
        let [x, y] = point.map(|at| (at / self.per_point) as f32);
        pos2(x, y)
    }
}

impl DeskView for ShownDesk {
    fn is_desk(&self, point: [f64; 2]) -> bool {
        let at = self.at(point);
        self.view.area.contains(at) && !is_panel(&self.context, at)
    }

    fn to_desk(&self, point: [f64; 2]) -> [f64; 3] {
        self.view.to_desk(self.at(point), &self.surfaces).to_array()
    }

    fn takes_strokes(&self) -> bool {
        self.paints
    }

    fn is_mirrored(&self) -> bool {
        self.view.mirrored
    }
}

/// The pens of the window.
pub(crate) struct WindowPen {
    stylus: Option<WindowStylus>,
    link: PenLink,
    thread: Option<PenThread>,
    state: PenState,
    /// True while pens are pointers, whose presses paint nothing.
    is_pointing: bool,
}

impl WindowPen {
    /// Pens that are called `name` on the bus.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub(crate) fn new(
        bus: &Arc<dyn Bus>,
        topics: &Topics,
        name: &str,
        me: Origin,
    ) -> Result<Self, BusError> {
        let link = PenLink::default();
        let stylus = WindowStylus::new(Arc::clone(bus), topics, (name, me), link.clone())?;
        Ok(Self {
            stylus: Some(stylus),
            link,
            thread: None,
            state: PenState::default(),
            is_pointing: false,
        })
    }

    /// Reads the pens of a window, which must outlive this or its [`end`](Self::end).
    #[expect(unsafe_code, reason = "a window's handles are pointers of its library")]
    pub(crate) fn begin(&mut self, window: &CreationContext<'_>) {
        let handles = window
            .display_handle()
            .ok()
            .zip(window.window_handle().ok());
        let Some((display, own)) = handles else {
            return;
        };
        let Some(mut stylus) = self.stylus.take() else {
            return;
        };
        let context = window.egui_ctx.clone();
        self.link.on_pointer(move || context.request_repaint());
        // SAFETY: the window's application ends this before the window closes.
        let source = unsafe { pens_of(display.as_raw(), own.as_raw()) };
        match source {
            Ok(source) => match PenThread::of(source, stylus) {
                Ok(thread) => self.thread = Some(thread),
                Err(fault) => tracing::warn!("{}", fault.what),
            },
            Err(fault) => stylus.fail(&fault),
        }
    }

    /// Pressure that a pen senses now, 0 to 1; `None` while none is near.
    pub(crate) fn pressure(&self) -> Option<f64> {
        self.state.is_near.then_some(self.state.pressure)
    }

    /// The window is about to close.
    pub(crate) fn end(&mut self) {
        self.thread = None;
    }

    /// Makes pens act as pointers, or as brushes.
    pub(crate) fn set_pointing(&mut self, is_pointing: bool) {
        self.is_pointing = is_pointing;
    }

    /// Sets the displayed desk, and the brush in the hand.
    pub(crate) fn show(
        &self,
        context: &Context,
        view: Option<(&View, &[Surface])>,
        brush: &str,
        preferences: &Preferences,
    ) {
        let keymap = &preferences.keys;
        self.link.bend_pressure(&preferences.brushes.pen_curve);
        let paints = context.input(|input| {
            let held = [Action::Size, Action::Zoom];
            let held = held.iter().any(|act| presses::is_down(input, keymap, *act));
            let modifiers = input.modifiers;
            (modifiers.is_none() || modifiers.shift_only()) && !held && !self.is_pointing
        });
        let per_point = if self.state.moves_no_pointer {
            context.zoom_factor()
        } else {
            context.pixels_per_point()
        };
        let view = view.map(|(view, surfaces)| -> Arc<dyn DeskView> {
            Arc::new(ShownDesk {
                context: context.clone(),
                view: *view,
                surfaces: surfaces.to_vec(),
                per_point: per_point.into(),
                paints,
            })
        });
        self.link.show(view, brush);
    }

    /// Draws the pointer of a pen over a panel, where the window system draws none.
    pub(crate) fn draw(&self, context: &Context) {
        let at = context.input(|input| input.pointer.latest_pos());
        let shows = self.state.moves_no_pointer && self.state.is_near;
        if let Some(at) = at.filter(|at| shows && is_panel(context, *at)) {
            let layer = LayerId::new(Order::Tooltip, Id::unique("pen"));
            let painter = context.layer_painter(layer);
            painter.circle_stroke(at, 4.0, Stroke::new(3.0, Color32::BLACK));
            painter.circle_stroke(at, 4.0, Stroke::new(1.5, Color32::WHITE));
        }
    }

    /// Notifies once of the pens' senses.
    pub(crate) fn greet(&self, preferences: &mut Preferences, notifications: &mut Notifications) {
        let senses = self.state.senses;
        if senses & !preferences.pen_senses != 0 {
            preferences.pen_senses |= senses;
            let list = device::senses(senses);
            notifications.note(tr!("Your pen paints. It senses {list}.", list));
        }
    }

    /// True while the pointer is a pen's, when it does nothing on the desk.
    #[must_use]
    pub(crate) fn has_pointer(&self, now_ns: u64) -> bool {
        let state = &self.state;
        state.is_near || state.near_ns > 0 && now_ns < state.near_ns + LINGERS_NS
    }

    /// Handles events of pens: where the window system moves no pointer with them, this does, and while one is near
    /// fingers are ignored as palms.
    pub(crate) fn take_in(&mut self, context: &Context, input: &mut RawInput) {
        self.state = self.link.state();
        if self.state.is_near {
            refuse_palms(&mut input.events);
        }
        if !self.state.moves_no_pointer {
            return;
        }
        let per_point = f64::from(context.zoom_factor());
        let at = |point: [f64; 2]| {
            let [x, y] = point.map(|at| (at / per_point) as f32);
            pos2(x, y)
        };
        let modifiers = context.input(|input| input.modifiers);
        let events = std::mem::take(&mut self.state.pointer).into_iter();
        input.events.extend(events.map(|event| match event {
            PointerEvent::Moved(point) => Event::PointerMoved(at(point)),
            PointerEvent::Pressed(point, pressed) => Event::PointerButton {
                pos: at(point),
                button: PointerButton::Primary,
                pressed,
                modifiers,
            },
            PointerEvent::Gone => Event::PointerGone,
        }));
    }
}

/// Removes fingers that come down or move from the events, with the pointer of the first. Lifts stay: a palm may have
/// come before the pen.
fn refuse_palms(events: &mut Vec<Event>) {
    let mut finger = None;
    events.retain(|event| match event {
        Event::Touch { phase, pos, .. } => {
            finger = Some(*pos);
            matches!(phase, TouchPhase::End | TouchPhase::Cancel)
        }
        Event::PointerMoved(at)
        | Event::PointerButton {
            pos: at,
            pressed: true,
            ..
        } => finger != Some(*at),
        _ => true,
    });
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Key, Modifiers, TouchDeviceId, TouchId};

    use super::*;

    #[test]
    fn a_palm_moves_no_pointer_and_the_keyboard_stays() {
        let at = pos2(10.0, 20.0);
        let key = Event::Key {
            key: Key::A,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: Modifiers::NONE,
        };
        let press = Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed: true,
            modifiers: Modifiers::NONE,
        };
        let touch = Event::Touch {
            device_id: TouchDeviceId(1),
            id: TouchId(1),
            phase: TouchPhase::Start,
            pos: at,
            force: None,
        };
        let mouse = Event::PointerMoved(pos2(1.0, 1.0));
        let mut events = vec![
            mouse.clone(),
            touch,
            Event::PointerMoved(at),
            press,
            key.clone(),
        ];
        refuse_palms(&mut events);
        assert_eq!(events, [mouse, key]);
        // A finger present before the pen is lifted, and a mouse's button, too.
        let lifted = |phase| Event::Touch {
            device_id: TouchDeviceId(1),
            id: TouchId(1),
            phase,
            pos: at,
            force: None,
        };
        let release = Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed: false,
            modifiers: Modifiers::NONE,
        };
        let whole = vec![lifted(TouchPhase::End), release, Event::PointerGone];
        let mut events = whole.clone();
        refuse_palms(&mut events);
        assert_eq!(events, whole);
    }
}
