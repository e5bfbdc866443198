//! Presets: brushes with their paint.

use eframe::egui::{Button, Color32, Key, TextEdit, TextStyle, Ui, vec2};
use maulstick_ui_kit::language::known;
use maulstick_ui_kit::rows::{row, wrong};

use super::entry;
use crate::settings::presets::{Preset, check_name};
use crate::widgets::context::PanelContext;

#[derive(Debug, Default)]
pub(super) struct PresetRows {
    /// The name of a new one.
    name: String,
    wrong: Option<String>,
    /// The one that is being renamed, and its new name.
    renamed: Option<(usize, String)>,
    /// The one that was deleted last, and where it stood.
    deleted: Option<(usize, Preset)>,
}

/// Width of a preset's name at most, points.
const NAME: f32 = 150.0;

/// Width of a small button with the space before it, points.
fn small_width(ui: &Ui, word: &str) -> f32 {
    let font = TextStyle::Button.resolve(ui.style());
    let text = ui
        .painter()
        .layout_no_wrap(word.to_owned(), font, Color32::WHITE);
    let spacing = ui.spacing();
    text.size().x + 2.0 * spacing.button_padding.x + spacing.item_spacing.x
}

/// Name of a preset in the language of the window; one that a painter gave stays as it is.
fn shown_name(preset: &Preset) -> &str {
    if ["Glaze", "Scumble", "Blend", "Dry brush"].contains(&&*preset.name) {
        known(&preset.name)
    } else {
        &preset.name
    }
}

/// Action on a preset.
enum PresetAction {
    Apply,
    Rename,
    Delete,
}

impl PresetRows {
    pub(super) fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        ui.strong(tr!("Presets"));
        let mut asked = None;
        for place in 0..work.preferences.brushes.presets.len() {
            if self.renamed.as_ref().is_some_and(|(own, _)| *own == place) {
                self.rename(ui, work, place);
                continue;
            }
            let preset = &work.preferences.brushes.presets[place];
            let name = shown_name(preset).to_owned();
            let words = preset.words(work.preferences.window.units);
            let mut take = false;
            let taken = [tr!("Rename"), tr!("Delete")].map(|word| small_width(ui, word));
            let room = ui.available_width() - taken.iter().sum::<f32>();
            let width = room.ceil().min(NAME);
            let mut action = None;
            entry(
                ui,
                |ui| {
                    let button = Button::new(&name).truncate().min_size(vec2(width, 0.0));
                    take = ui
                        .scope(|ui| {
                            ui.set_max_width(width);
                            ui.add(button).on_hover_text(words).clicked()
                        })
                        .inner;
                },
                |ui| {
                    if ui
                        .small_button(tr!("Delete"))
                        .on_hover_text(tr!("Delete {name}", name))
                        .clicked()
                    {
                        action = Some(PresetAction::Delete);
                    }
                    if ui
                        .small_button(tr!("Rename"))
                        .on_hover_text(tr!("Rename {name}", name))
                        .clicked()
                    {
                        action = Some(PresetAction::Rename);
                    }
                },
            );
            if take {
                action = Some(PresetAction::Apply);
            }
            asked = action.map(|action| (place, action)).or(asked);
        }
        if let Some((place, action)) = asked {
            self.carry_out(place, action, work);
        }
        self.take_back(ui, work);
        self.save(ui, work);
    }

    fn carry_out(&mut self, place: usize, action: PresetAction, work: &mut PanelContext<'_>) {
        match action {
            PresetAction::Apply => {
                let preset = work.preferences.brushes.presets[place].clone();
                if let Err(fault) = work.take_up_preset(&preset) {
                    work.notifications.of(&fault);
                }
            }
            PresetAction::Rename => {
                self.renamed = Some((
                    place,
                    shown_name(&work.preferences.brushes.presets[place]).to_owned(),
                ));
                self.wrong = None;
            }
            PresetAction::Delete => {
                self.deleted = Some((place, work.preferences.brushes.presets.remove(place)));
                self.renamed = None;
            }
        }
    }

    fn take_back(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let Some((place, preset)) = &self.deleted else {
            return;
        };
        let mut back = false;
        let words = tr!("{name} is deleted.", name = shown_name(preset));
        entry(
            ui,
            |ui| drop(ui.label(words)),
            |ui| back = ui.small_button(tr!("Bring back")).clicked(),
        );
        if back {
            let place = (*place).min(work.preferences.brushes.presets.len());
            work.preferences
                .brushes
                .presets
                .insert(place, preset.clone());
            self.deleted = None;
        }
    }

    fn rename(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, place: usize) {
        let Some((_, name)) = &mut self.renamed else {
            return;
        };
        let edit = TextEdit::singleline(name).desired_width(f32::INFINITY);
        let shown = row(ui, tr!("New name"), |ui| ui.add(edit));
        if !shown.has_focus() && !shown.lost_focus() {
            shown.request_focus();
        }
        if !shown.lost_focus() {
            return;
        }
        let name = name.trim().to_owned();
        let is_kept = ui.input(|input| input.key_pressed(Key::Escape));
        let others = work.preferences.brushes.presets.iter().enumerate();
        let others = others.filter(|(other, _)| *other != place);
        match check_name(&name, others.map(|(_, preset)| preset.name.as_str())) {
            _ if is_kept => {}
            Ok(()) => work.preferences.brushes.presets[place].name = name,
            Err(fault) => work.notifications.fault(fault.words(), String::new()),
        }
        self.renamed = None;
    }

    fn save(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let edit = TextEdit::singleline(&mut self.name)
            .hint_text(tr!("Sky wash"))
            .desired_width(f32::INFINITY);
        let hover = tr!("Name of a preset of the brush in hand, its settings and its paint.");
        let shown = row(ui, tr!("Name"), |ui| ui.add(edit)).on_hover_text(hover);
        if shown.changed() {
            self.wrong = None;
        }
        let enter = shown.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let button = ui.button(tr!("Save this brush"));
        let hover = tr!("Keeps the brush, how it is used, and the paint above.");
        if button.on_hover_text(hover).clicked() || enter {
            let name = self.name.trim().to_owned();
            let others = work
                .preferences
                .brushes
                .presets
                .iter()
                .map(|preset| preset.name.as_str());
            match check_name(&name, others) {
                Ok(()) => {
                    if let Some(preset) = work.preset_in_hand(&name) {
                        work.preferences.brushes.presets.push(preset);
                        self.name.clear();
                    }
                }
                Err(fault) => self.wrong = Some(fault.words()),
            }
        }
        if let Some(what) = &self.wrong {
            wrong(ui, what);
        }
    }
}
