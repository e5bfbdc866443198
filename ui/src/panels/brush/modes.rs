//! Brush modes that the paint model offers.

use eframe::egui::{ComboBox, Ui};
use maulstick_painting::edits::Handle;
use maulstick_types::scene::{BrushHandling, BrushMode};
use maulstick_types::values::{FilmLimit, MarkerFlow, Quantity};
use maulstick_ui_kit::language::translated;
use maulstick_ui_kit::pending::Pending;
use maulstick_ui_kit::rows::{Number, Sliders, row};

use crate::widgets::context::{PanelContext, ask};

const FLOW: Number<'_> = Number::of::<MarkerFlow>(tr_noop!("Flow"), 3);
const LIMIT: Number<'_> = Number::of::<FilmLimit>(tr_noop!("Thickness"), 0);
/// Proposed film limit where there was none, m.
const PROPOSED_M: f64 = 60e-6;

/// Modes with labels and descriptions in a painter's words.
const WAYS: [(BrushMode, &str, &str); 7] = [
    (
        BrushMode::Normal,
        tr_noop!("mode|Paint"),
        tr_noop!("It pushes paint, leaves some and takes some up."),
    ),
    (
        BrushMode::NoPush,
        tr_noop!("Paint without pushing"),
        tr_noop!("It leaves paint and takes some up, but pushes none aside."),
    ),
    (
        BrushMode::Sponge,
        tr_noop!("Never runs out"),
        tr_noop!("It stays as it is, full or empty, whatever it leaves or takes up."),
    ),
    (
        BrushMode::SpongeNoPush,
        tr_noop!("Never runs out, without pushing"),
        tr_noop!("It stays as it is, full or empty, and pushes nothing aside."),
    ),
    (
        BrushMode::Marker,
        tr_noop!("Marker"),
        tr_noop!("It leaves as much as its flow says, and takes up nothing."),
    ),
    (
        BrushMode::Sampler,
        tr_noop!("Pick up colour"),
        tr_noop!("It takes on the colours that it touches; the surface stays as it is."),
    ),
    (
        BrushMode::Vacuum,
        tr_noop!("Lift paint"),
        tr_noop!("It lifts off the wet paint that it touches, and is clean."),
    ),
];

/// Shows how the brush in the hand is used, and asks for what is changed.
pub(super) fn show(
    ui: &mut Ui,
    work: &mut PanelContext<'_>,
    (sliders, asked): (&mut Sliders, &mut Pending<BrushHandling>),
) {
    let now_s = ui.input(|input| input.time);
    let handling = asked.shown(now_s, &work.rig.handling());
    let mut wanted = handling.clone();
    mode(ui, &mut wanted.mode);
    if handling.mode == BrushMode::Marker {
        // Micrometres along a millimetre.
        let change = sliders.row(ui, &FLOW, handling.flow * 1e3);
        wanted.flow = change.moved.map_or(wanted.flow, |um| um * 1e-3);
    }
    if !matches!(handling.mode, BrushMode::Sampler | BrushMode::Vacuum) {
        limit(ui, sliders, &mut wanted.most_m);
    }
    if wanted != handling {
        asked.hold(now_s, wanted.clone());
        ask(work, Handle::try_from(&wanted));
    }
}

fn mode(ui: &mut Ui, mode: &mut BrushMode) {
    let own = WAYS.iter().find(|(other, ..)| other == mode);
    let (words, does) = own.map_or(("", ""), |(_, words, does)| (*words, *does));
    row(ui, tr!("Mode"), |ui| {
        let combo = ComboBox::from_id_salt("way")
            .width(ui.available_width())
            .selected_text(translated(words));
        let shown = combo.show_ui(ui, |ui| {
            for (other, words, does) in &WAYS {
                let choice = ui.selectable_label(other == mode, translated(words));
                if choice.on_hover_text(translated(does)).clicked() {
                    *mode = other.clone();
                }
            }
        });
        shown.response
    })
    .on_hover_text(translated(does));
}

/// Limit of the wet film; 0 for none.
fn limit(ui: &mut Ui, sliders: &mut Sliders, most_m: &mut f64) {
    let mut bounded = *most_m > 0.0;
    let check = ui.checkbox(&mut bounded, tr!("Limit the thickness"));
    if check.on_hover_text(translated(FilmLimit::HELP)).changed() {
        *most_m = if bounded { PROPOSED_M } else { 0.0 };
    }
    // Always there, so that nothing below it moves as a preset is clicked.
    ui.add_enabled_ui(bounded, |ui| {
        let shown_m = if bounded { *most_m } else { PROPOSED_M };
        if let Some(um) = sliders.row(ui, &LIMIT, shown_m * 1e6).moved {
            *most_m = um * 1e-6;
        }
    });
}
