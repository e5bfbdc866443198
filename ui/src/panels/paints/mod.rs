//! Paints panel: the measured paints, and the wells of the palette.
//!
//! | module | holds |
//! | --- | --- |
//! | `rows` | a row for each tube |
//! | `sets` | the painter's own sets of paints |
//! | `wells` | mixtures on the palette |

pub(crate) mod palette_wells;
mod rows;
mod sets;
mod wells;

use eframe::egui::{ComboBox, TextEdit, Ui};
use maulstick_ui_kit::rows::row;
use maulstick_ui_kit::swatches::Swatches;

use crate::panels::Panel;
use crate::widgets::context::PanelContext;

/// A swatch: masstone at its left, tint at its right, points.
const SWATCH: [f32; 2] = [44.0, 18.0];

#[derive(Debug, Default)]
pub(crate) struct PaintsPanel {
    swatches: Swatches,
    search: String,
    /// The set whose tubes are shown; all of them where there is no such set.
    set: Option<String>,
    wells: wells::WellRows,
    sets: sets::SetRows,
}

/// A paint or a mixture that is being dragged to the palette.
#[derive(Clone, Debug, PartialEq)]
struct Carried(String);

impl Panel for PaintsPanel {
    fn title(&self) -> &'static str {
        tr_noop!("Tubes")
    }

    fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let edit = TextEdit::singleline(&mut self.search)
            .hint_text(tr!("Blue, or PB29"))
            .desired_width(f32::INFINITY);
        row(ui, tr!("Search"), |ui| ui.add(edit))
            .on_hover_text(tr!("By name, or by colour index."));
        self.choose_set(ui, work);
        rows::show(self, ui, work);
        ui.separator();
        self.wells.show(ui, work, &mut self.swatches);
        ui.separator();
        self.sets.show(ui, work, &mut self.set);
    }
}

impl PaintsPanel {
    /// Choice of the painter's set to show.
    fn choose_set(&mut self, ui: &mut Ui, work: &PanelContext<'_>) {
        let sets = &work.preferences.brushes.paint_sets;
        self.set
            .take_if(|own| sets.iter().all(|set| set.name != *own));
        if sets.is_empty() {
            return;
        }
        let all = tr!("All tubes");
        let shown = self.set.clone().unwrap_or_else(|| all.to_owned());
        row(ui, tr!("Set"), |ui| {
            let combo = ComboBox::from_id_salt("set")
                .width(ui.available_width())
                .truncate()
                .selected_text(shown);
            let shown = combo.show_ui(ui, |ui| {
                ui.selectable_value(&mut self.set, None, all);
                for set in sets {
                    let value = Some(set.name.clone());
                    ui.selectable_value(&mut self.set, value, &set.name);
                }
            });
            shown.response
        })
        .on_hover_text(tr!("Which tubes are shown: all, or a set of your own."));
    }
}

#[cfg(test)]
mod tests;
