//! The column of panels at a side of the window. Its head moves it to the other side, by a button or by dragging it there.

use eframe::egui::{
    Align, Area, CollapsingHeader, Color32, Context, CursorIcon, Frame, Id, LayerId, Layout, Order,
    Pos2, Rect, RichText, Role, ScrollArea, Sense, Ui, WidgetInfo, pos2,
};
use maulstick_ui_kit::language::translated;

use crate::app::sides::{COLUMN, MARGIN, column_side, rack_at};
use crate::panels::{self, Panel};
use crate::settings::window_side::WindowSide;
use crate::widgets::context::PanelContext;

/// Width of the scroll bar at the right, points.
const BAR: f32 = 14.0;

pub(super) struct Column {
    panels: Vec<Box<dyn Panel>>,
    /// True if it is to get the keyboard.
    is_wanted: bool,
}

impl Default for Column {
    fn default() -> Self {
        Self {
            panels: panels::all(),
            is_wanted: false,
        }
    }
}

impl Column {
    /// Gives it the keyboard.
    pub(super) fn focus(&mut self) {
        self.is_wanted = true;
    }

    pub(super) fn show(&mut self, context: &Context, work: &mut PanelContext<'_>) {
        let side = column_side(work.preferences);
        let (corner, _, inward) = side.anchors();
        let aside = rack_at(work.preferences, side) + 2.0 * MARGIN;
        let height = context.content_rect().height() - 7.0 * MARGIN;
        Area::new(Id::unique("panels"))
            .order(Order::Middle)
            .anchor(corner, [inward * aside, MARGIN])
            .accessible_name(tr!("Panels"))
            .show(context, |ui| {
                Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_width(COLUMN);
                    head(ui, side, work);
                    ScrollArea::vertical()
                        .max_height(height)
                        .min_scrolled_height(height)
                        // Else it is as narrow as its content, and the bar with it.
                        .auto_shrink([false, true])
                        .show(ui, |ui| {
                            // The bar covers the edge.
                            ui.set_max_width(ui.available_width() - BAR);
                            self.panels(ui, work);
                        });
                });
            });
    }

    fn panels(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) {
        for panel in &mut self.panels {
            let title = panel.title();
            let open = work.preferences.is_open(title);
            let header = CollapsingHeader::new(RichText::new(translated(title)).strong())
                .id_salt(title)
                .default_open(open);
            let shown = header.show(ui, |ui| {
                ui.spacing_mut().slider_width = 120.0;
                panel.show(ui, work);
            });
            if std::mem::take(&mut self.is_wanted) {
                shown.header_response.request_focus();
            }
            if shown.header_response.clicked() {
                work.preferences.unfold(title, !open);
            }
        }
    }
}

/// The head: a handle, and buttons that move and hide the column.
fn head(ui: &mut Ui, side: WindowSide, work: &mut PanelContext<'_>) {
    ui.horizontal(|ui| {
        let layout = Layout::right_to_left(Align::Center);
        ui.with_layout(layout, |ui| {
            let named = |ui: &mut Ui, word: &str, name: &str| {
                let button = ui.small_button(word);
                button.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
                button.on_hover_text(name).clicked()
            };
            if named(ui, "×", tr!("Hide the panels")) {
                work.preferences.window.panels = false;
            }
            let other = side.other();
            let (word, name) = match other {
                WindowSide::Left => (tr!("To the left"), tr!("Move the panels to the left")),
                WindowSide::Right => (tr!("To the right"), tr!("Move the panels to the right")),
            };
            if named(ui, word, name) {
                work.preferences.window.panel_side = Some(other);
            }
            let size = ui.available_size_before_wrap();
            let (area, handle) = ui.allocate_exact_size(size, Sense::drag());
            let at = area.left_center();
            let font = eframe::egui::TextStyle::Small.resolve(ui.style());
            let colour = ui.visuals().weak_text_color();
            let anchor = eframe::egui::Align2::LEFT_CENTER;
            ui.painter().text(at, anchor, tr!("Panels"), font, colour);
            let handle = handle
                .on_hover_cursor(CursorIcon::Grab)
                .on_hover_text(tr!("Drag the panels to the other side"));
            if let Some(pointer) = handle.interact_pointer_pos() {
                let window = ui.ctx().content_rect();
                let to = half_of(window, pointer);
                if handle.drag_stopped() && to != side {
                    work.preferences.window.panel_side = Some(to);
                } else if handle.dragged() && to != side {
                    mark(ui.ctx(), window, to);
                }
            }
        });
    });
}

