//! Brush panel: shape, size, stiffness, wetness, and the options of the paint model.
//!
//! | module | holds |
//! | --- | --- |
//! | `bristles` | capacity and bristles |
//! | `modes` | brush modes of the paint model |
//! | `paint` | loading and cleaning |
//! | `presets` | brushes with their paint, by name |
//! | `custom_brushes` | the painter's own brush files |

mod bristles;
mod custom_brushes;
mod modes;
mod paint;
mod presets;

use std::ops::RangeInclusive;

use eframe::egui::{Button, ComboBox, Rect, RichText, Sense, Ui, vec2};
use maulstick_brush::BrushFile;
use maulstick_painting::edits::Tune;
use maulstick_types::limits::STIFFNESS;
use maulstick_types::scene::{BrushHandling, Tuning};
use maulstick_ui_kit::labelled::{self, PendingValue};
use maulstick_ui_kit::language::known;

use crate::input::brush_choice::{resized, widths_mm};
use crate::input::keymap::Keymap;
use crate::input::keys::Action;
use crate::panels::Panel;
use crate::render::brush::icon_cache;
use crate::settings::brush_library::{called, library};
use crate::settings::grip::{Grip, MOUSE_PRESSURE};
use crate::widgets::context::PanelContext;

/// The portrait of the brush in the hand, points.
const PORTRAIT: [f32; 2] = [44.0, 64.0];

#[derive(Debug, Default)]
pub(crate) struct BrushPanel {
    /// The brush while a control is dragged, before it is requested.
    dragged: Option<BrushFile>,
    /// For which brush the widths hold that it can have, mm.
    widths: Option<(BrushFile, RangeInclusive<f64>)>,
    tuning: PendingValue<Tuning>,
    handling: PendingValue<BrushHandling>,
    paint: paint::PaintRows,
    own: custom_brushes::OwnBrushes,
    presets: presets::PresetRows,
}

impl Panel for BrushPanel {
    fn title(&self) -> &'static str {
        tr_noop!("Brush")
    }

    fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let Some(file) = self.dragged.clone().or_else(|| work.in_hand().cloned()) else {
            ui.label(tr!(
                "The brush '{brush}' has not said yet what it is.",
                brush = work.rig.brush_name()
            ));
            return;
        };
        shape(ui, work, &file);
        let mut is_held = self.width(ui, work, &file);
        self.tuning(ui, work);
        modes::show(ui, work, &mut self.handling);
        ui.collapsing(tr!("Mouse"), |ui| {
            mouse(
                ui,
                &work.preferences.keys,
                &mut work.preferences.brushes.mouse,
            );
        });
        ui.separator();
        self.paint.show(ui, work);
        ui.separator();
        self.presets.show(ui, work);
        let bristles = ui.collapsing(tr!("Bristles"), |ui| {
            bristles::show(ui, work, &file, &mut self.dragged)
        });
        is_held |= bristles.body_returned.unwrap_or(false);
        ui.collapsing(tr!("Own brush files"), |ui| self.own.show(ui, work));
        // The change is requested when the control is released.
        if !is_held && let Some(file) = self.dragged.take() {
            work.take_up(file);
        }
    }
}

/// The brush as it looks, and what else there is.
fn shape(ui: &mut Ui, work: &mut PanelContext<'_>, file: &BrushFile) {
    ui.horizontal(|ui| {
        let (area, _) = ui.allocate_exact_size(PORTRAIT.into(), Sense::hover());
        let key = file.to_toml().unwrap_or_default();
        icon_cache::draw(ui, area, &work.rig.tint, &key, file);
        ui.vertical(|ui| {
            let name = ui.label(tr!("Shape"));
            let mut chosen = None;
            ComboBox::from_id_salt("shape")
                .width(150.0)
                .height(420.0)
                .selected_text(called(&file.kind))
                .show_ui(ui, |ui| {
                    for other in library() {
                        if choice(ui, work, other, other.kind == file.kind) {
                            chosen = Some(other);
                        }
                    }
                })
                .response
                .labelled_by(name.id);
            if let Some(other) = chosen {
                work.choose(other);
            }
            ui.label(RichText::new(known(&file.about)).small());
        });
    });
}

