//! A line of help for a new painter, and a picture of the keys. It disappears with the first paint that is deposited, and returns
//! briefly when this painter begins another painting.

use std::time::Duration;

use eframe::egui::{Area, Color32, Context, Frame, Id, Margin, Order, Rect, RichText, Stroke};
use maulstick_ui_kit::language::translated;

use crate::app::sides;
use crate::input::keys::Action;
use crate::rig::state::RigState;
use crate::settings::preferences::Preferences;
use crate::settings::window_side::WindowSide;
use crate::widgets::key_picture;

/// The line of help with a clean brush.
pub(super) const HELP: &str =
    tr_noop!("Drag the brush through a paint of the palette, then over the canvas.");
/// Duration of the line over another painting, s.
const AGAIN_S: f64 = 10.0;

/// Space between the line and the rack, points.
const BESIDE: f32 = 24.0;
/// Width of the picture beside the rack, where an ordinary window has no canvas, points.
const WIDTH: f32 = 320.0;
/// Height of the line over the window's edge beside the rack, where the painting's name stands, points.
const ABOVE_NAME: f32 = 48.0;
/// Height of the line over the window's edge where it stands over the bar, and its width there, points.
const ABOVE_BAR: f32 = 56.0;
const LEAST_WIDTH: f32 = 256.0;

/// State of the line of help.
#[derive(Debug, Default)]
pub(super) struct FirstRun {
    /// True for a new painter; `None` before the window was first shown.
    is_new: Option<bool>,
    /// The painting that was last seen blank, and since when by the window's clock, s.
    blank: Option<(String, f64)>,
}

impl FirstRun {
    /// Tracks the painting, and shows the line while it helps, beside the part of the window covered by the palette.
    pub(super) fn show(
        &mut self,
        context: &Context,
        palette: Option<Rect>,
        rig: &RigState,
        preferences: &mut Preferences,
    ) {
        let is_new = *self.is_new.get_or_insert(!preferences.has_painted);
        // The transport bar stands there while a recording is played.
        if !is_new || rig.replay.is_some() {
            return;
        }
        let now = context.input(|input| input.time);
        let status = rig.live.paint.as_ref().map(|node| &node.status);
        let is_bare = status.is_none_or(|status| status.blank);
        if !is_bare {
            preferences.has_painted = true;
            self.blank = None;
            return;
        }
        if preferences.has_painted {
            let path = status.map_or("", |status| &status.path);
            let known = self.blank.take().filter(|(known, _)| known == path);
            let (_, since) = self.blank.insert(known.unwrap_or((path.to_owned(), now)));
            let left = *since + AGAIN_S - now;
            if left <= 0.0 {
                return;
            }
            context.request_repaint_after(Duration::from_secs_f64(left));
        }
        let hand = rig.brushes.get(rig.in_hand);
        let carried = hand.and_then(|brush| brush.carried.as_ref());
        let help = if carried.is_some_and(|carried| carried.load_share > 0.0) {
            tr!(
                "The brush is full: drag it over the canvas. For another colour clean it with {key}, and drag it through a paint of the palette.",
                key = preferences.keys.written(context, Action::Clean)
            )
        } else {
            translated(HELP).to_owned()
        };
        line(context, &help, palette, preferences);
    }
}

