//! Table of all keys, under a picture of the most used ones.

use eframe::egui::{self, Align, Align2, Context, Layout, Ui};
use maulstick_ui_kit::language::translated;

use crate::input::keymap::Keymap;
use crate::input::keys;
use crate::widgets::key_picture;

/// Height of the table of keys beyond its list, points, and width of the picture over it.
const HEAD: f32 = 80.0;
const PICTURE: f32 = 480.0;

/// Shows the table; `is_open` becomes false once the painter closes it.
pub(super) fn show(context: &Context, keymap: &Keymap, is_open: &mut bool) {
    egui::Window::new(tr!("Keys"))
        .open(is_open)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        .show(context, |ui| {
            let height = context.content_rect().height() - HEAD;
            let list = egui::ScrollArea::vertical()
                .max_height(height)
                .min_scrolled_height(height);
            list.show(ui, |ui| {
                let colour = ui.visuals().text_color();
                key_picture::show(ui, keymap, PICTURE, colour);
                ui.separator();
                egui::Grid::new("keys")
                    .num_columns(2)
                    .striped(true)
                    .show(ui, |ui| {
                        for (binding, key) in keymap.bindings() {
                            // Actions without a key are in the menu, and in the settings.
                            if let Some(key) = key {
                                key_row(ui, &keys::written(context, &key), binding.words);
                            }
                        }
                        for (keys, words) in keys::HELD {
                            key_row(ui, translated(keys), words);
                        }
                    });
            });
        });
}

/// A row of the table of keys: a key at the right of its column, beside its action.
fn key_row(ui: &mut Ui, key: &str, words: &str) {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.monospace(key));
    ui.label(translated(words));
    ui.end_row();
}