/// Turn and pressure of a brush that the mouse moves.
fn mouse(ui: &mut Ui, keys: &Keymap, grip: &mut Grip) {
    let hint = |ui: &Ui, words: &str, acts: &[Action]| keys.hint(ui.ctx(), words, acts);
    let check = ui.checkbox(&mut grip.follows, tr!("Brush follows the stroke"));
    let words = tr!("Its broad side stays across the stroke.");
    check.on_hover_text(hint(ui, words, &[Action::Follow]));
    let slider = labelled::slider(&mut grip.turn_deg, -180.0..=180.0, "°").max_decimals(0);
    let words = tr!("Angle from across the stroke, or from the horizontal if it does not follow.");
    let hover = hint(ui, words, &[Action::TurnLeft, Action::TurnRight]);
    labelled::named(ui, tr!("Turn"), &hover, slider);
    let mut percent = (100.0 * grip.pressure).round();
    let [least, most] = [MOUSE_PRESSURE.start(), MOUSE_PRESSURE.end()].map(|share| 100.0 * share);
    let slider = labelled::slider(&mut percent, least..=most, " %").max_decimals(0);
    let words = tr!("Pressure while the button is down.");
    let hover = hint(ui, words, &[Action::Lighter, Action::Harder]);
    if labelled::named(ui, tr!("Pressure"), &hover, slider).changed() {
        grip.pressure = 0.01 * percent;
    }
}

/// A brush of the list; whether it was chosen.
fn choice(ui: &mut Ui, work: &PanelContext<'_>, file: &BrushFile, is_in_hand: bool) -> bool {
    ui.horizontal(|ui| {
        let (area, picture) = ui.allocate_exact_size(vec2(24.0, 34.0), Sense::click());
        icon_cache::draw(ui, area, &work.rig.tint, &file.kind, file);
        let size = vec2(110.0, area.height());
        let button = Button::selectable(is_in_hand, called(&file.kind)).min_size(size);
        let shown = ui.add(button).on_hover_text(&file.about);
        shown.clicked() || picture.clicked()
    })
    .inner
}

impl BrushPanel {
    /// The widths that a brush can have, mm; while one is dragged the ends stay where they are.
    fn widths(&mut self, file: &BrushFile) -> RangeInclusive<f64> {
        let holds = |known: &BrushFile| self.dragged.is_some() || known == file;
        if let Some((_, range)) = self.widths.as_ref().filter(|(known, _)| holds(known)) {
            return range.clone();
        }
        let range = widths_mm(file);
        self.widths = Some((file.clone(), range.clone()));
        range
    }

    /// Width slider; true while it is dragged.
    fn width(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>, file: &BrushFile) -> bool {
        let (unit_mm, decimals, sign) = work.preferences.window.units.small();
        let mut width = file.head.width_mm / unit_mm;
        let hover = work.preferences.keys.hint(
            ui.ctx(),
            tr!("Width of the head. A wider brush is longer and stiffer in proportion."),
            &[Action::Smaller, Action::Larger],
        );
        let range = self.widths(file);
        let range = range.start() / unit_mm..=range.end() / unit_mm;
        let slider = labelled::slider(&mut width, range, sign).max_decimals(decimals);
        let shown = labelled::named(ui, tr!("Width"), &hover, slider);
        if shown.changed() {
            match resized(file, width * unit_mm) {
                Ok(scaled) => self.dragged = Some(scaled),
                Err(error) => {
                    let help = tr!("choose another width");
                    work.notifications.fault(error.to_string(), help);
                }
            }
        }
        shown.dragged()
    }

    fn tuning(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let tuning = self.tuning.shown(ui, work.rig.tuning());
        let mut wanted = tuning.clone();
        let mut factor = wanted.stiffness;
        labelled::named(
            ui,
            tr!("Stiffness"),
            tr!("Factor on the stiffness that the brush was made with: 1 is as it was made."),
            labelled::slider(&mut factor, STIFFNESS, " ×"),
        );
        if labelled::is_moved(wanted.stiffness, factor) {
            wanted.stiffness = factor;
        }
        let mut percent = (wanted.wetness * 100.0).round();
        let slider = labelled::slider(&mut percent, 0.0..=100.0, " %").max_decimals(0);
        let hover = tr!("How soaked the head is: a soaked one is half as stiff.");
        if labelled::named(ui, tr!("Wetness"), hover, slider).changed() {
            wanted.wetness = percent / 100.0;
        }
        if wanted != tuning {
            self.tuning.ask(ui, wanted.clone());
            crate::widgets::context::ask(work, Tune::try_from(&wanted));
        }
    }
}

/// A row of a list: what it is at the left, what can be done with it at the right.
pub(super) fn entry(ui: &mut Ui, left: impl FnOnce(&mut Ui), right: impl FnOnce(&mut Ui)) -> Rect {
    let row = ui.horizontal(|ui| {
        left(ui);
        let layout = eframe::egui::Layout::right_to_left(eframe::egui::Align::Center);
        ui.with_layout(layout, right);
    });
    row.response.rect
}

#[cfg(test)]
mod tests;
