//! A field for a mixture, with names of paints that complete what is typed.

use eframe::egui::{Key, Response, TextEdit, Ui};
use maulstick_optics::PaintLibrary;
use maulstick_rig::UserError;
use maulstick_ui_kit::rows::{row, wrong};

use crate::settings::brush_load::{completed, completions};

/// Names that are proposed at most.
const PROPOSED: usize = 4;

/// Shows the field of a mixture; true if Enter was pressed in it.
pub(crate) fn show(
    ui: &mut Ui,
    (word, hover): (&str, &str),
    text: &mut String,
    library: &PaintLibrary,
) -> (Response, bool) {
    let edit = TextEdit::singleline(text)
        .hint_text("2 Cobalt Blue, 1 …")
        .char_limit(4096)
        .desired_width(f32::INFINITY);
    let shown = row(ui, word, |ui| ui.add(edit)).on_hover_text(hover);
    let enter = shown.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    let names = completions(text, library, PROPOSED);
    if !names.is_empty() {
        ui.horizontal_wrapped(|ui| {
            ui.add_space(8.0);
            for proposed in names {
                if ui.small_button(proposed).clicked() {
                    *text = completed(text, proposed);
                    shown.request_focus();
                }
            }
        });
    }
    (shown, enter)
}

/// What is wrong with a mixture, and what to do.
pub(crate) fn fault(ui: &mut Ui, fault: &UserError) {
    wrong(ui, &*fault.what);
    if let Some(help) = &fault.help {
        ui.label(&**help);
    }
}
