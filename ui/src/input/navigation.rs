//! Navigation by wheel, middle button, modifiers and touch. It sends commands, so a replay repeats it.

use eframe::egui::{
    Context, Event, InputState, Modifiers, MouseWheelUnit, Order, PointerButton, Pos2,
};
use glam::DVec3;
use maulstick_brush::placement::SurfacePlacement;
use maulstick_num::exp;
use maulstick_types::scene::{CANVAS, PALETTE, Surface};

use maulstick_client::request::Request;

use crate::input::keymap::Keymap;
use crate::input::keys::Action;
use crate::input::presses;
use crate::rig::requests::Requests;
use crate::view::camera::View;

/// A line of the wheel zooms by e to this power.
const WHEEL: f64 = 0.12;
/// A point of a smooth wheel is this share of a line.
const POINT: f64 = 1.0 / 50.0;
/// A drag over the height of the view tilts by this, rad.
const TILT: f64 = 1.5;
/// A drag over the height of the view zooms by e to this power.
const DRAG_ZOOM: f64 = 2.0;

/// Effect of a drag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DragMode {
    Pan,
    Turn,
    Tilt,
    Zoom,
}

/// A drag in progress.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Drag {
    drag_mode: DragMode,
    button: PointerButton,
    surface: u32,
    /// Placement of the surface by this drag; the scene follows.
    lie: SurfacePlacement,
    at: Pos2,
}

/// Surroundings of the pointer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around<'a> {
    pub view: &'a View,
    /// The surfaces with their placements.
    pub surfaces: &'a [Surface],
    /// True while no other stylus paints; otherwise the mouse is in the other hand.
    pub free: bool,
    /// True while the pointer is over a panel.
    pub over_panel: bool,
    pub keys: &'a Keymap,
}

#[derive(Debug, Default)]
pub(crate) struct Navigation {
    drag: Option<Drag>,
    /// Last sent surface, placement and time; the scene follows later.
    sent: Option<(u32, SurfacePlacement, f64)>,
    /// Its requests, also within a stroke.
    requests: Requests,
}

/// After this the scene has followed the hand, s.
const FOLLOWED_S: f64 = 0.3;

impl Navigation {
    /// True while a surface is dragged: the pointer is no brush then.
    #[must_use]
    pub(crate) fn holds(&self) -> bool {
        self.drag.is_some()
    }

    /// Handles the input of a frame; adds its requests.
    pub(crate) fn follow(&mut self, input: &InputState, around: &Around<'_>) {
        if let Some(touch) = input.multi_touch() {
            self.drag = None;
            if !around.over_panel {
                self.touch(input.time, &touch, around);
            }
            return;
        }
        for (place, event) in input.events.iter().enumerate() {
            match event {
                Event::PointerButton {
                    pos,
                    button,
                    pressed: true,
                    modifiers,
                } if self.drag.is_none() && !around.over_panel => {
                    let holds = presses::holds(input, around.keys, place);
                    self.drag =
                        drag_mode(*button, *modifiers, holds, around.free).and_then(|drag_mode| {
                            self.grasp(input.time, drag_mode, *button, *pos, around)
                        });
                }
                Event::PointerButton {
                    button,
                    pressed: false,
                    ..
                } if self.drag.is_some_and(|drag| drag.button == *button) => self.drag = None,
                Event::PointerMoved(at) => self.drag_to(input.time, *at, around),
                // A pointer that leaves the window still holds, but a button may be let go over another one.
                Event::WindowFocused(false) => self.drag = None,
                Event::MouseWheel { unit, delta, .. } if !around.over_panel => {
                    let lines = f64::from(delta.y)
                        * match unit {
                            MouseWheelUnit::Point => POINT,
                            MouseWheelUnit::Line => 1.0,
                            MouseWheelUnit::Page => 10.0,
                        };
                    self.zoom(input, exp(WHEEL * lines), around);
                }
                _ => {}
            }
        }
    }

    /// Takes its requests.
    #[must_use]
    pub(crate) fn take(&mut self) -> Vec<Request> {
        self.requests.take()
    }

