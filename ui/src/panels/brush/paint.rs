//! Controls that load and clean the brush in the hand.

use eframe::egui::{Button, TextEdit, Ui};
use maulstick_painting::edits::Clean;
use maulstick_rig::UserError;
use maulstick_types::values::{BrushName, ThinnerShare};
use maulstick_ui_kit::labelled;

use crate::input::keys::Action;
use crate::settings::brush_load::{completed, completions};
use crate::widgets::brush_gauge;
use crate::widgets::context::PanelContext;

/// Names that are proposed at most.
const PROPOSED: usize = 4;

#[derive(Debug, Default)]
pub(super) struct PaintRows {
    fault: Option<UserError>,
}

impl PaintRows {
    pub(super) fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let before = work.preferences.brushes.loading.clone();
        if work
            .rig
            .brush()
            .is_some_and(|brush| brush.carried.is_some())
        {
            ui.horizontal(|ui| {
                labelled::label(
                    ui,
                    tr!("Carries"),
                    tr!("The paint that is on the brush now."),
                );
                brush_gauge::show(ui, work);
            });
        }
        let hover =
            tr!("A paint's name, or a mixture by volume such as 2 Cobalt Blue, 1 Titanium White");
        let mut enter = field(ui, work, tr!("Paint"), hover, |loading| {
            Some(&mut loading.paint)
        });
        let mut two = work.preferences.brushes.loading.beside.is_some();
        let check = ui.checkbox(&mut two, tr!("Second colour on the right half"));
        let hover = tr!("Two paints side by side on one brush (double loading).");
        if check.on_hover_text(hover).changed() {
            work.preferences.brushes.loading.beside = two.then(String::new);
        }
        if two {
            let hover = tr!("What the right half of the brush takes up.");
            enter |= field(ui, work, tr!("Right half"), hover, |loading| {
                loading.beside.as_mut()
            });
        }
        let mut percent = (work.preferences.brushes.loading.thinner * 100.0).round();
        let most = ThinnerShare::MOST.get() * 100.0;
        let slider = labelled::slider(&mut percent, 0.0..=most, " %").max_decimals(0);
        let hover =
            tr!("Share of thinner in what the brush takes up: thin paint is transparent and runs.");
        if labelled::named(ui, tr!("Thinner"), hover, slider).changed() {
            work.preferences.brushes.loading.thinner = percent / 100.0;
        }
        self.buttons(ui, work, enter);
        if before != work.preferences.brushes.loading {
            self.fault = None;
        }
        if let Some(fault) = &self.fault {
            labelled::wrong(ui, &fault.what);
            if let Some(help) = &fault.help {
                ui.label(help);
            }
        }
    }

    /// Load and Clean; `enter` loads as well.
    fn buttons(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, enter: bool) {
        ui.horizontal(|ui| {
            let load = ui.add_enabled(
                !work.preferences.brushes.loading.paint.is_empty(),
                Button::new(tr!("Load")),
            );
            let load = load.on_hover_text(tr!("The brush is cleaned, and full of this paint."));
            if load.clicked() || enter {
                self.load(work);
            }
            let words = tr!("Takes all paint off the brush.");
            let hover = work
                .preferences
                .keys
                .hint(ui.ctx(), words, &[Action::Clean]);
            let clean = ui.button(tr!("Clean")).on_hover_text(hover);
            if clean.clicked() {
                let brush = BrushName::new(work.rig.brush_name());
                crate::widgets::context::ask(work, brush.map(|brush| Clean { brush }));
            }
        });
    }

    fn load(&mut self, work: &mut PanelContext<'_>) {
        let brush = work.rig.brush_name().to_owned();
        let load = work
            .preferences
            .brushes
            .loading
            .edit(&brush, &work.rig.library);
        self.fault = match load {
            Ok(load) => {
                work.then(load.into());
                None
            }
            Err(fault) => Some(fault),
        };
    }
}

/// A field for a mixture, and names that go on with what is typed; whether Enter was pressed in it.
fn field(
    ui: &mut Ui,
    work: &mut PanelContext<'_>,
    name: &str,
    hover: &str,
    part: impl Fn(&mut crate::settings::brush_load::BrushLoad) -> Option<&mut String>,
) -> bool {
    let Some(text) = part(&mut work.preferences.brushes.loading) else {
        return false;
    };
    let edit = TextEdit::singleline(text)
        .hint_text("2 Cobalt Blue, 1 …")
        .char_limit(4096)
        .desired_width(190.0);
    let shown = labelled::named(ui, name, hover, edit);
    let enter = shown.lost_focus() && ui.input(|input| input.key_pressed(eframe::egui::Key::Enter));
    let names = completions(text, &work.rig.library, PROPOSED);
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
    enter
}
