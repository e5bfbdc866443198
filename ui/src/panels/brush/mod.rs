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
use maulstick_brush::file::quantities::HeadWidth;
use maulstick_painting::edits::Tune;
use maulstick_types::scene::{BrushHandling, Tuning};
use maulstick_types::values::{Quantity, Stiffness, Wetness};
use maulstick_ui_kit::language::{known, translated};
use maulstick_ui_kit::pending::Pending;
use maulstick_ui_kit::rows::{Number, Sliders};

use maulstick_window_pen::mouse::grip::{Grip, MousePressure, MouseTurn};

use crate::input::brush_choice::{resized, widths_mm};
use crate::input::keymap::Keymap;
use crate::input::keys::Action;
use crate::panels::Panel;
use crate::render::brush::icon_cache;
use crate::settings::brush_library::{called, library};
use crate::widgets::context::{PanelContext, ask};

/// The portrait of the brush in the hand, points.
const PORTRAIT: [f32; 2] = [44.0, 64.0];

const STIFFNESS: Number<'_> = Number::of::<Stiffness>(tr_noop!("Stiffness"), 2);
const WETNESS: Number<'_> = Number::percent::<Wetness>(tr_noop!("Wetness"));

/// The panel.
#[derive(Debug, Default)]
pub(crate) struct BrushPanel {
    /// The brush while a control is dragged, before it is requested.
    dragged: Option<BrushFile>,
    /// For which brush the widths hold that it can have, mm.
    widths: Option<(BrushFile, RangeInclusive<f64>)>,
    sliders: Sliders,
    tuning: Pending<Tuning>,
    handling: Pending<BrushHandling>,
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
        modes::show(ui, work, (&mut self.sliders, &mut self.handling));
        ui.collapsing(tr!("Mouse"), |ui| {
            let grip = &mut work.preferences.brushes.mouse;
            mouse(ui, &work.preferences.keys, &mut self.sliders, grip);
        });
        ui.separator();
        self.paint.show(ui, work);
        ui.separator();
        self.presets.show(ui, work);
        let bristles = ui.collapsing(tr!("Bristles"), |ui| {
            bristles::show(ui, work, &mut self.sliders, &file, &mut self.dragged)
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
fn mouse(ui: &mut Ui, keys: &Keymap, sliders: &mut Sliders, grip: &mut Grip) {
    let context = ui.ctx().clone();
    let hint = |words: &str, acts: &[Action]| keys.hint(&context, words, acts);
    let check = ui.checkbox(&mut grip.follows, tr!("Brush follows the stroke"));
    let words = tr!("Its broad side stays across the stroke.");
    check.on_hover_text(hint(words, &[Action::Follow]));
    let words = translated(MouseTurn::HELP);
    let words = hint(words, &[Action::TurnLeft, Action::TurnRight]);
    let turn = Number::of::<MouseTurn>(tr_noop!("Turn"), 0).hint(&words);
    let words = translated(MousePressure::HELP);
    let words = hint(words, &[Action::Lighter, Action::Harder]);
    let pressure = Number::percent::<MousePressure>(tr_noop!("Pressure")).hint(&words);
    sliders.rows(
        ui,
        [(&turn, &mut grip.turn_deg), (&pressure, &mut grip.pressure)],
    );
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
        let keys = &work.preferences.keys;
        let words = translated(HeadWidth::HELP);
        let hint = keys.hint(ui.ctx(), words, &[Action::Smaller, Action::Larger]);
        let units = work.preferences.window.units;
        let number = Number::length::<HeadWidth>(tr_noop!("Width"), units)
            .within(&self.widths(file))
            .hint(&hint);
        let change = self.sliders.row(ui, &number, file.head.width_mm);
        match change.moved.map(|width_mm| resized(file, width_mm)) {
            Some(Ok(scaled)) => self.dragged = Some(scaled),
            Some(Err(error)) => {
                let help = tr!("choose another width");
                work.notifications.fault(error.to_string(), help);
            }
            None => {}
        }
        change.is_dragged
    }

    fn tuning(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        let now_s = ui.input(|input| input.time);
        let mut wanted = self.tuning.shown(now_s, &work.rig.tuning());
        let numbers = [
            (&STIFFNESS, &mut wanted.stiffness),
            (&WETNESS, &mut wanted.wetness),
        ];
        if self.sliders.rows(ui, numbers) {
            self.tuning.hold(now_s, wanted.clone());
            ask(work, Tune::try_from(&wanted));
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