    /// Forgets where it has sent the surfaces: something else moves them.
    pub(crate) fn forget(&mut self) {
        self.sent = None;
    }

    /// Begins to drag the surface under the pointer: the palette can only be moved.
    fn grasp(
        &self,
        now: f64,
        drag_mode: DragMode,
        button: PointerButton,
        at: Pos2,
        around: &Around<'_>,
    ) -> Option<Drag> {
        let on_palette = find(around.surfaces, PALETTE)
            .filter(|palette| drag_mode == DragMode::Pan && around.view.is_over(at, palette));
        let surface = match on_palette {
            Some(palette) => palette,
            None => find(around.surfaces, CANVAS)?,
        };
        Some(Drag {
            drag_mode,
            button,
            surface: surface.id,
            lie: self.newest(now, surface),
            at,
        })
    }

    fn drag_to(&mut self, now: f64, at: Pos2, around: &Around<'_>) {
        let Some(drag) = &mut self.drag else {
            return;
        };
        let view = around.view;
        let way = at - drag.at;
        let share = f64::from(way.y / view.area.height().max(1.0));
        let lie = drag.lie;
        drag.lie = match drag.drag_mode {
            DragMode::Pan => {
                let height_m = view.to_desk(drag.at, around.surfaces).z;
                lie.moved(view.along(way, height_m))
            }
            DragMode::Turn => {
                let [from, to] = [drag.at, at].map(|at| view.on_desk(at));
                let angle = from.truncate().angle_to(to.truncate());
                lie.turned(DVec3::ZERO, DVec3::Z, angle)
            }
            DragMode::Tilt => lie.tilted(DVec3::ZERO, share * TILT),
            DragMode::Zoom => lie.zoomed(DVec3::ZERO, exp(-share * DRAG_ZOOM)),
        };
        drag.at = at;
        if drag.lie != lie {
            place(&mut self.requests, &drag.lie, drag.surface);
            self.sent = Some((drag.surface, drag.lie, now));
        }
    }

    /// Placement of a surface: the one just sent, otherwise that of the scene.
    fn newest(&self, now: f64, surface: &Surface) -> SurfacePlacement {
        match self.sent {
            Some((id, lie, at)) if id == surface.id && now - at < FOLLOWED_S => lie,
            _ => SurfacePlacement::from(surface),
        }
    }

    fn zoom(&mut self, input: &InputState, factor: f64, around: &Around<'_>) {
        let Some(canvas) = find(around.surfaces, CANVAS) else {
            return;
        };
        let at = input.pointer.latest_pos();
        let about = at.map_or(DVec3::ZERO, |at| around.view.on_desk(at));
        let from = self.newest(input.time, canvas);
        self.send(input.time, canvas.id, from, from.zoomed(about, factor));
    }

    fn touch(&mut self, now: f64, touch: &eframe::egui::MultiTouchInfo, around: &Around<'_>) {
        let Some(canvas) = find(around.surfaces, CANVAS) else {
            return;
        };
        let about = around.view.on_desk(touch.center_pos);
        let height_m = around.view.to_desk(touch.center_pos, around.surfaces).z;
        let from = self.newest(now, canvas);
        let to = from
            .zoomed(about, f64::from(touch.zoom_delta))
            .turned(
                about,
                DVec3::Z,
                -around.view.seen_x(touch.rotation_delta.into()),
            )
            .moved(around.view.along(touch.translation_delta, height_m));
        self.send(now, canvas.id, from, to);
    }

    fn send(&mut self, now: f64, surface: u32, from: SurfacePlacement, to: SurfacePlacement) {
        if to != from {
            place(&mut self.requests, &to, surface);
            self.sent = Some((surface, to, now));
        }
    }
}

/// True where a panel lies over the desk.
#[must_use]
pub(crate) fn is_panel(context: &Context, at: Pos2) -> bool {
    context
        .layer_id_at(at)
        .is_some_and(|layer| layer.order != Order::Background)
}

