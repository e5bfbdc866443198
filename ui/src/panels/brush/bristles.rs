//! Settings of the brush file that a painter may change: capacity and bristles.

use eframe::egui::Ui;
use maulstick_brush::BrushFile;
use maulstick_brush::file::quantities::{
    Friction, Lift, LoadFilm, LoadInside, Opening, Unevenness,
};
use maulstick_ui_kit::rows::{Number, Sliders};

use crate::settings::brush_library::{is_of_library, of_library};
use crate::widgets::context::PanelContext;

/// Field of a brush file.
type Field = fn(&mut BrushFile) -> &mut f64;

/// Shows the numbers of a brush, changed ones go to `changed`; true while one is dragged.
pub(super) fn show(
    ui: &mut Ui,
    work: &mut PanelContext<'_>,
    sliders: &mut Sliders,
    file: &BrushFile,
    changed: &mut Option<BrushFile>,
) -> bool {
    let units = work.preferences.window.units;
    let numbers: [(Number<'_>, Field); 6] = [
        (Number::of::<LoadFilm>(tr_noop!("Film"), 2), |file| {
            &mut file.load.film_um
        }),
        (Number::of::<LoadInside>(tr_noop!("Inside"), 2), |file| {
            &mut file.load.inside_um
        }),
        (Number::of::<Unevenness>(tr_noop!("Uneven"), 2), |file| {
            &mut file.strips.unevenness
        }),
        (Number::length::<Lift>(tr_noop!("Unruly"), units), |file| {
            &mut file.strips.lift_mm
        }),
        (Number::of::<Opening>(tr_noop!("Spread"), 2), |file| {
            &mut file.strips.open
        }),
        (Number::of::<Friction>(tr_noop!("Friction"), 2), |file| {
            &mut file.contact.friction
        }),
    ];
    let mut wanted = file.clone();
    let mut is_held = false;
    for (number, field) in &numbers {
        let value = field(&mut wanted);
        let change = sliders.row(ui, number, *value);
        is_held |= change.is_dragged;
        *value = change.moved.unwrap_or(*value);
    }
    // Static friction is at least kinetic friction.
    if let Some(sticking) = &mut wanted.contact.friction_static {
        *sticking = sticking.max(wanted.contact.friction);
    }
    if wanted != *file {
        match wanted.check() {
            Ok(()) => *changed = Some(wanted),
            Err(error) => {
                let help = tr!("choose a number within these bounds");
                work.notifications.fault(error.to_string(), help);
            }
        }
    }
    if !is_of_library(file)
        && let Some(made) = of_library(&file.kind)
    {
        let button = ui.button(tr!("As it was made"));
        let hover = tr!("Gives the brush back the numbers of the library, at its width.");
        if button.on_hover_text(hover).clicked() {
            *changed = made.scaled_to(file.head.width_mm).ok();
        }
    }
    is_held
}
