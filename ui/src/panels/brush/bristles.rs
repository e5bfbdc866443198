//! Settings of the brush file that a painter may change: capacity and bristles.

use eframe::egui::{Slider, SliderClamping, Ui};
use maulstick_brush::BrushFile;
use maulstick_ui_kit::labelled;
use maulstick_ui_kit::language::translated;

use crate::settings::brush_library::{is_of_library, of_library};
use crate::widgets::context::PanelContext;

/// Unit that is shown as the painter has chosen.
const MILLIMETRES: &str = " mm";

/// A number of a brush file.
struct Number {
    name: &'static str,
    hover: &'static str,
    unit: &'static str,
    range: std::ops::RangeInclusive<f64>,
    of: fn(&mut BrushFile) -> &mut f64,
}

const NUMBERS: [Number; 6] = [
    Number {
        name: tr_noop!("Film"),
        hover: tr_noop!("Thickness of paint on the bristles of a freshly loaded brush."),
        unit: " µm",
        range: 0.0..=2000.0,
        of: |file| &mut file.load.film_um,
    },
    Number {
        name: tr_noop!("Inside"),
        hover: tr_noop!(
            "Paint within the head, as thick as if it were spread over the bristles: with more of it a \
                stroke is longer."
        ),
        unit: " µm",
        range: 0.0..=2000.0,
        of: |file| &mut file.load.inside_um,
    },
    Number {
        name: tr_noop!("Uneven"),
        hover: tr_noop!(
            "By which share bristles differ in how much they carry: uneven ones leave streaks."
        ),
        unit: "",
        range: 0.0..=1.0,
        of: |file| &mut file.strips.unevenness,
    },
    Number {
        name: tr_noop!("Unruly"),
        hover: tr_noop!(
            "How far the most unruly bristle keeps off the surface while the brush is hardly pressed."
        ),
        unit: MILLIMETRES,
        range: 0.0..=3.0,
        of: |file| &mut file.strips.lift_mm,
    },
    Number {
        name: tr_noop!("Spread"),
        hover: tr_noop!("Width of the fully pressed point, by that of the head."),
        unit: "",
        range: 0.0..=2.0,
        of: |file| &mut file.strips.open,
    },
    Number {
        name: tr_noop!("Friction"),
        hover: tr_noop!("Friction of the bristles on the canvas."),
        unit: "",
        range: 0.0..=1.0,
        of: |file| &mut file.contact.friction,
    },
];

/// Shows the numbers of a brush, changed ones go to `changed`; whether one is being dragged.
pub(super) fn show(
    ui: &mut Ui,
    work: &mut PanelContext<'_>,
    file: &BrushFile,
    changed: &mut Option<BrushFile>,
) -> bool {
    let mut wanted = file.clone();
    let mut is_held = false;
    for number in &NUMBERS {
        let value = (number.of)(&mut wanted);
        let (unit, decimals, sign) = match number.unit {
            MILLIMETRES => work.preferences.window.units.small(),
            other => (1.0, 2, other),
        };
        let mut shown = *value / unit;
        let range = number.range.start() / unit..=number.range.end() / unit;
        let slider = Slider::new(&mut shown, range)
            .max_decimals(decimals)
            .clamping(SliderClamping::Edits)
            .suffix(sign);
        let slider = labelled::named(
            ui,
            translated(number.name),
            translated(number.hover),
            slider,
        );
        is_held |= slider.dragged();
        // A slider rounds what it shows.
        if labelled::is_moved(*value, shown * unit) {
            *value = shown * unit;
        }
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
