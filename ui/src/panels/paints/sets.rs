//! The painter's own sets of paints.

use eframe::egui::{Key, TextEdit, Ui};
use maulstick_ui_kit::rows::{row, wrong};

use crate::settings::paint_sets::PaintSet;
use crate::settings::presets::check_name;
use crate::widgets::context::PanelContext;

#[derive(Debug, Default)]
pub(super) struct SetRows {
    name: String,
    wrong: Option<String>,
    /// The one that was deleted last, and where it stood.
    deleted: Option<(usize, PaintSet)>,
}

impl SetRows {
    /// Shows what can be done with sets; `shown` is the one whose tubes are listed.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        work: &mut PanelContext<'_>,
        shown: &mut Option<String>,
    ) {
        ui.strong(tr!("Sets"));
        let place = shown.as_ref().and_then(|own| {
            let mut sets = work.preferences.brushes.paint_sets.iter();
            sets.position(|set| set.name == *own)
        });
        if let Some(place) = place {
            self.deeds(ui, work, shown, place);
        } else if !work.preferences.brushes.paint_sets.is_empty() {
            ui.label(tr!("Choose a set above to lay it out."));
        }
        self.bring_back(ui, work);
        let edit = TextEdit::singleline(&mut self.name)
            .hint_text(tr!("Portrait"))
            .desired_width(f32::INFINITY);
        let hover = tr!("Name of the set of the paints on the palette.");
        let field = row(ui, tr!("Name"), |ui| ui.add(edit)).on_hover_text(hover);
        if field.changed() {
            self.wrong = None;
        }
        let enter = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        ui.horizontal(|ui| {
            let button = ui.button(tr!("Save palette as set"));
            let hover = tr!("Keeps the paints that lie on the palette as a set of this name.");
            if button.on_hover_text(hover).clicked() || enter {
                self.keep(work, shown);
            }
            if let Some(place) = place {
                let button = ui.button(tr!("Rename the set"));
                if button
                    .on_hover_text(tr!("Calls the chosen set so."))
                    .clicked()
                {
                    self.rename(work, shown, place);
                }
            }
        });
        if let Some(what) = &self.wrong {
            wrong(ui, what);
        }
    }

    fn deeds(
        &mut self,
        ui: &mut Ui,
        work: &mut PanelContext<'_>,
        shown: &mut Option<String>,
        place: usize,
    ) {
        ui.horizontal(|ui| {
            let lay = ui.button(tr!("Lay out"));
            let hover = tr!("The palette holds the paints of this set, and no others.");
            if lay.on_hover_text(hover).clicked() {
                let set = work.preferences.brushes.paint_sets[place].clone();
                match set.mixtures(&work.rig.library) {
                    Ok(mixtures) => work.lay_wells(&mixtures),
                    Err(fault) => work.notifications.of(&fault),
                }
            }
            let renew = ui.button(tr!("Renew"));
            let hover = tr!("The set becomes the paints on the palette.");
            if renew.on_hover_text(hover).clicked() {
                let name = work.preferences.brushes.paint_sets[place].name.clone();
                work.preferences.brushes.paint_sets[place] = PaintSet::of(&name, &work.wells());
            }
            if ui.button(tr!("Delete set")).clicked() {
                self.deleted = Some((place, work.preferences.brushes.paint_sets.remove(place)));
                *shown = None;
            }
        });
    }

    fn bring_back(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let Some((place, set)) = &self.deleted else {
            return;
        };
        let mut back = false;
        ui.horizontal(|ui| {
            ui.label(tr!("{name} is deleted.", name = set.name));
            back = ui.small_button(tr!("Bring back")).clicked();
        });
        if back {
            let place = (*place).min(work.preferences.brushes.paint_sets.len());
            work.preferences
                .brushes
                .paint_sets
                .insert(place, set.clone());
            self.deleted = None;
        }
    }

    fn named(&mut self, work: &PanelContext<'_>, besides: Option<usize>) -> Option<String> {
        let name = self.name.trim().to_owned();
        let others = work.preferences.brushes.paint_sets.iter().enumerate();
        let others = others.filter(|(place, _)| Some(*place) != besides);
        match check_name(&name, others.map(|(_, set)| set.name.as_str())) {
            Ok(()) => {
                self.name.clear();
                self.wrong = None;
                Some(name)
            }
            Err(what) => {
                self.wrong = Some(what.words());
                None
            }
        }
    }

    fn keep(&mut self, work: &mut PanelContext<'_>, shown: &mut Option<String>) {
        let Some(name) = self.named(work, None) else {
            return;
        };
        let set = PaintSet::of(&name, &work.wells());
        work.preferences.brushes.paint_sets.push(set);
        *shown = Some(name);
    }

    fn rename(&mut self, work: &mut PanelContext<'_>, shown: &mut Option<String>, place: usize) {
        if let Some(name) = self.named(work, Some(place)) {
            work.preferences.brushes.paint_sets[place]
                .name
                .clone_from(&name);
            *shown = Some(name);
        }
    }
}
