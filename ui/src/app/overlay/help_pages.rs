//! Pages of help: a first painting in seven steps, and about the program.

use std::fmt::Display;

use eframe::egui::{Align2, Context, Frame, Grid, Margin, RichText, ScrollArea, Ui, Window};

use maulstick_ui_kit::language::{filled, translated};

use crate::input::keys::Action;
use crate::widgets::context::PanelContext;

/// Width of a page, points.
const WIDTH: f32 = 420.0;
/// Height of a page's frame and title, points.
const HEAD: f32 = 80.0;

/// The pages; none is open at first.
#[derive(Debug, Default)]
pub(crate) struct HelpPages {
    steps: bool,
    about: bool,
}

impl HelpPages {
    /// Shows or hides the page of an action; false if it is none of these.
    pub(crate) fn follow(&mut self, act: Action) -> bool {
        let page = match act {
            Action::Tutorial => &mut self.steps,
            Action::About => &mut self.about,
            _ => return false,
        };
        *page = !*page;
        true
    }

    /// Shows what is open.
    pub(crate) fn show(&mut self, context: &Context, work: &PanelContext<'_>) {
        let window = |title: &str| {
            Window::new(title)
                .collapsible(false)
                .resizable(false)
                .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        };
        let steps = window(tr!("A first painting")).open(&mut self.steps);
        steps.show(context, |ui| {
            let height = context.content_rect().height() - HEAD;
            ScrollArea::vertical().max_height(height).show(ui, |ui| {
                ui.set_width(WIDTH.min(context.content_rect().width() - HEAD));
                steps_of(ui, work);
            });
        });
        let about = window(tr!("About Maulstick")).open(&mut self.about);
        about.show(context, |ui| {
            ui.set_width(WIDTH.min(context.content_rect().width() - HEAD));
            about_it(ui, work);
        });
    }
}

/// Title and text of a step; the places of its text are keys.
type Step = (
    &'static str,
    &'static str,
    &'static [(&'static str, Action)],
);

/// A first painting.
const STEPS: [Step; 7] = [
    (
        tr_noop!("Take paint"),
        tr_noop!(
            "{clean} cleans the brush. Drag it twice through a heap of the palette, from one side to the other."
        ),
        &[("clean", Action::Clean)],
    ),
    (
        tr_noop!("Mix"),
        tr_noop!(
            "Rub two paints together on the free middle of the palette; {palette} slides it out. {scrape} scrapes it clean."
        ),
        &[("palette", Action::Palette), ("scrape", Action::Scrape)],
    ),
    (
        tr_noop!("step|Paint"),
        tr_noop!(
            "Drag over the canvas. A stroke thins as the brush runs out: {load} loads it with the mixture under it. {smaller} and {larger} set its width, {next} takes the next brush."
        ),
        &[
            ("load", Action::LoadFrom),
            ("smaller", Action::Smaller),
            ("larger", Action::Larger),
            ("next", Action::NextBrush),
        ],
    ),
    (
        tr_noop!("Wipe and undo"),
        tr_noop!(
            "Hold {clean} while you paint to wipe wet paint off. {undo} takes back the last step."
        ),
        &[("clean", Action::Clean), ("undo", Action::Undo)],
    ),
    (
        tr_noop!("Dry"),
        tr_noop!(
            "{dry} dries the canvas. What you paint next lies on top and does not mix with it."
        ),
        &[("dry", Action::Dry)],
    ),
    (
        tr_noop!("Glaze"),
        tr_noop!(
            "{panels} shows the panels. Take the preset Glaze in the panel Brush, hold the brush over a mixture and press {load}: what is dry shines through the thin film."
        ),
        &[("panels", Action::Panels), ("load", Action::LoadFrom)],
    ),
    (
        tr_noop!("Keep it and show it"),
        tr_noop!("{save} keeps the painting in a file, {export} exports a picture."),
        &[("save", Action::Save), ("export", Action::Export)],
    ),
];

/// The steps, with the painter's keys.
fn steps_of(ui: &mut Ui, work: &PanelContext<'_>) {
    for (number, (title, text, acts)) in STEPS.into_iter().enumerate() {
        let keys = acts
            .iter()
            .map(|(_, act)| work.preferences.keys.written(ui.ctx(), *act));
        let keys: Vec<String> = keys.collect();
        let places = acts.iter().zip(&keys);
        let places: Vec<(&str, &dyn Display)> = places
            .map(|((name, _), key)| (*name, key as &dyn Display))
            .collect();
        let title = format!("{} · {}", number + 1, translated(title));
        let frame = Frame::NONE.inner_margin(Margin::symmetric(0, 3));
        frame.show(ui, |ui| {
            ui.label(RichText::new(title).strong());
            ui.label(filled(text, &places));
        });
    }
}

/// Version, licence, and backend of the paint.
fn about_it(ui: &mut Ui, work: &PanelContext<'_>) {
    ui.label(tr!(
        "Oil paint and brushes, computed from what was measured of them."
    ));
    ui.add_space(6.0);
    let backend = work
        .rig
        .live
        .paint
        .as_ref()
        .map(|node| &*node.status.backend);
    let rows = [
        (tr!("Version"), env!("CARGO_PKG_VERSION")),
        (tr!("Licence"), env!("CARGO_PKG_LICENSE")),
        (tr!("Paint computed on"), backend.unwrap_or("–")),
    ];
    Grid::new("about").num_columns(2).show(ui, |ui| {
        for (word, value) in rows {
            ui.weak(word);
            ui.label(value);
            ui.end_row();
        }
        ui.weak(tr!("Home"));
        ui.hyperlink(env!("CARGO_PKG_REPOSITORY"));
        ui.end_row();
    });
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Key, Modifiers};
    use egui_kittest::kittest::Queryable as _;

    use super::STEPS;
    use crate::test_support::overlay_bench::{ctrl, window};

    /// True if the places of a text are those that keys are given for.
    fn fits(text: &str, keys: &[&str]) -> bool {
        let parts = text
            .split('{')
            .skip(1)
            .filter_map(|part| part.split_once('}'));
        parts.map(|(place, _)| place).eq(keys.iter().copied())
    }

    #[test]
    fn each_step_has_a_key_for_each_of_its_places() {
        for (title, text, acts) in STEPS {
            let keys: Vec<_> = acts.iter().map(|(place, _)| *place).collect();
            assert!(fits(text, &keys), "{title}: {keys:?}");
        }
        assert!(
            !fits("{claen} cleans the brush.", &["clean"]),
            "a fault passes"
        );
    }

    #[test]
    fn help_has_a_first_painting_and_what_program_this_is() {
        let mut harness = window(None);
        ctrl(&mut harness, Key::F1, Modifiers::NONE);
        harness.get_by_label(env!("CARGO_PKG_VERSION"));
        ctrl(&mut harness, Key::F1, Modifiers::NONE);
        assert!(harness.query_by_label(env!("CARGO_PKG_VERSION")).is_none());
        harness.key_press_modifiers(Modifiers::SHIFT, Key::F1);
        harness.run_steps(3);
        harness.get_by_label_contains("1 · ");
        harness.get_by_label_contains("7 · ");
    }
}
