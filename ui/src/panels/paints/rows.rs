//! Rows of the paints: swatch, name and colour index.

use eframe::egui::{
    Align2, Button, Color32, FontId, Rect, Response, Role, ScrollArea, Sense, Stroke, StrokeKind,
    Ui, WidgetInfo, vec2,
};
use maulstick_optics::THINNER;
use maulstick_types::Mixture;
use maulstick_ui_kit::swatches;

use super::{Carried, PaintsPanel, SWATCH};
use crate::settings::brush_load::{self, words};
use crate::settings::paint_sets::PaintSet;
use crate::widgets::context::PanelContext;

/// Height of the list, points: more is scrolled to.
const LIST: f32 = 264.0;
/// Height of a tube, points.
const ROW: f32 = 24.0;
/// Width of what puts a tube onto the palette, points.
const PLUS: f32 = 26.0;
/// Width of the bar that scrolls the list, points: beside what puts a tube onto the palette.
const BAR: f32 = 7.0;

/// A tube of the list.
struct Tube {
    name: String,
    index: String,
    about: String,
    /// Text of the brush load.
    text: String,
    mixture: Mixture,
    colours: [Color32; 2],
}

/// Action on a paint.
enum Deed {
    Load,
    ToPalette,
    IntoSet(usize, bool),
}

/// Shows the tubes that are searched for.
pub(super) fn show(panel: &mut PaintsPanel, ui: &mut Ui, work: &mut PanelContext<'_>) {
    let tubes = tubes(panel, work);
    if tubes.is_empty() {
        ui.label(tr!(
            "No tube is called so. Search for a part of its name, or its colour index."
        ));
        return;
    }
    let mut asked = None;
    ui.spacing_mut().scroll.bar_width = BAR;
    ScrollArea::vertical()
        .id_salt("tubes")
        .max_height(LIST)
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            for tube in &tubes {
                if let Some(deed) = tube_row(ui, work, tube) {
                    asked = Some((tube, deed));
                }
            }
        });
    match asked {
        Some((tube, Deed::Load)) => {
            work.preferences
                .brushes
                .loading
                .paint
                .clone_from(&tube.text);
            work.preferences.brushes.loading.beside = None;
            if tube.name == THINNER {
                work.preferences.brushes.loading.thinner = 0.0;
            }
            let brush = work.rig.brush_name().to_owned();
            let load = work
                .preferences
                .brushes
                .loading
                .command(&brush, &work.rig.library);
            match load {
                Ok(load) => work.then(load),
                Err(fault) => work.notifications.of(&fault),
            }
        }
        Some((tube, Deed::ToPalette)) => panel.wells.put(work, &tube.mixture),
        Some((tube, Deed::IntoSet(place, true))) => {
            work.preferences.brushes.paint_sets[place]
                .paints
                .push(tube.text.clone());
        }
        Some((tube, Deed::IntoSet(place, false))) => {
            let set: &mut PaintSet = &mut work.preferences.brushes.paint_sets[place];
            set.paints.retain(|own| *own != tube.text);
        }
        None => {}
    }
}