/// Drag mode of a button with the modifiers and the action whose key are down; `None` if it belongs to the brush.
fn drag_mode(
    button: PointerButton,
    modifiers: Modifiers,
    holds: Option<Action>,
    free: bool,
) -> Option<DragMode> {
    let grasps = match button {
        PointerButton::Middle => true,
        PointerButton::Primary => free || modifiers.command,
        _ => false,
    };
    match grasps {
        _ if button == PointerButton::Primary && holds == Some(Action::Zoom) => {
            Some(DragMode::Zoom)
        }
        _ if button == PointerButton::Primary && holds.is_some() => None,
        false => None,
        true if modifiers.shift => Some(DragMode::Turn),
        true if modifiers.alt => Some(DragMode::Tilt),
        true => Some(DragMode::Pan),
    }
}

/// Places a surface, if that is within reach.
pub(crate) fn place(requests: &mut Requests, lie: &SurfacePlacement, surface: u32) {
    if let Ok(edit) = lie.edit(surface) {
        requests.send(edit);
    }
}

fn find(surfaces: &[Surface], id: u32) -> Option<&Surface> {
    surfaces.iter().find(|surface| surface.id == id)
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use eframe::egui::{Key, Rect, pos2, vec2};
    use egui_kittest::Harness;
    use maulstick_brush::palette_place::Side;
    use maulstick_num::geometry::Rigid;
    use maulstick_painting::PaintingSetup;
    use maulstick_painting::edits::Place;

    use super::*;

    /// Placement commands that result from events on the scene's surfaces.
    fn placed(free: bool, events: impl IntoIterator<Item = Event>) -> Vec<(u32, SurfacePlacement)> {
        let surfaces = PaintingSetup::default().scene().surfaces;
        let hand = RefCell::new(Navigation::default());
        let (view, keys) = (view(&surfaces), Keymap::default());
        let mut harness = Harness::builder()
            .with_size(vec2(1000.0, 600.0))
            .build_ui(|ui| {
                let around = Around {
                    view: &view,
                    surfaces: &surfaces,
                    free,
                    over_panel: false,
                    keys: &keys,
                };
                ui.input(|input| hand.borrow_mut().follow(input, &around));
            });
        for event in events {
            harness.event(event);
            harness.step();
        }
        drop(harness);
        let requests = hand.into_inner().take();
        let lie = |order| match order {
            Request::Command { command, .. } => {
                let place: Place = command.edit().expect("a place");
                let placement = SurfacePlacement {
                    pose: Rigid::from(&place.pose),
                    zoom: place.zoom.get(),
                };
                (place.surface, placement)
            }
            other @ Request::Force { .. } => panic!("{other:?}"),
        };
        requests.into_iter().map(lie).collect()
    }

    fn view(surfaces: &[Surface]) -> View {
        let area = Rect::from_min_size(pos2(0.0, 0.0), vec2(1000.0, 600.0));
        View::of(area, &surfaces[0], surfaces.get(1), Side::Left, 72.0).expect("a view")
    }

    fn button(button: PointerButton, at: Pos2, pressed: bool, modifiers: Modifiers) -> Event {
        Event::PointerButton {
            pos: at,
            button,
            pressed,
            modifiers,
        }
    }

    fn drag(with: PointerButton, modifiers: Modifiers, from: Pos2, to: Pos2) -> Vec<Event> {
        vec![
            Event::PointerMoved(from),
            button(with, from, true, modifiers),
            Event::PointerMoved(from + 0.5 * (to - from)),
            Event::PointerMoved(to),
            button(with, to, false, modifiers),
            Event::PointerMoved(from),
        ]
    }

    #[test]
    fn the_middle_button_drags_what_lies_under_it() {
        let surfaces = PaintingSetup::default().scene().surfaces;
        let view = view(&surfaces);
        let (from, to) = (pos2(520.0, 300.0), pos2(570.0, 280.0));
        let held = view.on_desk(from);
        let first = SurfacePlacement::from(&surfaces[0])
            .pose
            .inverse()
            .point(held);
        let moves = placed(
            false,
            drag(PointerButton::Middle, Modifiers::NONE, from, to),
        );
        let (surface, last) = moves[moves.len() - 1];
        assert_eq!((moves.len(), surface), (2, CANVAS));
        let under = last.pose.inverse().point(view.on_desk(to));
        assert!((under - first).length() < 1e-9, "{under} {first}");
        // On the palette it is the palette that goes.
        let on_palette = view.to_window(DVec3::new(-0.15, 0.03, 0.0));
        let moves = placed(
            false,
            drag(PointerButton::Middle, Modifiers::NONE, on_palette, to),
        );
        assert!(moves.iter().all(|(surface, _)| *surface == PALETTE));
    }

    #[test]
    fn a_drag_goes_on_beyond_the_window_and_ends_where_another_one_has_the_keyboard() {
        let (from, to) = (pos2(520.0, 300.0), pos2(570.0, 280.0));
        let mut events = drag(PointerButton::Middle, Modifiers::NONE, from, to);
        let whole = placed(false, events.clone());
        events.insert(3, Event::PointerGone);
        assert_eq!(placed(false, events.clone()), whole);
        events[3] = Event::WindowFocused(false);
        assert_eq!(placed(false, events).len(), 1);
    }

    #[test]
    fn the_primary_button_is_the_brush_unless_it_is_in_the_other_hand() {
        let (from, to) = (pos2(520.0, 300.0), pos2(570.0, 280.0));
        let primary =
            |free, modifiers| placed(free, drag(PointerButton::Primary, modifiers, from, to));
        assert!(primary(false, Modifiers::NONE).is_empty());
        assert_eq!(primary(true, Modifiers::NONE).len(), 2);
        assert_eq!(primary(false, Modifiers::COMMAND).len(), 2);
        let [turn, tilt] = [Modifiers::SHIFT, Modifiers::ALT].map(|modifiers| {
            let moves = primary(false, Modifiers::COMMAND | modifiers);
            moves[moves.len() - 1].1
        });
        assert!(
            primary(false, Modifiers::SHIFT).is_empty(),
            "it paints a straight stroke"
        );
        let held = |free, key| {
            let mut events = drag(PointerButton::Primary, Modifiers::NONE, from, to);
            let down = Event::Key {
                key,
                physical_key: None,
                pressed: true,
                repeat: false,
                modifiers: Modifiers::NONE,
            };
            events.insert(0, down);
            placed(free, events)
        };
        assert!(held(true, Key::S).is_empty(), "it sets a width");
        let zoom = held(false, Key::Z).pop().expect("a place").1;
        assert!(turn.pose.vector(DVec3::X).y.abs() > 0.01 && turn.zoom == 1.0);
        assert!(tilt.pose.vector(DVec3::Z).y.abs() > 0.01 && tilt.zoom == 1.0);
        assert!(zoom.zoom > 1.02 && zoom.pose.rotation == Rigid::IDENTITY.rotation);
    }

    #[test]
    fn the_wheel_zooms_about_the_pointer_however_slow_the_scene_is() {
        let at = pos2(600.0, 200.0);
        let wheel = || Event::MouseWheel {
            unit: MouseWheelUnit::Line,
            delta: vec2(0.0, 1.0),
            phase: eframe::egui::TouchPhase::Move,
            modifiers: Modifiers::NONE,
            source: eframe::egui::MouseWheelSource::Wheel,
        };
        let surfaces = PaintingSetup::default().scene().surfaces;
        let view = view(&surfaces);
        let own = |lie: &SurfacePlacement| lie.pose.inverse().point(view.on_desk(at)) / lie.zoom;
        let moves = placed(false, [Event::PointerMoved(at), wheel(), wheel(), wheel()]);
        let last = moves[moves.len() - 1].1;
        assert!((last.zoom - exp(3.0 * WHEEL)).abs() < 1e-9, "{}", last.zoom);
        let first = SurfacePlacement::from(&surfaces[0]);
        assert!((own(&last) - own(&first)).length() < 1e-9);
        assert!(
            (own(&first.zoomed(DVec3::ZERO, 2.0)) - own(&first)).length() > 1e-3,
            "a fault"
        );
    }
}
