//! The pen over the window: what it finds there, and what of its pointer the window has.

use std::sync::Arc;

use eframe::egui::{Context, Event, PointerButton, Pos2, RawInput, pos2};
use maulstick_bus::{Bus, BusError};
use maulstick_types::Origin;
use maulstick_types::scene::Surface;
use maulstick_types::wire::topics::Topics;
use maulstick_window_pen::{DeskView, Hand, PenNews, PenThread, PointerNews, Shared, pens_of};
use raw_window_handle::{RawDisplayHandle, RawWindowHandle};

use crate::input::navigation::is_panel;
use crate::view::camera::View;

/// The pointer that a pen has moved is still its own so long after it has left, ns: the window hears of the two apart.
const LINGERS_NS: u64 = 200_000_000;

/// The desk as the window shows it.
struct ShownDesk {
    context: Context,
    view: View,
    surfaces: Vec<Surface>,
    /// Units of the window system a point.
    per_point: f64,
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

    fn is_mirrored(&self) -> bool {
        self.view.mirrored
    }
}

/// The pens of the window.
pub(crate) struct WindowPen {
    hand: Option<Hand>,
    shared: Shared,
    thread: Option<PenThread>,
    news: PenNews,
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
        let shared = Shared::default();
        let hand = Hand::new(Arc::clone(bus), topics, (name, me), shared.clone())?;
        Ok(Self {
            hand: Some(hand),
            shared,
            thread: None,
            news: PenNews::default(),
        })
    }

    /// Reads the pens of a window, which must outlive this or its [`end`](Self::end).
    pub(crate) fn begin(
        &mut self,
        context: &Context,
        display: RawDisplayHandle,
        window: RawWindowHandle,
    ) {
        let Some(mut hand) = self.hand.take() else {
            return;
        };
        let context = context.clone();
        self.shared.on_news(move || context.request_repaint());
        match pens_of(display, window) {
            Ok(source) => match PenThread::of(source, hand) {
                Ok(thread) => self.thread = Some(thread),
                Err(fault) => tracing::warn!("{}", fault.what),
            },
            Err(fault) => hand.fail(&fault),
        }
    }

    /// The window is about to close.
    pub(crate) fn end(&mut self) {
        self.thread = None;
    }

    /// The window shows the desk so; `brush` is in the hand.
    pub(crate) fn show(
        &self,
        context: &Context,
        view: Option<&View>,
        surfaces: &[Surface],
        brush: &str,
    ) {
        let per_point = match self.news.moves_no_pointer {
            true => context.zoom_factor(),
            false => context.pixels_per_point(),
        };
        let view = view.map(|view| -> Box<dyn DeskView> {
            Box::new(ShownDesk {
                context: context.clone(),
                view: *view,
                surfaces: surfaces.to_vec(),
                per_point: per_point.into(),
            })
        });
        self.shared.show(view, brush);
    }

    /// What the newest pen senses, bits of `axes`; 0 before one was near.
    #[must_use]
    pub(crate) fn senses(&self) -> u32 {
        self.news.senses
    }

    /// True while the pointer is a pen's: on the desk it does nothing then.
    #[must_use]
    pub(crate) fn has_pointer(&self, now_ns: u64) -> bool {
        let news = &self.news;
        news.is_near || news.near_ns > 0 && now_ns < news.near_ns + LINGERS_NS
    }

    /// Takes in what pens did: where the window system moves no pointer with them, this does, and while one is near no
    /// finger counts, for it is a palm.
    pub(crate) fn take_in(&mut self, context: &Context, input: &mut RawInput) {
        self.news = self.shared.news();
        if self.news.is_near {
            refuse_palms(&mut input.events);
        }
        if !self.news.moves_no_pointer {
            return;
        }
        let per_point = f64::from(context.zoom_factor());
        let at = |point: [f64; 2]| {
            let [x, y] = point.map(|at| (at / per_point) as f32);
            pos2(x, y)
        };
        let modifiers = context.input(|input| input.modifiers);
        let events = std::mem::take(&mut self.news.pointer).into_iter();
        input.events.extend(events.map(|news| match news {
            PointerNews::Moved(point) => Event::PointerMoved(at(point)),
            PointerNews::Pressed(point, pressed) => Event::PointerButton {
                pos: at(point),
                button: PointerButton::Primary,
                pressed,
                modifiers,
            },
            PointerNews::Gone => Event::PointerGone,
        }));
    }
}

/// Takes fingers out of events, with the pointer that the first of them moves: its events follow the finger's own.
fn refuse_palms(events: &mut Vec<Event>) {
    let mut finger = false;
    events.retain(|event| match event {
        Event::Touch { .. } => {
            finger = true;
            false
        }
        Event::PointerMoved(_) | Event::PointerButton { .. } | Event::PointerGone => !finger,
        _ => {
            finger = false;
            true
        }
    });
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Key, Modifiers, TouchDeviceId, TouchId, TouchPhase};

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
    }
}
