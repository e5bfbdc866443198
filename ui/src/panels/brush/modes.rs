//! Brush modes that the paint model offers.

use eframe::egui::{ComboBox, Ui};
use maulstick_painting::edits::Handle;
use maulstick_types::limits::FLOWS;
use maulstick_types::scene::{BrushHandling, BrushMode};
use maulstick_ui_kit::labelled::{self, PendingValue};
use maulstick_ui_kit::language::translated;

use crate::widgets::context::PanelContext;

/// Most paint that a painter is offered as a bound, µm.
const MOST_UM: std::ops::RangeInclusive<f64> = 1.0..=2000.0;
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
    asked: &mut PendingValue<BrushHandling>,
) {
    let handling = asked.shown(ui, work.rig.handling());
    let mut wanted = handling.clone();
    ui.horizontal(|ui| {
        let hover = tr!("What the brush does with the paint that it touches.");
        let name = labelled::label(ui, tr!("Mode"), hover);
        let mut ways = WAYS.iter();
        let own = ways.find(|(mode, ..)| *mode == handling.mode);
        ComboBox::from_id_salt("way")
            .width(150.0)
            .selected_text(own.map_or("", |(_, words, _)| translated(words)))
            .show_ui(ui, |ui| {
                for (mode, words, does) in &WAYS {
                    let is_own = *mode == handling.mode;
                    if ui
                        .selectable_label(is_own, translated(words))
                        .on_hover_text(translated(does))
                        .clicked()
                    {
                        wanted.mode = mode.clone();
                    }
                }
            })
            .response
            .labelled_by(name.id)
            .on_hover_text(own.map_or("", |(.., does)| translated(does)));
    });
    if handling.mode == BrushMode::Marker {
        // Micrometres along a millimetre.
        let mut um = handling.flow * 1e3;
        let range = FLOWS.start() * 1e3..=FLOWS.end() * 1e3;
        let slider = labelled::slider(&mut um, range, " µm/mm").max_decimals(3);
        let hover = tr!("Thickness that the marker leaves along a millimetre of its way.");
        if labelled::named(ui, tr!("Flow"), hover, slider).changed() {
            wanted.flow = um * 1e-3;
        }
    }
    if !matches!(handling.mode, BrushMode::Sampler | BrushMode::Vacuum) {
        most(ui, &handling, &mut wanted);
    }
    if wanted != handling {
        asked.ask(ui, wanted.clone());
        crate::widgets::context::ask(work, Handle::try_from(&wanted));
    }
}

fn most(ui: &mut Ui, handling: &BrushHandling, wanted: &mut BrushHandling) {
    let hover = tr!(
        "On the canvas the brush adds no paint where as much lies wet already; in hollows up to twice as much."
    );
    let mut bounded = handling.most_m > 0.0;
    let check = ui.checkbox(&mut bounded, tr!("Limit the thickness"));
    if check.on_hover_text(hover).changed() {
        wanted.most_m = if bounded { PROPOSED_M } else { 0.0 };
    }
    // Always there, so that nothing below it moves as a preset is clicked.
    ui.add_enabled_ui(bounded, |ui| {
        let shown_m = if bounded { wanted.most_m } else { PROPOSED_M };
        let mut um = (shown_m * 1e9).round() * 1e-3;
        let slider = labelled::slider(&mut um, MOST_UM, " µm").max_decimals(0);
        if labelled::named(ui, tr!("Thickness"), hover, slider).changed() {
            wanted.most_m = um * 1e-6;
        }
    });
}
