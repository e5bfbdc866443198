//! Place and size of the frame: it opens where it was put, but not over the palette, and only the painter moves it.

use eframe::egui::{Context, Pos2, Rect, Vec2, Window, pos2, vec2};

use crate::reference::settings::ReferencePreferences;
use crate::settings::preferences::Preferences;

/// Title and edges of a window around its inside, points.
const AROUND: Vec2 = vec2(16.0, 44.0);
/// Distance from the palette, points.
const ASIDE: f32 = 8.0;

/// State of the frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PictureFrame {
    /// True once it has its place.
    is_placed: bool,
    /// Its rectangle when a button of the pointer was pressed.
    held: Option<Rect>,
}

impl PictureFrame {
    /// Gives the window its place when it opens.
    pub(super) fn placed<'a>(
        &mut self,
        window: Window<'a>,
        context: &Context,
        palette: Option<Rect>,
        preferences: &ReferencePreferences,
    ) -> Window<'a> {
        if std::mem::replace(&mut self.is_placed, true) {
            return window;
        }
        let outer = Vec2::from(preferences.size) + AROUND;
        let room = context.content_rect();
        window.current_pos(opening(preferences.place.into(), outer, palette, room))
    }

    /// Remembers where the painter has put the window, once it is let go.
    pub(super) fn keep(&mut self, context: &Context, now: Rect, preferences: &mut Preferences) {
        if context.input(|input| input.pointer.any_down()) {
            self.held.get_or_insert(now);
            return;
        }
        let Some(before) = self.held.take() else {
            return;
        };
        let kept = &mut preferences.reference;
        if before.min != now.min {
            kept.place = now.min.round().into();
        }
        let wider = now.size() - before.size();
        if wider != Vec2::ZERO {
            kept.size = (Vec2::from(kept.size) + wider).round().into();
        }
    }
}

/// Position at which a window of this size opens that was last at `place`: within the room, and beside the palette if
/// it would cover it.
fn opening(place: Pos2, size: Vec2, palette: Option<Rect>, room: Rect) -> Pos2 {
    let last = (room.max - size).max(room.min);
    let place = place.clamp(room.min, last);
    let Some(palette) = palette.filter(|palette| {
        let covered = palette.intersect(Rect::from_min_size(place, size));
        covered.is_positive()
    }) else {
        return place;
    };
    let right = palette.right() + ASIDE;
    let left = palette.left() - ASIDE - size.x;
    let x = if right <= last.x || left < room.left() {
        right.min(last.x)
    } else {
        left
    };
    pos2(x, place.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_opens_where_it_was_put_within_the_window_and_beside_the_palette() {
        let room = Rect::from_min_size(Pos2::ZERO, vec2(1280.0, 800.0));
        let size = vec2(336.0, 364.0);
        let at = |x: f32, y: f32, palette| opening(pos2(x, y), size, palette, room);
        assert_eq!(at(500.0, 90.0, None), pos2(500.0, 90.0));
        assert_eq!(at(5000.0, 900.0, None), pos2(944.0, 436.0));
        let left = Rect::from_min_max(pos2(-300.0, 50.0), pos2(180.0, 750.0));
        assert_eq!(at(500.0, 90.0, Some(left)), pos2(500.0, 90.0));
        assert_eq!(at(24.0, 24.0, Some(left)), pos2(188.0, 24.0));
        let right = Rect::from_min_max(pos2(1000.0, 50.0), pos2(1600.0, 750.0));
        assert_eq!(at(900.0, 90.0, Some(right)), pos2(656.0, 90.0));
        // A palette that lies over all of it leaves no place.
        let all = Rect::from_min_max(pos2(100.0, 0.0), pos2(1200.0, 800.0));
        assert_eq!(at(300.0, 90.0, Some(all)), pos2(944.0, 90.0));
    }
}