/// The tubes that are shown: all paints and the thinner, or a set, as far as searched for.
fn tubes(panel: &mut PaintsPanel, work: &mut PanelContext<'_>) -> Vec<Tube> {
    let rig = &*work.rig;
    let library = &rig.library;
    let mut tubes = Vec::new();
    let set = panel.set.as_ref().and_then(|own| {
        let mut sets = work.preferences.brushes.paint_sets.iter();
        sets.find(|set| set.name == *own)
    });
    let Some(set) = set else {
        let thinner = library.find(THINNER).into_iter();
        for paint in library.paints().iter().chain(thinner) {
            if swatches::matches(paint, &panel.search) {
                tubes.push(Tube {
                    name: paint.name.clone(),
                    index: paint.colour_index.clone(),
                    about: swatches::words(paint),
                    text: paint.name.clone(),
                    mixture: Mixture::pure(&paint.name),
                    colours: panel.swatches.paint(rig.showing(), paint),
                });
            }
        }
        return tubes;
    };
    for text in &set.paints {
        // A paint that the rig does not have stays in the set, for a rig that has it.
        let Ok(mixture) = brush_load::read(text, library) else {
            continue;
        };
        let single = match &mixture.parts[..] {
            [part] => library.find(&part.paint).ok(),
            _ => None,
        };
        let name = words(&mixture);
        let found = match single {
            Some(paint) => swatches::matches(paint, &panel.search),
            None => name.to_lowercase().contains(&panel.search.to_lowercase()),
        };
        let whole = panel.swatches.mixture(rig.showing(), &mixture);
        let whole = [whole.unwrap_or(Color32::TRANSPARENT); 2];
        if found {
            tubes.push(Tube {
                index: single.map_or(String::new(), |paint| paint.colour_index.clone()),
                about: single.map_or_else(|| name.clone(), swatches::words),
                text: text.clone(),
                colours: single.map_or(whole, |paint| panel.swatches.paint(rig.showing(), paint)),
                mixture,
                name,
            });
        }
    }
    tubes
}

fn tube_row(ui: &mut Ui, work: &PanelContext<'_>, tube: &Tube) -> Option<Deed> {
    let mut deed = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        let shown = tube_button(ui, tube);
        if shown.clicked() {
            deed = Some(Deed::Load);
        }
        shown.dnd_set_drag_payload(Carried(tube.text.clone()));
        shown.context_menu(|ui| {
            if ui.button(tr!("Load the brush")).clicked() {
                deed = Some(Deed::Load);
            }
            if ui.button(tr!("To the palette")).clicked() {
                deed = Some(Deed::ToPalette);
            }
            for (place, set) in work.preferences.brushes.paint_sets.iter().enumerate() {
                let held = set.paints.contains(&tube.text);
                let words = if held {
                    tr!("Out of '{set}'", set = set.name)
                } else {
                    tr!("Into '{set}'", set = set.name)
                };
                if ui.button(words).clicked() {
                    deed = Some(Deed::IntoSet(place, !held));
                }
            }
        });
        let hover = tr!(
            "Load the brush with it. Right: more. Drag it into a well.\n{about}",
            about = tube.about
        );
        shown.on_hover_text(hover);
        let words = tr!("{paint} to the palette", paint = tube.name);
        let plus = ui.add(Button::new("+").min_size(vec2(PLUS, ROW)));
        let plus = plus.on_hover_text(&words);
        plus.widget_info(|| WidgetInfo::labeled(Role::Button, true, &words));
        if plus.clicked() {
            deed = Some(Deed::ToPalette);
        }
    });
    deed
}

fn tube_button(ui: &mut Ui, tube: &Tube) -> Response {
    let size = vec2(ui.available_width() - PLUS - 2.0 - BAR - 1.0, ROW);
    let (area, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &tube.name));
    if !ui.is_rect_visible(area) {
        return response;
    }
    let look = *ui.style().interact(&response);
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(area, 4.0, look.weak_bg_fill);
    }
    let at = area.min + vec2(3.0, 0.5 * (ROW - SWATCH[1]));
    swatches::draw(ui, Rect::from_min_size(at, SWATCH.into()), tube.colours);
    let weak = ui.visuals().weak_text_color();
    let index = ui.painter().text(
        area.right_center() - vec2(4.0, 0.0),
        Align2::RIGHT_CENTER,
        &tube.index,
        FontId::proportional(11.0),
        weak,
    );
    let left = area.min.x + SWATCH[0] + 10.0;
    let names = Rect::from_x_y_ranges(left..=index.min.x - 4.0, area.y_range());
    let text = look.text_color();
    ui.painter()
        .with_clip_rect(names.intersect(ui.clip_rect()))
        .text(
            names.left_center(),
            Align2::LEFT_CENTER,
            &tube.name,
            FontId::proportional(13.0),
            text,
        );
    if response.has_focus() {
        let stroke = Stroke::new(1.5, ui.visuals().selection.stroke.color);
        ui.painter()
            .rect_stroke(area, 4.0, stroke, StrokeKind::Inside);
    }
    response
}
