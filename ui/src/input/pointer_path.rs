//! Path of the pointer over the desk, and where its button presses the brush.

use eframe::egui::{Event, InputState, PointerButton, Pos2};

use crate::input::keymap::Keymap;
use crate::input::presses;
use crate::input::ruler::Ruler;

/// A place of the pointer, and whether its button presses the brush there.
pub(crate) type Place = (Pos2, bool);

/// The pointer as the hand that paints.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PointerPath {
    pressed: bool,
    ruler: Ruler,
}

impl PointerPath {
    /// True while the button presses the brush.
    #[must_use]
    pub(crate) fn is_pressed(&self) -> bool {
        self.pressed
    }

    /// Ends a stroke: something else has the pointer.
    pub(crate) fn lift(&mut self) {
        *self = Self::default();
    }

    /// The places of a frame, in order; `on_desk` is true of a point of the window where the desk is not covered. Each
    /// press counts at its own place: a frame may contain one on the desk and a path from there that ends over a panel.
    /// A stroke continues over panels, and ends where the button is released.
    pub(crate) fn follow(
        &mut self,
        input: &InputState,
        keymap: &Keymap,
        on_desk: impl Fn(Pos2) -> bool,
    ) -> Vec<Place> {
        let mut places = Vec::new();
        for (number, event) in input.events.iter().enumerate() {
            match event {
                Event::PointerMoved(at) => places.extend(self.place(*at, &on_desk)),
                Event::PointerButton {
                    pos,
                    button: PointerButton::Primary,
                    pressed,
                    modifiers,
                } => {
                    let straight = modifiers.shift_only();
                    // With another modifier or key it moves the canvas or sets a width.
                    let is_brush = (modifiers.is_none() || straight)
                        && presses::holds(input, keymap, number).is_none();
                    let presses = *pressed && is_brush && on_desk(*pos);
                    if presses && straight {
                        self.ruler.lay(*pos);
                    }
                    let was_pressed = std::mem::replace(&mut self.pressed, presses);
                    let at = self.ruler.nearest(*pos);
                    if was_pressed || on_desk(at) {
                        places.push((at, presses));
                    }
                    if !presses {
                        self.ruler.lift();
                    }
                }
                _ => {}
            }
        }
        // A still pointer is still there.
        if places.is_empty() {
            let latest = input.pointer.latest_pos();
            places.extend(latest.and_then(|at| self.place(at, &on_desk)));
        }
        places
    }

    fn place(&mut self, at: Pos2, on_desk: impl Fn(Pos2) -> bool) -> Option<Place> {
        let at = self.ruler.nearest(at);
        (self.pressed || on_desk(at)).then_some((at, self.pressed))
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Key, Modifiers, pos2};

    use super::*;

    /// Left edge of the panel.
    const PANEL: f32 = 500.0;

    fn on_desk(at: Pos2) -> bool {
        at.x < PANEL
    }

    fn button(x: f32, pressed: bool, modifiers: Modifiers) -> Event {
        Event::PointerButton {
            pos: pos2(x, 100.0),
            button: PointerButton::Primary,
            pressed,
            modifiers,
        }
    }

    fn moved(x: f32) -> Event {
        Event::PointerMoved(pos2(x, 100.0))
    }

    fn input(events: &[Event]) -> InputState {
        let mut input = InputState::default();
        input.events = events.to_vec();
        input
    }

    /// Places of frames with these events: how far to the right, and whether pressed.
    fn followed(frames: &[&[Event]]) -> Vec<(f32, bool)> {
        let mut path = PointerPath::default();
        let mut places = Vec::new();
        for events in frames {
            places.extend(path.follow(&input(events), &Keymap::default(), on_desk));
        }
        places
            .into_iter()
            .map(|(at, pressed)| (at.x, pressed))
            .collect()
    }

    const NONE: Modifiers = Modifiers::NONE;

    #[test]
    fn a_press_counts_where_it_falls_though_the_frame_ends_over_a_panel() {
        let whole = followed(&[&[
            moved(400.0),
            button(400.0, true, NONE),
            moved(450.0),
            moved(600.0),
            button(600.0, false, NONE),
            moved(610.0),
        ]]);
        let expected = [
            (400.0, false),
            (400.0, true),
            (450.0, true),
            (600.0, true),
            (600.0, false),
        ];
        assert_eq!(whole, expected, "it lifts where it is let go");
        let on_panel = followed(&[&[button(600.0, true, NONE), moved(400.0)]]);
        assert_eq!(on_panel, [(400.0, false)], "a panel's press is its own");
    }

    #[test]
    fn a_key_counts_for_the_press_before_which_it_was_held_however_much_a_frame_holds() {
        let key = |pressed| Event::Key {
            key: Key::S,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: NONE,
        };
        let stroke = [
            button(400.0, true, NONE),
            moved(420.0),
            button(420.0, false, NONE),
        ];
        let around = [&[key(true)][..], &stroke, &[key(false)]].concat();
        let before = [&[key(true), key(false)][..], &stroke].concat();
        let presses = |events: &[Event]| {
            let places = followed(&[events]);
            places.iter().filter(|(_, pressed)| *pressed).count()
        };
        assert_eq!((presses(&around), presses(&before)), (0, 2));
    }

    #[test]
    fn frames_cut_no_stroke() {
        let events = [
            button(400.0, true, NONE),
            moved(420.0),
            moved(620.0),
            button(620.0, false, NONE),
        ];
        let one_each: Vec<&[Event]> = events.iter().map(std::slice::from_ref).collect();
        assert_eq!(followed(&one_each), followed(&[&events]));
    }

    #[test]
    fn with_a_modifier_it_does_not_paint_but_shift_lays_a_ruler() {
        for modifiers in [Modifiers::COMMAND, Modifiers::ALT] {
            let places = followed(&[&[button(100.0, true, modifiers), moved(200.0)]]);
            assert!(places.iter().all(|(_, pressed)| !pressed), "{modifiers:?}");
        }
        let mut path = PointerPath::default();
        let bent = Event::PointerMoved(pos2(200.0, 140.0));
        let events = [button(100.0, true, Modifiers::SHIFT), moved(150.0), bent];
        let places = path.follow(&input(&events), &Keymap::default(), on_desk);
        assert_eq!(places[2], (pos2(200.0, 100.0), true), "along the ruler");
    }
}
