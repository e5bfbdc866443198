//! Gauge of the brush in the hand: colours of its tip from left to right, and how full it is.

use eframe::egui::{Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo};

use crate::widgets::context::PanelContext;

/// Size, points.
const SIZE: [f32; 2] = [72.0, 24.0];
/// Height of the level, points.
const LEVEL: f32 = 5.0;
/// Below this load share the level is drawn in the colour of warnings.
const LOW: f32 = 0.15;

/// Shows the gauge; `None` until it is known what the brush carries.
pub(crate) fn show(ui: &mut Ui, work: &PanelContext<'_>) -> Option<Response> {
    let brush = work.rig.brushes.get(work.rig.in_hand);
    let carried = brush.and_then(|brush| brush.carried.as_ref())?;
    let (area, response) = ui.allocate_exact_size(SIZE.into(), Sense::hover());
    let words = match carried.load_share {
        0.0 => tr!("The brush is clean").to_owned(),
        full => tr!(
            "The brush is {percent} % full",
            percent = (100.0 * full).ceil()
        ),
    };
    response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &words));
    if ui.is_rect_visible(area) {
        let painter = ui.painter();
        let mut tip = area.shrink(2.0);
        tip.max.y -= LEVEL + 2.0;
        let width = tip.width() / carried.colours.len().max(1) as f32;
        for (column, colour) in carried.colours.iter().enumerate() {
            let mut part = tip;
            part.min.x += column as f32 * width;
            part.max.x = part.min.x + width;
            painter.rect_filled(part, 0.0, work.rig.tint.colour(colour.to_array()));
        }
        let line = Stroke::new(1.0, ui.visuals().weak_text_color());
        painter.rect_stroke(tip, 0.0, line, StrokeKind::Outside);
        let mut level = area.shrink(2.0);
        level.min.y = level.max.y - LEVEL;
        painter.rect_stroke(level, 0.0, line, StrokeKind::Outside);
        level.max.x = level.min.x + carried.load_share * level.width();
        let colour = if carried.load_share < LOW {
            ui.visuals().warn_fg_color
        } else {
            ui.visuals().selection.stroke.color
        };
        painter.rect_filled(level, 0.0, colour);
    }
    let hover = tr!("Above, the colours of its tip from left to right; below, how full it is.");
    Some(response.on_hover_text(format!("{words}.\n{hover}")))
}

#[cfg(test)]
mod tests {
    use eframe::egui::vec2;
    use egui_kittest::kittest::Queryable as _;

    use glam::Vec3;

    use super::*;
    use crate::rig::carried_paint::CarriedPaint;
    use crate::test_support::context_bench::{Bench, window};

    #[test]
    fn a_brush_says_how_full_it_is_once_that_is_known() {
        let show = |carried: Option<CarriedPaint>| {
            let mut bench = Bench::new();
            bench.rig.brushes[0].carried = carried;
            let mut harness = window(vec2(120.0, 60.0), bench, |ui, work| {
                show(ui, work);
            });
            harness.run();
            ["The brush is clean", "The brush is 41 % full"]
                .map(|words| harness.query_by_label(words).is_some())
        };
        let with = |load_share| {
            Some(CarriedPaint {
                colours: vec![Vec3::X, Vec3::Z],
                load_share,
            })
        };
        assert_eq!(show(None), [false, false]);
        assert_eq!(show(with(0.0)), [true, false]);
        assert_eq!(show(with(0.401)), [false, true]);
    }
}
