//! Width of the brush by dragging: while its key is held, the pressed pointer makes it wider to the right, narrower to the left.

use eframe::egui::{
    Color32, Context, Event, FontId, Id, LayerId, Order, PointerButton, Pos2, Rect, vec2,
};

use maulstick_num::exp;

use crate::input::brush_choice::widths_mm;
use crate::input::keys::Action;
use crate::input::navigation::is_panel;
use crate::input::presses;
use crate::settings::brush_library::called;
use crate::widgets::context::PanelContext;

/// Distance of a drag that multiplies the brush's width by e, points.
const FAR: f32 = 160.0;

/// A drag in progress.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Drag {
    from: Pos2,
    from_mm: f64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SizeDrag {
    drag: Option<Drag>,
}

impl SizeDrag {
    /// Follows the pointer, and shows the width beside it; the brush is changed where the pointer is let go.
    pub(crate) fn follow(&mut self, context: &Context, work: &mut PanelContext<'_>) {
        let (at, pressed, is_down) = context.input(|input| {
            let pressed = input.events.iter().enumerate().find_map(|(place, event)| {
                let Event::PointerButton {
                    pos,
                    button: PointerButton::Primary,
                    pressed: true,
                    ..
                } = event
                else {
                    return None;
                };
                let holds = presses::holds(input, &work.preferences.keys, place);
                (holds == Some(Action::Size)).then_some(*pos)
            });
            let pointer = &input.pointer;
            (pointer.latest_pos(), pressed, pointer.primary_down())
        });
        let (Some(at), Some(file)) = (at, work.in_hand()) else {
            self.drag = None;
            return;
        };
        if let Some(from) = pressed.filter(|from| !is_panel(context, *from)) {
            self.drag = Some(Drag {
                from,
                from_mm: file.head.width_mm,
            });
        }
        let Some(Drag { from, from_mm }) = self.drag else {
            return;
        };
        let range = widths_mm(file);
        let times = exp(f64::from((at.x - from.x) / FAR));
        // To a tenth of a millimetre, as the panel has it.
        let width_mm = (10.0 * from_mm * times).round() / 10.0;
        let width_mm = width_mm.clamp(*range.start(), *range.end());
        if is_down {
            let words = format!(
                "{} {}",
                called(&file.kind),
                work.preferences.window.units.width(width_mm)
            );
            tell(context, from, &words);
        } else {
            self.drag = None;
            work.widen(width_mm);
        }
    }
}

/// Words over the desk, above a point of it.
fn tell(context: &Context, at: Pos2, words: &str) {
    let painter = context.layer_painter(LayerId::new(Order::Tooltip, Id::unique("size")));
    let galley =
        painter.layout_no_wrap(words.to_owned(), FontId::proportional(15.0), Color32::WHITE);
    let size = galley.size() + vec2(16.0, 8.0);
    let room = context.content_rect();
    let centre = at - vec2(0.0, 28.0);
    let low = room.min + 0.5 * size;
    let high = room.max - 0.5 * size;
    let place = Rect::from_center_size(centre.clamp(low, high.max(low)), size);
    painter.rect_filled(place, 6.0, Color32::from_black_alpha(200));
    painter.galley(place.center() - 0.5 * galley.size(), galley, Color32::WHITE);
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Event, Key, Modifiers, PointerButton, pos2};
    use maulstick_types::command::{BrushCommand, Command};

    use crate::settings::brush_library::of_library;
    use crate::test_support::overlay_bench::window;

    /// Widths requested by a drag to the right, points, with S held or not.
    fn dragged(by: f32, held: bool) -> Vec<f64> {
        let mut harness = window(None);
        let file = of_library("round").expect("round").clone();
        let text = file.to_toml().expect("written");
        harness.state_mut().rig.brushes[0].file = Some((file, text));
        if held {
            harness.key_down(Key::S);
        }
        let from = pos2(300.0, 350.0);
        let button = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        harness.event(Event::PointerMoved(from));
        harness.event(button(from, true));
        harness.run_steps(2);
        let to = pos2(from.x + by, from.y + 30.0);
        harness.event(Event::PointerMoved(to));
        harness.run_steps(2);
        harness.event(button(to, false));
        harness.run_steps(2);
        let asked = harness.state_mut().asked().into_iter();
        let width = |(_, command)| match command {
            Command::Brush(BrushCommand::Define { toml, .. }) => {
                let file = maulstick_brush::BrushFile::parse(toml.as_str()).expect("a brush");
                Some(file.head.width_mm)
            }
            _ => None,
        };
        asked.filter_map(width).collect()
    }

    #[test]
    fn to_the_right_it_gets_wider_to_the_left_narrower_and_not_without_end() {
        let widths = [-80.0, 80.0, 5000.0].map(|by| dragged(by, true));
        let [narrow, wide, widest] = widths.map(|own| match own[..] {
            [width] => width,
            _ => panic!("asked once: {own:?}"),
        });
        assert!(narrow < wide && wide < widest, "{narrow} {wide} {widest}");
        assert!(
            (2.6..2.85).contains(&(wide / narrow)),
            "e times: {narrow} {wide}"
        );
        assert!(widest < 150.0, "{widest}");
        assert_eq!(dragged(80.0, false), [0.0; 0], "a fault would pass");
    }
}
