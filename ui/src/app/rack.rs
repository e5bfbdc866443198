//! The brush rack at the window's edge: a thumbnail of each brush of the library and of the painter's own; a
//! click takes one into the hand.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{
    Align2, Area, Color32, Context, FontId, Frame, Galley, Id, Layout, Margin, Order, Rect,
    Response, Role, ScrollArea, Sense, Shape, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};
use maulstick_brush::BrushFile;
use maulstick_ui_kit::language::known;

use crate::render::brush::icon_cache;
use crate::settings::brush_library::{called, is_of_library, library};
use crate::widgets::context::PanelContext;

/// Width of the rack, points.
pub const WIDTH: f32 = 72.0;
/// Margin around its content, points.
const MARGIN: f32 = 6.0;
/// Height of a brush with its name, points.
const CELL: f32 = 88.0;
/// Height of its name, points.
const NAME: f32 = 15.0;
/// Size of its letters, points, and the share of it that they have at least.
const LETTERS: f32 = 11.0;
const SMALLEST: f32 = 0.8;
/// Height of the mark at an edge where the list continues, points.
const MORE: f32 = 7.0;

/// A place of the rack.
struct Place<'a> {
    /// Its name in the rack.
    name: String,
    /// Two brushes of the same key look alike.
    key: String,
    file: &'a BrushFile,
    width_mm: f64,
    in_hand: bool,
}

/// Shows the rack over the whole height of the window, at the hand's side; returns its area.
pub(crate) fn show(context: &Context, work: &mut PanelContext<'_>) -> Rect {
    let window = context.content_rect();
    let side = if work.preferences.rack_is_left() {
        Align2::LEFT_TOP
    } else {
        Align2::RIGHT_TOP
    };
    let shown = Area::new(Id::unique("rack"))
        .order(Order::Middle)
        .anchor(side, [0.0, 0.0])
        .accessible_name(tr!("Brushes"))
        .show(context, |ui| {
            let fill = ui.visuals().panel_fill.gamma_multiply(0.94);
            let frame = Frame::NONE
                .fill(fill)
                .inner_margin(Margin::same(MARGIN as i8));
            frame.show(ui, |ui| {
                let inside = vec2(WIDTH - 2.0 * MARGIN, window.height() - 2.0 * MARGIN);
                ui.set_min_size(inside);
                ui.set_max_size(inside);
                ui.with_layout(Layout::top_down(eframe::egui::Align::Center), |ui| {
                    switch(ui, work);
                    let scroll = ScrollArea::vertical().id_salt("rack");
                    let hidden = eframe::egui::scroll_area::ScrollBarVisibility::AlwaysHidden;
                    let shown = scroll
                        .scroll_bar_visibility(hidden)
                        .auto_shrink(false)
                        .show(ui, |ui| brushes(ui, work));
                    let below = shown.content_size.y - shown.state.clamped_offset().y;
                    more(
                        ui,
                        shown.inner_rect,
                        [
                            shown.state.clamped_offset().y > 1.0,
                            below > shown.inner_rect.height() + 1.0,
                        ],
                    );
                });
            });
        });
    shown.response.rect
}

/// Marks the edges beyond which a list continues: above, below.
fn more(ui: &Ui, list: Rect, [above, below]: [bool; 2]) {
    let colour = ui.visuals().strong_text_color();
    let middle = list.center().x;
    for (is_more, edge, inward) in [(above, list.top(), 1.0), (below, list.bottom(), -1.0)] {
        if is_more {
            let tip = pos2(middle, edge);
            let base = [-MORE, MORE].map(|aside| tip + vec2(aside, inward * MORE));
            let corners = vec![tip, base[0], base[1]];
            ui.painter()
                .add(Shape::convex_polygon(corners, colour, Stroke::NONE));
        }
    }
}

/// Choice of the brush in the hand, where the rig has several.
fn switch(ui: &mut Ui, work: &mut PanelContext<'_>) {
    if work.rig.brushes.len() < 2 {
        return;
    }
    for place in 0..work.rig.brushes.len() {
        let name = work.rig.brushes[place].name.clone();
        let button = eframe::egui::Button::selectable(work.rig.in_hand == place, &name)
            .min_size(vec2(ui.available_width(), 0.0))
            .truncate();
        let hover = tr!("The brush called '{name}' in the rig's settings", name);
        if ui.add(button).on_hover_text(hover).clicked() {
            work.rig.in_hand = place;
        }
    }
    ui.separator();
}

