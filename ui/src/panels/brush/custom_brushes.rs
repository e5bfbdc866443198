//! The painter's own brush files in the rack.

use std::path::PathBuf;

use eframe::egui::{Button, Key, TextEdit, Ui};
use maulstick_ui_kit::rows::row;

use super::entry;
use crate::render::brush::icon_cache;
use crate::widgets::context::PanelContext;

#[derive(Debug, Default)]
pub(super) struct OwnBrushes {
    path: String,
}

impl OwnBrushes {
    pub(super) fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        ui.label(tr!("A brush file (.toml, .glb) joins the rack."));
        let edit = TextEdit::singleline(&mut self.path)
            .hint_text("/home/me/brushes/rake.toml")
            .desired_width(f32::INFINITY);
        let shown = row(ui, tr!("File"), |ui| ui.add(edit))
            .on_hover_text(tr!("Where the brush file lies."));
        let enter = shown.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let is_given = !self.path.trim().is_empty();
        let add = ui.add_enabled(is_given, Button::new(tr!("Add to the rack")));
        if is_given
            && (add.clicked() || enter)
            && add_file(ui, work, PathBuf::from(self.path.trim()))
        {
            self.path.clear();
        }
        let mut gone = None;
        for (place, path) in work.preferences.brushes.own_brushes.iter().enumerate() {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let left = |ui: &mut Ui| {
                ui.add(eframe::egui::Label::new(&*name).truncate())
                    .on_hover_text(path.display().to_string());
            };
            let right = |ui: &mut Ui| {
                let button = ui.small_button(tr!("Remove"));
                let hover = tr!("Takes {name} off the rack; the file stays.", name);
                if button.on_hover_text(hover).clicked() {
                    gone = Some(place);
                }
            };
            entry(ui, left, right);
        }
        if let Some(place) = gone {
            work.preferences.brushes.own_brushes.remove(place);
        }
    }
}

/// Puts a brush file into the rack and the brush into the hand; false if the file is invalid, with a notification.
fn add_file(ui: &Ui, work: &mut PanelContext<'_>, path: PathBuf) -> bool {
    icon_cache::forget(ui.ctx(), &path);
    match icon_cache::own(ui.ctx(), &path) {
        Ok(file) => {
            work.preferences
                .brushes
                .own_brushes
                .retain(|known| *known != path);
            work.preferences.brushes.own_brushes.push(path);
            work.take_up((*file).clone());
            true
        }
        Err(fault) => {
            work.notifications.of(&fault);
            false
        }
    }
}