/// Light on dark, with an edge: it is read over any canvas and in either theme. It stands beside the rack, or over the bar
/// while the palette is beside the rack: it covers no paint.
fn line(context: &Context, help: &str, palette: Option<Rect>, preferences: &Preferences) {
    let rack = sides::rack_side(preferences);
    let middle = context.content_rect().center().x;
    let is_out = |palette: Rect| match rack {
        WindowSide::Right => palette.right() > middle,
        WindowSide::Left => palette.left() < middle,
    };
    let (side, aside, above, most) = if palette.is_some_and(is_out) {
        (rack.other(), BESIDE, ABOVE_BAR, LEAST_WIDTH)
    } else {
        (
            rack,
            sides::rack_at(preferences, rack) + BESIDE,
            ABOVE_NAME,
            WIDTH,
        )
    };
    let (_, corner, inward) = side.anchors();
    let aside = aside + sides::column_at(preferences, side);
    Area::new(Id::unique("help"))
        .order(Order::Foreground)
        .anchor(corner, [inward * aside, -above])
        .interactable(false)
        .show(context, |ui| {
            Frame::NONE
                .fill(Color32::from_black_alpha(225))
                .stroke(Stroke::new(1.0, Color32::from_gray(150)))
                .corner_radius(8.0)
                .inner_margin(Margin::symmetric(14, 8))
                .show(ui, |ui| {
                    ui.set_max_width(most);
                    let light = Color32::from_gray(240);
                    ui.label(RichText::new(help).color(light).size(15.0));
                    ui.add_space(6.0);
                    key_picture::show(ui, &preferences.keys, most, light);
                });
        });
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;
    use maulstick_types::paint::PaintStatus;

    use super::*;
    use crate::rig::carried_paint::CarriedPaint;
    use crate::test_support::panel_bench::{rig, status};

    struct Day {
        first_run: FirstRun,
        rig: RigState,
        preferences: Preferences,
        palette: Option<Rect>,
    }

    fn day(has_painted: bool) -> Harness<'static, Day> {
        let preferences = Preferences {
            has_painted,
            ..Preferences::default()
        };
        let day = Day {
            first_run: FirstRun::default(),
            rig: rig(),
            preferences,
            palette: None,
        };
        let show = |ui: &mut eframe::egui::Ui, day: &mut Day| {
            day.first_run
                .show(ui.ctx(), day.palette, &day.rig, &mut day.preferences);
        };
        let mut harness = Harness::builder()
            .with_size([800.0, 200.0])
            .with_step_dt(1.0)
            .build_ui_state(show, day);
        harness.step();
        harness
    }

    fn says(harness: &mut Harness<'static, Day>, change: impl FnOnce(&mut PaintStatus)) -> bool {
        let node = harness.state_mut().rig.live.paint.as_mut();
        change(&mut node.expect("a node").status);
        harness.run_steps(2);
        harness.query_by_label_contains(HELP).is_some()
    }

    #[test]
    fn the_line_goes_with_the_first_paint_and_is_over_the_next_painting_for_a_moment() {
        let mut harness = day(false);
        assert!(says(&mut harness, |status| (status.journal, status.undo) =
            (7, 1)));
        assert!(
            !harness.state().preferences.has_painted,
            "nothing is painted yet"
        );
        assert!(!says(&mut harness, |status| status.blank = false));
        assert!(harness.state().preferences.has_painted);
        let another = PaintStatus {
            path: "/another.maul".into(),
            ..status()
        };
        assert!(says(&mut harness, |status| *status = another));
        harness.run_steps(10);
        assert!(harness.query_by_label_contains(HELP).is_none());
    }

    #[test]
    fn a_full_brush_is_told_to_paint_and_a_clean_one_to_take_paint() {
        for (load_share, is_full) in [(0.0, false), (0.8, true)] {
            let mut harness = day(false);
            harness.state_mut().rig.brushes[0].carried = Some(CarriedPaint {
                colours: Vec::new(),
                load_share,
            });
            harness.run_steps(2);
            let takes = harness.query_by_label(HELP).is_some();
            let paints = harness
                .query_by_label_contains("The brush is full")
                .is_some();
            assert_eq!((takes, paints), (!is_full, is_full));
        }
    }

    #[test]
    fn who_has_painted_before_is_told_nothing() {
        let mut harness = day(true);
        assert!(!says(&mut harness, |status| status.path = "/new.maul".into()));
        assert!(!says(&mut harness, |status| status.blank = false));
    }

    #[test]
    fn the_line_gives_way_to_the_palette_at_either_side() {
        for left_handed in [false, true] {
            let mut harness = day(false);
            harness.state_mut().preferences.window.left_handed = left_handed;
            harness.set_size([1280.0, 800.0].into());
            for left in [0.0, 350.0, 600.0, 900.0] {
                let palette = Rect::from_min_size([left, 0.0].into(), [380.0, 800.0].into());
                harness.state_mut().palette = Some(palette);
                harness.run_steps(3);
                let line = harness.get_by_label_contains(HELP).rect();
                assert!(!line.intersects(palette), "{left}: {line:?}");
            }
        }
    }
}
