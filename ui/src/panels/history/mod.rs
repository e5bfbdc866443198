//! History panel: undo, redo, the last steps and versions.
//!
//! | module | holds |
//! | --- | --- |
//! | [`outcome_words`] | what an edit has done, where that may be out of view |
//! | `steps` | the last steps, to go back or forth to |
//! | `tree` | versions as a tree |

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align, Button, Color32, ColorImage, CornerRadius, Key, Layout, Rect, Response, RichText, Sense,
    TextEdit, TextureHandle, TextureOptions, Ui, WidgetInfo, pos2, vec2,
};
use maulstick_painting::edits::{Branch, Forget, Keep, ReturnTo};
use maulstick_types::scene::NamedVersion;
use maulstick_types::values::VersionName;
use maulstick_ui_kit::rows::note;

use maulstick_client::thumbnails::{Picture, Pictured};

use crate::panels::Panel;
use crate::widgets::context::{PanelContext, ask};

pub(crate) mod outcome_words;
mod steps;
mod tree;

/// Width and height of a small picture, points.
const PICTURE: [f32; 2] = [60.0, 48.0];
/// Indent of a version below its parent, points; and the largest indent.
const INWARD: f32 = 12.0;
const MOST_INWARD: usize = 5;

#[derive(Default)]
pub(crate) struct HistoryPanel {
    /// Name of the next version.
    name: String,
    /// The version from which another one begins, and its name.
    branching: Option<(String, String)>,
    /// The version whose deletion is to be confirmed.
    forgetting: Option<String>,
    textures: Textures,
}

/// Small pictures as textures of the window.
type Textures = BTreeMap<Pictured, (Arc<Picture>, TextureHandle)>;

impl Panel for HistoryPanel {
    fn title(&self) -> &'static str {
        tr_noop!("History")
    }

    fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let scene = work.rig.live.scene.as_ref();
        let versions = scene.map_or_else(Vec::new, |scene| scene.versions.clone());
        let mut shown = steps::pictured(work);
        shown.extend(versions.iter().map(|version| version.name.as_str().into()));
        work.rig.live.thumbnails.keep(&shown);
        self.textures.retain(|what, _| shown.contains(what));
        steps::show(ui, work, &mut self.textures);
        self.keep(ui, work);
        if versions.is_empty() {
            note(ui, tr!("Keep a version, and you can come back to it."));
        }
        for (depth, version) in tree::in_order(&versions) {
            ui.push_id(&version.name, |ui| self.version(ui, work, depth, version));
        }
    }
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
        let (_, done) = naming(ui, &mut self.name, tr!("Name of a version"), tr!("Keep"));
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
            picture_of(ui, work, &mut self.textures, name);
            ui.with_layout(Layout::top_down(Align::Min), |ui| {
                ui.horizontal(|ui| {
                    let title = if version.here {
                        RichText::new(name).strong()
                    } else {
                        RichText::new(name)
                    };
                    ui.add(eframe::egui::Label::new(title).truncate());
                    if version.here {
                        ui.label(RichText::new(tr!("here")).small())
                            .on_hover_text(tr!("Painting continues from this version"));
                    }
                });
                ui.horizontal(|ui| self.buttons(ui, work, name));
            });
        });
        self.branch(ui, work, name);
    }

    fn buttons(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, name: &str) {
        if self.forgetting.as_deref() == Some(name) {
            ui.label(tr!("Delete?"));
            let yes = small(
                ui,
                tr!("Yes"),
                &tr!("Delete {name}", name),
                tr!("This cannot be undone"),
            );
            if yes.clicked() {
                ask(work, VersionName::new(name).map(|name| Forget { name }));
                self.forgetting = None;
            }
            if small(ui, tr!("No"), &tr!("Keep {name}", name), tr!("It stays")).clicked() {
                self.forgetting = None;
            }
            return;
        }
        let hover = tr!("The painting becomes as it was then; this can be undone");
        if small(ui, tr!("Go back"), &tr!("Go back to {name}", name), hover).clicked() {
            ask(work, VersionName::new(name).map(|name| ReturnTo { name }));
        }
        let hover = tr!("Begin another version from this one");
        if small(
            ui,
            tr!("New branch"),
            &tr!("New branch from {name}", name),
            hover,
        )
        .clicked()
        {
            self.branching = match self.branching.take() {
                Some((from, _)) if from == name => None,
                _ => Some((name.to_owned(), String::new())),
            };
        }
        let hover = tr!("Take it off the list, after a question");
        if small(ui, tr!("Delete"), &tr!("Delete {name}?", name), hover).clicked() {
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
        let (_, done) = naming(ui, name, tr!("Name of the new version"), tr!("Create"));
        if done {
            let name = VersionName::new(name.trim());
            let branch = VersionName::new(from).and_then(|from| Ok(Branch { from, name: name? }));
            if ask(work, branch) {
                self.branching = None;
            }
        }
    }
}

/// The small picture of a version, or its place.
fn picture_of(ui: &mut Ui, work: &mut PanelContext<'_>, textures: &mut Textures, name: &str) {
    let (place, response) = ui.allocate_exact_size(PICTURE.into(), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, tr!("Picture of {name}", name)));
    paint_picture(ui, place, work, textures, &name.into());
}

/// Paints a small picture into a place, as large as it fits.
fn paint_picture(
    ui: &Ui,
    place: Rect,
    work: &mut PanelContext<'_>,
    textures: &mut Textures,
    what: &Pictured,
) {
    let now_ns = work.rig.live.now_ns;
    let Some(picture) = work.rig.live.thumbnails.of(what.clone(), now_ns) else {
        let colour = ui.visuals().faint_bg_color;
        let corners = CornerRadius::same(2);
        ui.painter().rect_filled(place, corners, colour);
        return;
    };
    let known = textures.get(what);
    if known.is_none_or(|(drawn, _)| !Arc::ptr_eq(drawn, &picture)) {
        let image = ColorImage::from_rgb(picture.size, &picture.rgb);
        let name = format!("{what:?}");
        let texture = ui.ctx().load_texture(name, image, TextureOptions::LINEAR);
        textures.insert(what.clone(), (Arc::clone(&picture), texture));
    }
    if let Some((_, texture)) = textures.get(what) {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let [across, down] = picture.size.map(|side| side as f32);
        let scale = (place.width() / across).min(place.height() / down);
        let shown = Rect::from_center_size(place.center(), scale * vec2(across, down));
        let painter = ui.painter();
        painter.image(texture.id(), shown, whole, Color32::WHITE);
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
