//! A motion that follows the pointer over the desk until it is put down, or let go.

use eframe::egui::{
    Color32, Context, Event, Key, Modifiers, MouseWheelUnit, Painter, PointerButton, Vec2,
};
use glam::DVec3;
use maulstick_motion::Placement;
use maulstick_motion::placement::SCALES;
use maulstick_num::exp;
use maulstick_types::scene::Surface;

use crate::input::keys::Action;
use crate::input::navigation::is_panel;
use crate::motions::library::Motion;
use crate::rig::requests::Requests;
use crate::sessions::SessionOrder;
use crate::view::camera::View;

/// A line of the wheel scales by e to this power, and with Shift turns by this, degrees.
const WHEEL: f64 = 0.08;
const WHEEL_DEG: f64 = 3.0;
/// A point of a smooth wheel is this share of a line.
const POINT: f64 = 1.0 / 50.0;
/// A key scales by e to this power, and turns by this, degrees.
const KEY: f64 = 0.1;
const KEY_DEG: f64 = 15.0;
/// Opacity of its strokes: a dark line, and a light one within it.
const DARK: u8 = 150;
const LIGHT: u8 = 200;

/// A motion at the pointer.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Placing {
    motion: Motion,
    scale: f64,
    turn_deg: f64,
}

impl Placing {
    /// As it was recorded.
    #[must_use]
    pub(crate) fn new(motion: Motion) -> Self {
        Self {
            motion,
            scale: 1.0,
            turn_deg: 0.0,
        }
    }

    /// Does what a key asks for; false where it is about something else.
    pub(crate) fn follow(&mut self, act: Action) -> bool {
        match act {
            Action::Larger => self.scale_by(KEY),
            Action::Smaller => self.scale_by(-KEY),
            Action::TurnLeft => self.turn_by(KEY_DEG),
            Action::TurnRight => self.turn_by(-KEY_DEG),
            _ => return false,
        }
        true
    }

    fn scale_by(&mut self, power: f64) {
        let scale = self.scale * exp(power);
        self.scale = scale.max(*SCALES.start()).min(*SCALES.end());
    }

    fn turn_by(&mut self, by_deg: f64) {
        self.turn_deg = (self.turn_deg + by_deg) % 360.0;
    }

    /// Follows the pointer and draws the strokes there; true once it is put down or let go.
    pub(crate) fn poll(
        &mut self,
        context: &Context,
        painter: &Painter,
        (view, surfaces): (&View, &[Surface]),
        requests: &mut Requests,
    ) -> bool {
        if context.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
            return true;
        }
        let (events, latest) =
            context.input(|input| (input.events.clone(), input.pointer.latest_pos()));
        let on_desk = |at| view.area.contains(at) && !is_panel(context, at);
        let mut put = None;
        for event in &events {
            match event {
                Event::MouseWheel {
                    unit,
                    delta,
                    modifiers,
                    ..
                } if latest.is_some_and(on_desk) => {
                    let lines = lines(*unit, *delta);
                    if modifiers.shift {
                        self.turn_by(WHEEL_DEG * view.seen_x(lines));
                    } else {
                        self.scale_by(WHEEL * lines);
                    }
                }
                Event::PointerButton {
                    pos,
                    button: PointerButton::Primary,
                    pressed: true,
                    modifiers,
                } if modifiers.is_none() && on_desk(*pos) => put = Some(*pos),
                Event::PointerButton {
                    button: PointerButton::Secondary,
                    pressed: true,
                    ..
                } => return true,
                _ => {}
            }
        }
        let Some(at) = put.or(latest).filter(|at| on_desk(*at)) else {
            return false;
        };
        let place = view.to_desk(at, surfaces);
        if put.is_some() {
            requests.session(SessionOrder::PutDown {
                take: self.motion.path.clone(),
                at_mm: [1e3 * place.x, 1e3 * place.y],
                scale: self.scale,
                turn_deg: self.turn_deg,
            });
            return true;
        }
        self.draw(painter, view, place);
        false
    }

    fn draw(&self, painter: &Painter, view: &View, place: DVec3) {
        let drawn = &self.motion.drawn;
        let placement = Placement {
            from_m: drawn.middle,
            to_m: place.truncate().to_array(),
            scale: self.scale,
            turn_rad: self.turn_deg.to_radians(),
        };
        let to_window = |at: [f64; 2]| {
            let [x, y] = placement.point(at);
            view.to_window(DVec3::new(x, y, place.z))
        };
        drawn.draw(painter, Color32::from_black_alpha(DARK), 1.6, to_window);
        drawn.draw(painter, Color32::from_white_alpha(LIGHT), 0.8, to_window);
    }
}

/// Lines that the wheel was turned by; with Shift some systems turn it sideways.
fn lines(unit: MouseWheelUnit, delta: Vec2) -> f64 {
    let lines = f64::from(delta.y + delta.x);
    match unit {
        MouseWheelUnit::Point => POINT * lines,
        MouseWheelUnit::Line => lines,
        MouseWheelUnit::Page => 10.0 * lines,
    }
}
