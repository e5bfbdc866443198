//! The picture that is traced: which, whether it is shown, and how strong.

use eframe::egui::Ui;
use maulstick_ui_kit::rows::{Number, Sliders, below};

use crate::dialogs::paths;
use crate::input::keys::Action;
use crate::tracing::settings::TracingStrength;
use crate::widgets::context::PanelContext;

const STRENGTH: Number<'_> = Number::percent::<TracingStrength>(tr_noop!("picture|Strength"));

pub(super) fn show(ui: &mut Ui, work: &mut PanelContext<'_>, sliders: &mut Sliders) {
    let keys = &work.preferences.keys;
    let Some(tracing) = work.tracing().cloned() else {
        let words = tr!("Project a picture onto the canvas to trace it");
        let hover = keys.hint(ui.ctx(), words, &[Action::ChooseTracing]);
        let choose = ui.button(tr!("Tracing picture…")).on_hover_text(hover);
        if choose.clicked() {
            work.requests.act(Action::ChooseTracing);
        }
        return;
    };
    let mut shown = tracing.shown;
    let path = paths::shown(&tracing.path);
    let hover = keys.hint(ui.ctx(), &path, &[Action::Tracing]);
    ui.checkbox(&mut shown, tr!("Show tracing picture"))
        .on_hover_text(hover);
    let change = sliders.row(ui, &STRENGTH, f64::from(tracing.sound_strength()));
    if let Some(own) = work.tracing_mut() {
        own.shown = shown;
        if let Some(strength) = change.moved {
            own.strength = strength as f32;
        }
    }
    below(ui, |ui| {
        let another = ui
            .button(tr!("Another…"))
            .on_hover_text(tr!("Choose another one"));
        if another.clicked() {
            work.requests.act(Action::ChooseTracing);
        }
        let remove = ui
            .button(tr!("Remove"))
            .on_hover_text(tr!("The file of the picture stays where it is"));
        if remove.clicked() {
            work.untrace();
        }
    });
}
