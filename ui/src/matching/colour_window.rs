//! A colour of the painter's choice, from a square or as hex, and nearby mixtures.

use std::sync::Arc;

use eframe::egui::ecolor::Hsva;
use eframe::egui::{Align2, Context, Id, Key, TextEdit, Ui, Window};
use maulstick_optics::colour::srgb_decode;

use crate::app::sides;
use crate::dialogs::wrong;
use crate::matching::colour_square;
use crate::matching::picker::{Ask, Picker, of_palette};
use crate::matching::proposals::{hex, matches, swatch};
use crate::widgets::context::PanelContext;

/// Width of the window's inside, points.
const WIDTH: f32 = 240.0;
/// Distance from the rack and from the upper edge when it opens, points.
const ASIDE: f32 = 40.0;

#[derive(Debug)]
pub(crate) struct ColourWindow {
    shown: bool,
    /// True until it has the keyboard, with which it opens.
    opens: bool,
    /// True if a control had the keyboard in the last frame.
    had_keyboard: bool,
    colour: Hsva,
    /// The field, while something else than the colour is written in it.
    typed: Option<String>,
    picker: Picker,
}

impl Default for ColourWindow {
    fn default() -> Self {
        Self {
            shown: false,
            opens: false,
            had_keyboard: false,
            colour: Hsva::from_srgb([138, 90, 60]),
            typed: None,
            picker: Picker::default(),
        }
    }
}

/// A colour as it is written on the web: `#8a5a3c`, also without the sign, or with three digits; `None` for another text.
fn parsed(text: &str) -> Option<[u8; 3]> {
    let text = text.trim();
    let digits = text.strip_prefix('#').unwrap_or(text);
    let values: Option<Vec<u8>> = digits
        .chars()
        .map(|digit| Some(digit.to_digit(16)? as u8))
        .collect();
    match values.as_deref() {
        Some([r, g, b]) => Some([r * 17, g * 17, b * 17]),
        Some([r, s, g, h, b, c]) => Some([r * 16 + s, g * 16 + h, b * 16 + c]),
        _ => None,
    }
}

impl ColourWindow {
    /// Shows or hides it.
    pub(crate) fn toggle(&mut self) {
        self.shown = !self.shown;
        self.opens = self.shown;
    }

    /// Shows it, if it is open.
    pub(crate) fn show(&mut self, context: &Context, work: &mut PanelContext<'_>) {
        if !self.shown {
            return;
        }
        let (corner, inward) = if work.preferences.window.left_handed {
            (Align2::LEFT_TOP, 1.0)
        } else {
            (Align2::RIGHT_TOP, -1.0)
        };
        let at = corner.pos_in_rect(&context.content_rect());
        let side = sides::rack_side(work.preferences);
        let beside =
            sides::rack_at(work.preferences, side) + sides::column_at(work.preferences, side);
        let aside = beside + ASIDE;
        let mut open = true;
        // The first Escape leaves the field.
        let had_keyboard = std::mem::replace(
            &mut self.had_keyboard,
            context.memory(|memory| memory.focused().is_some()),
        );
        Window::new(tr!("A colour in mind"))
            .id(Id::unique("colour"))
            .open(&mut open)
            .collapsible(false)
            .resizable(false)
            .default_width(WIDTH)
            .pivot(corner)
            .default_pos([at.x + inward * aside, at.y + ASIDE])
            .show(context, |ui| {
                ui.set_width(WIDTH);
                self.choice(ui);
                ui.separator();
                self.proposals(ui, work);
            });
        let nothing_focused = context.memory(|memory| memory.focused().is_none());
        let leaves = nothing_focused
            && !had_keyboard
            && context.input(|input| input.key_pressed(Key::Escape));
        self.shown = open && !leaves;
    }

    /// The square, and the colour as text.
    fn choice(&mut self, ui: &mut Ui) {
        if colour_square::show(ui, &mut self.colour) {
            self.typed = None;
        }
        ui.horizontal(|ui| {
            let bytes = self.colour.to_srgb();
            swatch(ui, bytes, tr!("The colour"));
            let label = ui.label(tr!("Hex"));
            let mut text = self.typed.clone().unwrap_or_else(|| hex(bytes));
            let edit = TextEdit::singleline(&mut text)
                .char_limit(16)
                .desired_width(80.0);
            let field = ui.add(edit).labelled_by(label.id);
            if std::mem::take(&mut self.opens) {
                field.request_focus();
            }
            if field.changed() {
                if let Some(bytes) = parsed(&text) {
                    self.colour = Hsva::from_srgb(bytes);
                }
                self.typed = Some(text);
            }
            if field.lost_focus() && self.typed.as_deref().and_then(parsed).is_some() {
                self.typed = None;
            }
        });
        if let Some(text) = self.typed.as_deref().filter(|text| parsed(text).is_none()) {
            let words = tr!(
                "“{text}” is no colour. Write six digits of 0 to 9 and a to f, such as #8a5a3c.",
                text = text.trim()
            );
            ui.colored_label(wrong(ui.visuals()), words);
        }
    }

