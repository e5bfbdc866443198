//! The picture that is traced: which, whether it is shown, and how strong.

use eframe::egui::Ui;

use crate::dialogs::paths;
use crate::input::keys::Action;
use crate::widgets::context::PanelContext;
use crate::widgets::rows::{Number, Sliders, below};

const STRENGTH: Number<'_> = Number {
    word: "Strength",
    hover: "How much of the tracing picture is seen; it is neither painted nor exported",
    range: 0.0..=100.0,
    unit: " %",
    decimals: 0,
    factors: false,
};

pub(super) fn show(ui: &mut Ui, work: &mut PanelContext<'_>, sliders: &mut Sliders) {
    let Some(tracing) = work.tracing().cloned() else {
        let choose = ui
            .button("Tracing picture…")
            .on_hover_text("Throw a picture on the canvas, to paint after: Ctrl+Shift+T");
        if choose.clicked() {
            work.requests.act(Action::ChooseTracing);
        }
        return;
    };
    let mut shown = tracing.shown;
    let hover = format!("{}  Ctrl+T", paths::shown(&tracing.path));
    ui.checkbox(&mut shown, "Show tracing picture")
        .on_hover_text(hover);
    let change = sliders.row(ui, &STRENGTH, 100.0 * f64::from(tracing.sound_strength()));
    if let Some(own) = work.tracing_mut() {
        own.shown = shown;
        if let Some(percent) = change.moved {
            own.strength = (0.01 * percent) as f32;
        }
    }
    below(ui, |ui| {
        let another = ui.button("Another…").on_hover_text("Choose another one");
        if another.clicked() {
            work.requests.act(Action::ChooseTracing);
        }
        let remove = ui
            .button("Remove")
            .on_hover_text("The file of the picture stays where it is");
        if remove.clicked() {
            work.untrace();
        }
    });
}
