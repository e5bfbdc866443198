//! The view while a brush touches the desk: it stays as it is, for a view that moves under a held brush drags it over
//! canvas and palette. Panels, the size of window and text, a mirror and another side of the palette count once it lifts.

use eframe::egui::{Pos2, Rect};

use crate::view::camera::View;

/// Window of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    /// Pixels a point.
    pub pixels_per_point: f32,
    /// Its upper left corner on the screen, pixels; the origin where the window system does not tell.
    pub corner_px: Pos2,
}

/// The view that is shown.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HeldView {
    shown: Option<(View, Frame)>,
}

impl HeldView {
    /// The view to show: the one that is wanted, or the one before while a brush holds it, at the same pixels of the
    /// screen.
    pub(crate) fn follow(
        &mut self,
        wanted: Option<View>,
        frame: Frame,
        is_held: bool,
    ) -> Option<View> {
        let kept = self.shown.filter(|_| is_held);
        let view = match kept {
            Some((view, before)) => Some(moved(view, before, frame)),
            None => wanted,
        };
        self.shown = view.map(|view| (view, frame));
        view
    }
}

/// A view of another frame, at the same pixels of the screen.
fn moved(view: View, before: Frame, now: Frame) -> View {
    let factor = before.pixels_per_point / now.pixels_per_point;
    let shift = (before.corner_px - now.corner_px) / now.pixels_per_point;
    let place = |at: Pos2| (at.to_vec2() * factor).to_pos2() + shift;
    View {
        area: Rect::from_min_max(place(view.area.min), place(view.area.max)),
        scale: view.scale * f64::from(factor),
        ..view
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{pos2, vec2};
    use glam::DVec2;

    use super::*;

    fn view(width: f32) -> View {
        View {
            area: Rect::from_min_size(pos2(0.0, 0.0), vec2(width, 600.0)),
            middle: DVec2::new(0.01, 0.0),
            scale: f64::from(width) * 4.0,
            mirrored: false,
            room: DVec2::new(0.2, 0.2),
        }
    }

    const FRAME: Frame = Frame {
        pixels_per_point: 1.0,
        corner_px: pos2(100.0, 50.0),
    };

    #[test]
    fn a_view_waits_until_the_brush_lifts() {
        let mut held = HeldView::default();
        assert_eq!(
            held.follow(Some(view(1000.0)), FRAME, true),
            Some(view(1000.0))
        );
        assert_eq!(
            held.follow(Some(view(700.0)), FRAME, true),
            Some(view(1000.0))
        );
        assert_eq!(held.follow(None, FRAME, true), Some(view(1000.0)));
        assert_eq!(
            held.follow(Some(view(700.0)), FRAME, false),
            Some(view(700.0))
        );
        assert_eq!(held.follow(None, FRAME, false), None);
    }

    #[test]
    fn what_lies_under_a_pixel_of_the_screen_stays_there_while_window_and_text_change_their_size() {
        let mut held = HeldView::default();
        let before = held
            .follow(Some(view(1000.0)), FRAME, false)
            .expect("a view");
        let full = Frame {
            pixels_per_point: 1.25,
            corner_px: pos2(0.0, 0.0),
        };
        let now = held.follow(Some(view(1500.0)), full, true).expect("held");
        for [x, y] in [[120.0, 80.0], [700.0, 400.0]] {
            let at = |frame: Frame| pos2(x, y) - frame.corner_px.to_vec2();
            let point = |frame: Frame| (at(frame).to_vec2() / frame.pixels_per_point).to_pos2();
            let (one, other) = (before.on_desk(point(FRAME)), now.on_desk(point(full)));
            assert!(one.distance(other) < 1e-6, "{one} {other}");
        }
    }
}