/// The side of the window that a point is nearer to.
fn half_of(window: Rect, at: Pos2) -> WindowSide {
    if at.x < window.center().x {
        WindowSide::Left
    } else {
        WindowSide::Right
    }
}

/// Marks where the column would go.
fn mark(context: &Context, window: Rect, side: WindowSide) {
    let width = COLUMN + 4.0 * MARGIN;
    let left = match side {
        WindowSide::Left => window.left(),
        WindowSide::Right => window.right() - width,
    };
    let place = Rect::from_min_max(
        pos2(left, window.top()),
        pos2(left + width, window.bottom()),
    );
    let painter = context.layer_painter(LayerId::new(Order::Foreground, Id::unique("panels go")));
    painter.rect_filled(place, 8.0, Color32::from_white_alpha(40));
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Event, Key, Modifiers, PointerButton, Vec2, vec2};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;
    use maulstick_types::command::{BrushCommand, Command};

    use super::*;
    use crate::settings::brush_library::of_library;
    use crate::test_support::overlay_bench::{Bench, press, window};

    fn shown() -> Harness<'static, Bench> {
        let mut harness = window(None);
        let file = of_library("round").expect("round").clone();
        let text = file.to_toml().expect("written");
        harness.state_mut().rig.brushes[0].file = Some((file, text));
        press(&mut harness, Key::Tab);
        harness
    }

    fn left_of(harness: &Harness<'_, Bench>, label: &str) -> f32 {
        harness.get_by_label(label).rect().left()
    }

    fn drag(harness: &mut Harness<'_, Bench>, from: Pos2, by: Vec2, during: Option<Key>) {
        let button = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        harness.event(Event::PointerMoved(from));
        harness.step();
        harness.event(button(from, true));
        harness.step();
        for share in [0.5, 1.0] {
            harness.event(Event::PointerMoved(from + share * by));
            harness.step();
        }
        if let Some(key) = during {
            press(harness, key);
        }
        harness.event(button(from + by, false));
        harness.run_steps(4);
    }

    #[test]
    fn the_panels_move_to_the_other_side_by_a_button_and_by_dragging_and_back() {
        let mut harness = shown();
        assert!(left_of(&harness, "Tubes") > 450.0);
        harness
            .get_by_label("Move the panels to the left")
            .click_accesskit();
        harness.run_steps(3);
        assert!(left_of(&harness, "Tubes") < 100.0);
        let kept = harness.state().preferences.window.panel_side;
        assert_eq!(kept, Some(WindowSide::Left));
        // Neither rack nor bar is under them.
        let column = left_of(&harness, "Tubes") + COLUMN;
        assert!(left_of(&harness, "Undo") > column);
        assert!(left_of(&harness, "Flat, 20 mm") > column);
        let handle = harness.get_by_label("Hide the panels").rect().center() - vec2(150.0, 0.0);
        drag(&mut harness, handle, vec2(600.0, 100.0), None);
        assert_eq!(
            harness.state().preferences.window.panel_side,
            Some(WindowSide::Right)
        );
        assert!(left_of(&harness, "Tubes") > 450.0);
        harness.get_by_label("Hide the panels").click_accesskit();
        harness.run_steps(3);
        assert!(harness.query_by_label("Tubes").is_none());
    }

    #[test]
    fn panels_that_are_hidden_in_mid_drag_lose_nothing() {
        let mut harness = shown();
        let slider = harness.get_all_by_label("Width").map(|node| node.rect());
        let slider = slider.max_by(|a, b| a.width().total_cmp(&b.width()));
        let from = slider.expect("a slider").center();
        drag(&mut harness, from, vec2(30.0, 0.0), Some(Key::Tab));
        let asked = harness.state_mut().asked();
        assert!(
            matches!(
                &asked[..],
                [(_, Command::Brush(BrushCommand::Define { .. }))]
            ),
            "{asked:?}"
        );
        assert!(harness.query_by_label("Tubes").is_none(), "hidden then");
    }
}
