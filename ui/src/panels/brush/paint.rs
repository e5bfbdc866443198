//! Controls that load and clean the brush in the hand.

use eframe::egui::{Button, Ui};
use maulstick_painting::edits::common;
use maulstick_rig::UserError;
use maulstick_types::values::ThinnerShare;
use maulstick_ui_kit::rows::{Number, Sliders, row};

use crate::input::keys::Action;
use crate::widgets::context::{PanelContext, ask};
use crate::widgets::{brush_gauge, mixture_field};

const THINNER: Number<'_> = Number::percent::<ThinnerShare>(tr_noop!("Thinner"));

#[derive(Debug, Default)]
pub(super) struct PaintRows {
    sliders: Sliders,
    fault: Option<UserError>,
}

impl PaintRows {
    pub(super) fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let before = work.preferences.brushes.loading.clone();
        let carried = work.rig.brush().and_then(|brush| brush.carried.as_ref());
        if carried.is_some() {
            row(ui, tr!("Carries"), |ui| {
                ui.horizontal(|ui| brush_gauge::show(ui, work)).response
            })
            .on_hover_text(tr!("The paint that is on the brush now."));
        }
        let library = &work.rig.library;
        let loading = &mut work.preferences.brushes.loading;
        let hover =
            tr!("A paint's name, or a mixture by volume such as 2 Cobalt Blue, 1 Titanium White");
        let words = (tr!("Paint"), hover);
        let (_, mut enter) = mixture_field::show(ui, words, &mut loading.paint, library);
        let mut two = loading.beside.is_some();
        let check = ui.checkbox(&mut two, tr!("Second colour on the right half"));
        let hover = tr!("Two paints side by side on one brush (double loading).");
        if check.on_hover_text(hover).changed() {
            loading.beside = two.then(String::new);
        }
        if let Some(beside) = &mut loading.beside {
            let hover = tr!("What the right half of the brush takes up.");
            let words = (tr!("Right half"), hover);
            enter |= mixture_field::show(ui, words, beside, library).1;
        }
        let change = self.sliders.row(ui, &THINNER, loading.thinner);
        loading.thinner = change.moved.unwrap_or(loading.thinner);
        self.buttons(ui, work, enter);
        if before != work.preferences.brushes.loading {
            self.fault = None;
        }
        if let Some(fault) = &self.fault {
            mixture_field::fault(ui, fault);
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
                let clean = common::clean(work.rig.brush_name());
                ask(work, clean);
            }
        });
    }

    fn load(&mut self, work: &mut PanelContext<'_>) {
        let brush = work.rig.brush_name().to_owned();
        let load = work
            .preferences
            .brushes
            .loading
            .command(&brush, &work.rig.library);
        self.fault = match load {
            Ok(load) => {
                work.then(load);
                None
            }
            Err(fault) => Some(fault),
        };
    }
}