fn brushes(ui: &mut Ui, work: &mut PanelContext<'_>) {
    ui.spacing_mut().item_spacing.y = 2.0;
    let hand = work.in_hand().cloned();
    let own: Vec<_> = work.preferences.brushes.own_brushes.clone();
    let mut chosen = None;
    let mut is_shown = false;
    for file in library() {
        let in_hand = hand.as_ref().filter(|hand| hand.kind == file.kind);
        let in_hand = in_hand.filter(|hand| is_of_library(hand));
        is_shown |= in_hand.is_some();
        let remembered = work.preferences.brushes.widths_mm.get(&file.kind).copied();
        let held_mm = in_hand.map(|hand| hand.head.width_mm);
        let place = Place {
            name: called(&file.kind),
            key: file.kind.clone(),
            file,
            width_mm: held_mm.or(remembered).unwrap_or(file.head.width_mm),
            in_hand: in_hand.is_some(),
        };
        if cell(ui, work, &place).clicked() {
            chosen = Some(file.clone());
        }
    }
    for path in &own {
        let (is_in_hand, taken) = own_brush(ui, work, path, hand.as_ref());
        is_shown |= is_in_hand;
        chosen = taken.or(chosen);
    }
    // A brush that was changed by hand matches no entry.
    if let Some(hand) = hand.filter(|_| !is_shown) {
        let place = Place {
            name: called(&hand.kind),
            key: hand.to_toml().unwrap_or_default(),
            file: &hand,
            width_mm: hand.head.width_mm,
            in_hand: true,
        };
        let shown = cell(ui, work, &place);
        if shown.clicked() {
            shown.scroll_to_me(None);
        }
    }
    if let Some(file) = chosen {
        work.choose(&file);
    }
}

/// A brush from the painter's file: true if it is in the hand, and the file if it is chosen.
fn own_brush(
    ui: &mut Ui,
    work: &mut PanelContext<'_>,
    path: &Path,
    hand: Option<&BrushFile>,
) -> (bool, Option<BrushFile>) {
    match icon_cache::own(ui.ctx(), path) {
        Ok(file) => {
            let same = |hand: &BrushFile| {
                file.scaled_to(hand.head.width_mm).as_ref() == Ok(hand) || *file == *hand
            };
            let in_hand = hand.filter(|hand| same(hand));
            let place = Place {
                name: stem(path),
                key: path.display().to_string(),
                file: &file,
                width_mm: in_hand.map_or(file.head.width_mm, |hand| hand.head.width_mm),
                in_hand: in_hand.is_some(),
            };
            let is_chosen = cell(ui, work, &place).clicked();
            (place.in_hand, is_chosen.then(|| (*file).clone()))
        }
        Err(fault) => {
            let button = eframe::egui::Button::new(stem(path)).truncate();
            let hover = tr!("This brush file cannot be read; click: why");
            if ui.add(button).on_hover_text(hover).clicked() {
                icon_cache::forget(ui.ctx(), path);
                work.notifications.of(&fault);
            }
            (false, None)
        }
    }
}

fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    called(&stem.to_string_lossy())
}

/// The name of a brush, in smaller letters where it is a little too long.
fn name_galley(ui: &Ui, name: &str, colour: Color32, width: f32) -> Arc<Galley> {
    let font = |size: f32| FontId::proportional(size);
    let laid = |size: f32, width: f32| {
        ui.painter()
            .layout(name.to_owned(), font(size), colour, width)
    };
    let whole = laid(LETTERS, f32::INFINITY).size().x;
    laid(LETTERS * (width / whole).clamp(SMALLEST, 1.0), width)
}

/// A brush with its name; `clicked` also by the keyboard.
fn cell(ui: &mut Ui, work: &PanelContext<'_>, place: &Place<'_>) -> Response {
    let size = vec2(ui.available_width(), CELL);
    let (area, response) = ui.allocate_exact_size(size, Sense::click());
    let words = format!(
        "{}, {}",
        place.name,
        work.preferences.window.units.width(place.width_mm)
    );
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, place.in_hand, &words));
    if ui.is_rect_visible(area) {
        let visuals = ui.visuals();
        let look = ui.style().interact(&response);
        let (fill, text) = if place.in_hand {
            (visuals.selection.bg_fill, visuals.selection.stroke.color)
        } else if response.hovered() {
            (look.weak_bg_fill, look.text_color())
        } else {
            (eframe::egui::Color32::TRANSPARENT, visuals.text_color())
        };
        ui.painter().rect_filled(area, 6.0, fill);
        let picture =
            Rect::from_min_max(area.min + vec2(4.0, 3.0), area.max - vec2(4.0, NAME + 2.0));
        icon_cache::draw(ui, picture, &work.rig.tint, &place.key, place.file);
        let galley = name_galley(ui, &place.name, text, area.width());
        let at = eframe::egui::pos2(
            area.center().x - 0.5 * galley.size().x.min(area.width()),
            area.max.y - NAME,
        );
        ui.painter().with_clip_rect(area).galley(at, galley, text);
        if response.has_focus() {
            let stroke = Stroke::new(2.0, visuals.selection.stroke.color);
            ui.painter()
                .rect_stroke(area, 6.0, stroke, StrokeKind::Inside);
        }
    }
    if place.file.about.is_empty() {
        response.on_hover_text(words)
    } else {
        response.on_hover_text(format!("{words}\n{}", known(&place.file.about)))
    }
}

#[cfg(test)]
mod tests;