    /// The mixtures, searched for while nothing is dragged.
    fn proposals(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let all = &mut work.preferences.reference.all_paints;
        ui.checkbox(all, tr!("All paints"))
            .on_hover_text(tr!("Not only those on the palette"));
        let paints = if *all {
            None
        } else {
            of_palette(work.rig.live.palette())
        };
        let is_dragged = ui.ctx().egui_is_using_pointer();
        if let Some(scene) = work.rig.live.scene.as_ref().filter(|_| !is_dragged) {
            let bytes = self.colour.to_srgb();
            self.picker.ask(Ask {
                linear: bytes.map(|byte| srgb_decode(f64::from(byte) / 255.0)),
                paints,
                light: scene.light.clone(),
            });
        }
        let library = Arc::clone(&work.rig.library);
        let found = self.picker.found(ui.ctx(), &library).cloned();
        matches(ui, found.as_ref(), work);
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::Modifiers;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;
    use maulstick_painting::edits::Load;

    use super::*;
    use crate::test_support::overlay_bench::{Bench, ctrl, picture, until, window, write};

    fn mixed(harness: &mut Harness<'static, Bench>) {
        until(harness, |harness| {
            harness.query_all_by_label_contains("Load ").count() == 3
        });
    }

    #[test]
    fn it_opens_with_the_keyboard_and_escape_gives_that_back_and_then_closes_it() {
        let mut harness = window(None);
        ctrl(&mut harness, Key::M, Modifiers::NONE);
        assert!(harness.get_by_label("Hex").is_focused());
        for stays in [true, false] {
            harness.key_press(Key::Escape);
            harness.run_steps(3);
            assert_eq!(harness.query_by_label("Hex").is_some(), stays);
        }
    }

    #[test]
    fn colours_are_read_as_they_are_written_on_the_web() {
        for text in ["#8a5a3c", "8A5A3C", " #8a5a3c "] {
            assert_eq!(parsed(text), Some([0x8a, 0x5a, 0x3c]), "{text}");
        }
        assert_eq!(parsed("#fa0"), Some([255, 170, 0]));
        for text in [
            "", "#", "#12", "#8a5a3", "#8a5a3g", "#8a5a3c0", "brown", "é€",
        ] {
            assert_eq!(parsed(text), None, "{text}");
        }
    }

    #[test]
    fn a_colour_that_is_written_becomes_a_mixture_on_the_brush() {
        let mut harness = window(None);
        ctrl(&mut harness, Key::M, Modifiers::NONE);
        mixed(&mut harness);
        write(&mut harness, "Hex", "#zz");
        harness.get_by_label_contains("“#zz” is no colour");
        write(&mut harness, "Hex", "#96b4cd");
        assert!(harness.query_by_label_contains("is no colour").is_none());
        assert_eq!(
            harness.query_all_by_label_contains("Load ").count(),
            0,
            "those were of the old colour"
        );
        mixed(&mut harness);
        let nearest = harness.query_all_by_label_contains("Load ").next();
        nearest.expect("a mixture").click();
        harness.run_steps(3);
        let asked = harness.state_mut().asked();
        let [(_, command)] = &asked[..] else {
            panic!("{asked:?}");
        };
        let Load { mixture, .. } = command.edit().expect("a load");
        let names = of_palette(harness.state().rig.live.palette()).expect("paints");
        assert!(mixture.parts.iter().all(|part| names.contains(&part.paint)));
        ctrl(&mut harness, Key::M, Modifiers::NONE);
        assert!(harness.query_by_label("Hex").is_none());
    }

    #[test]
    fn it_looks_as_in_its_picture() {
        struct Wall {
            window: ColourWindow,
            bench: crate::test_support::context_bench::Bench,
        }
        let wall = || Wall {
            window: ColourWindow {
                shown: true,
                ..ColourWindow::default()
            },
            bench: crate::test_support::context_bench::Bench::new(),
        };
        picture(
            "colour",
            [360.0, 440.0],
            wall,
            |ui, wall| wall.window.show(ui.ctx(), &mut wall.bench.work()),
            |harness| {
                until(harness, |harness| {
                    harness.query_all_by_label_contains("Load ").count() == 3
                });
            },
            |wall| wall.window.shown = false,
        );
    }
}
