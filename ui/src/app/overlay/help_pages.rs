//! Pages of help: a first painting in seven steps, and about the program.

use eframe::egui::{Align2, Context, Frame, Grid, Margin, RichText, ScrollArea, Ui, Window};

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

/// The steps, with the painter's keys.
fn steps_of(ui: &mut Ui, work: &PanelContext<'_>) {
    let key = |act: Action| work.preferences.keys.written(ui.ctx(), act);
    let steps = [
        (
            tr!("Take paint"),
            tr!(
                "{clean} cleans the brush. Drag it twice through a heap of the palette, from one side to the other.",
                clean = key(Action::Clean)
            ),
        ),
        (
            tr!("Mix"),
            tr!(
                "Rub two paints together on the free middle of the palette; {palette} slides it out. {scrape} scrapes it clean.",
                palette = key(Action::Palette),
                scrape = key(Action::Scrape)
            ),
        ),
        (
            tr!("step|Paint"),
            tr!(
                "Drag over the canvas. A stroke thins as the brush runs out: {load} loads it with the mixture under it. {smaller} and {larger} set its width, {next} takes the next brush.",
                load = key(Action::LoadFrom),
                smaller = key(Action::Smaller),
                larger = key(Action::Larger),
                next = key(Action::NextBrush)
            ),
        ),
        (
            tr!("Wipe and undo"),
            tr!(
                "Hold {clean} while you paint to wipe wet paint off. {undo} takes back the last step.",
                clean = key(Action::Clean),
                undo = key(Action::Undo)
            ),
        ),
        (
            tr!("Dry"),
            tr!(
                "{dry} dries the canvas. What you paint next lies on top and does not mix with it.",
                dry = key(Action::Dry)
            ),
        ),
        (
            tr!("Glaze"),
            tr!(
                "{panels} shows the panels. Take the preset Glaze in the panel Brush, hold the brush over a mixture and press {load}: what is dry shines through the thin film.",
                panels = key(Action::Panels),
                load = key(Action::LoadFrom)
            ),
        ),
        (
            tr!("Keep it and show it"),
            tr!(
                "{save} keeps the painting in a file, {export} exports a picture.",
                save = key(Action::Save),
                export = key(Action::Export)
            ),
        ),
    ];
    for (number, (title, text)) in steps.into_iter().enumerate() {
        let frame = Frame::NONE.inner_margin(Margin::symmetric(0, 3));
        frame.show(ui, |ui| {
            ui.label(RichText::new(format!("{} · {title}", number + 1)).strong());
            ui.label(text);
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

    use crate::test_support::overlay_bench::{ctrl, window};

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
