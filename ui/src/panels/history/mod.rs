//! History panel: undo, redo and versions.
//!
//! | module | holds |
//! | --- | --- |
//! | `tree` | versions as a tree |

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align, Button, Color32, ColorImage, CornerRadius, Key, Layout, Rect, Response, RichText, Sense,
    TextEdit, TextureHandle, TextureOptions, Ui, WidgetInfo, pos2, vec2,
};
use maulstick_types::edits::{Branch, Forget, Keep, Redo, ReturnTo, Undo};
use maulstick_types::scene::NamedVersion;
use maulstick_types::values::VersionName;

use crate::input::keys::Action;
use crate::panels::Panel;
use crate::rig::thumbnails::Picture;
use crate::widgets::context::PanelContext;
use crate::widgets::rows::{ask, note};

mod tree;

/// Width and height of a small picture, points.
const PICTURE: [f32; 2] = [60.0, 48.0];
/// Indent of a version below its parent, points; and the largest indent.
const INWARD: f32 = 12.0;
const MOST_INWARD: usize = 5;

/// The panel.
#[derive(Default)]
pub(crate) struct HistoryPanel {
    /// Name of the next version.
    name: String,
    /// The version from which another one begins, and its name.
    branching: Option<(String, String)>,
    /// The version whose deletion is to be confirmed.
    forgetting: Option<String>,
    textures: BTreeMap<String, (Arc<Picture>, TextureHandle)>,
}

impl Panel for HistoryPanel {
    fn title(&self) -> &'static str {
        "History"
    }

    fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        steps(ui, work);
        self.keep(ui, work);
        let Some(scene) = &work.rig.scene else {
            return;
        };
        let versions = scene.versions.clone();
        let names = || versions.iter().map(|version| version.name.as_str());
        work.rig.thumbnails.keep(names());
        self.textures
            .retain(|name, _| names().any(|known| known == name));
        if versions.is_empty() {
            note(ui, "Keep a version, and you can come back to it.");
        }
        for (depth, version) in tree::in_order(&versions) {
            ui.push_id(&version.name, |ui| self.version(ui, work, depth, version));
        }
    }
}

/// Undo and redo, and how many steps there are.
fn steps(ui: &mut Ui, work: &mut PanelContext<'_>) {
    let status = work.rig.paint.as_ref().map(|paint| &paint.status);
    let (undo, redo) = status.map_or((0, 0), |status| (status.undo, status.redo));
    ui.horizontal(|ui| {
        let step = |ui: &mut Ui, word: &str, count: u32, hover: &str| {
            let button = ui.add_enabled(count > 0, Button::new(format!("{word} ({count})")));
            button.on_hover_text(hover).clicked()
        };
        let keys = &work.preferences.keys;
        let back = keys.hint(ui.ctx(), "The newest step back", &[Action::Undo]);
        let again = keys.hint(ui.ctx(), "What was undone, again", &[Action::Redo]);
        if step(ui, "Undo", undo, &back) {
            ask(work, Ok(Undo { brush: None }));
        }
        if step(ui, "Redo", redo, &again) {
            ask(work, Ok(Redo { brush: None }));
        }
    });
}

/// A field for a name with a button; `true` where the painter is done.
fn naming(ui: &mut Ui, name: &mut String, label: &str, word: &str) -> (Response, bool) {
    let mut done = false;
    let field = ui
        .horizontal(|ui| {
            let width = ui.available_width() - 72.0;
            let field = TextEdit::singleline(name).hint_text(label);
            let field = ui.add(field.desired_width(width));
            let text = name.clone();
            field.widget_info(|| WidgetInfo {
                current_text_value: Some(text.clone()),
                ..WidgetInfo::labeled(Role::TextInput, true, label)
            });
            let button = ui.add_enabled(!name.trim().is_empty(), Button::new(word));
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            done = !name.trim().is_empty() && (button.clicked() || entered);
            field
        })
        .inner;
    (field, done)
}

impl HistoryPanel {
    /// Keeps the painting as it is.
    fn keep(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let (_, done) = naming(ui, &mut self.name, "Name of a version", "Keep");
        if done {
            let name = VersionName::new(self.name.trim());
            if ask(work, name.map(|name| Keep { name })) {
                self.name.clear();
            }
        }
    }

    /// The row of a version.
    fn version(
        &mut self,
        ui: &mut Ui,
        work: &mut PanelContext<'_>,
        depth: usize,
        version: &NamedVersion,
    ) {
        let name = &version.name;
        ui.horizontal(|ui| {
            ui.add_space(INWARD * depth.min(MOST_INWARD) as f32);
            self.picture(ui, work, name);
            ui.with_layout(Layout::top_down(Align::Min), |ui| {
                ui.horizontal(|ui| {
                    let title = match version.here {
                        true => RichText::new(name).strong(),
                        false => RichText::new(name),
                    };
                    ui.add(eframe::egui::Label::new(title).truncate());
                    if version.here {
                        ui.label(RichText::new("here").small())
                            .on_hover_text("What is painted now goes on from this version");
                    }
                });
                ui.horizontal(|ui| self.buttons(ui, work, name));
            });
        });
        self.branch(ui, work, name);
    }

    fn buttons(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, name: &str) {
        if self.forgetting.as_deref() == Some(name) {
            ui.label("Delete?");
            let yes = small(
                ui,
                "Yes",
                &format!("Delete {name}"),
                "It cannot be had back",
            );
            if yes.clicked() {
                ask(work, VersionName::new(name).map(|name| Forget { name }));
                self.forgetting = None;
            }
            if small(ui, "No", &format!("Keep {name}"), "It stays").clicked() {
                self.forgetting = None;
            }
            return;
        }
        let hover = "The painting becomes as it was then; this can be undone";
        if small(ui, "Go back", &format!("Go back to {name}"), hover).clicked() {
            ask(work, VersionName::new(name).map(|name| ReturnTo { name }));
        }
        let hover = "Begin another version from this one";
        if small(ui, "New branch", &format!("New branch from {name}"), hover).clicked() {
            self.branching = match self.branching.take() {
                Some((from, _)) if from == name => None,
                _ => Some((name.to_owned(), String::new())),
            };
        }
        let hover = "Take it off the list, after a question";
        if small(ui, "Delete", &format!("Delete {name}?"), hover).clicked() {
            self.forgetting = Some(name.to_owned());
        }
    }

    /// The name of the version that begins from this one.
    fn branch(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, from: &str) {
        let Some((parent, name)) = &mut self.branching else {
            return;
        };
        if parent != from {
            return;
        }
        let (_, done) = naming(ui, name, "Name of the new version", "Create");
        if done {
            let name = VersionName::new(name.trim());
            let branch = VersionName::new(from).and_then(|from| Ok(Branch { from, name: name? }));
            if ask(work, branch) {
                self.branching = None;
            }
        }
    }

    /// The small picture of a version, or its place.
    fn picture(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, name: &str) {
        let size = vec2(PICTURE[0], PICTURE[1]);
        let (place, response) = ui.allocate_exact_size(size, Sense::hover());
        response
            .widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("Picture of {name}")));
        let now_ns = work.rig.now_ns;
        let Some(picture) = work.rig.thumbnails.of(name, now_ns) else {
            let colour = ui.visuals().faint_bg_color;
            ui.painter()
                .rect_filled(place, CornerRadius::same(2), colour);
            return;
        };
        let known = self.textures.get(name);
        if known.is_none_or(|(drawn, _)| !Arc::ptr_eq(drawn, &picture)) {
            let image = ColorImage::from_rgb(picture.size, &picture.rgb);
            let texture = ui
                .ctx()
                .load_texture(name.to_owned(), image, TextureOptions::LINEAR);
            self.textures
                .insert(name.to_owned(), (Arc::clone(&picture), texture));
        }
        if let Some((_, texture)) = self.textures.get(name) {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            let [across, down] = picture.size.map(|side| side as f32);
            let scale = (size.x / across).min(size.y / down);
            let shown = Rect::from_center_size(place.center(), scale * vec2(across, down));
            ui.painter()
                .image(texture.id(), shown, whole, Color32::WHITE);
        }
    }
}

/// A small button of a version, which screen readers call `label`.
fn small(ui: &mut Ui, word: &str, label: &str, hover: &str) -> Response {
    let button = ui.small_button(word);
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, label));
    button.on_hover_text(hover)
}

#[cfg(test)]
mod tests;
