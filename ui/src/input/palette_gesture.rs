//! The palette gesture: a wave of the brush beyond the palette's side brings it, like the space bar.

use glam::DVec2;
use maulstick_brush::palette_place::Side;

/// Distance from the middle beyond which a brush is off the view, as a share of the width: in a full-screen window the
/// pointer stops at the edge.
const OFF: f64 = 0.498;
/// A brush that waves goes at least this fast, m/s.
const FAST_M_S: f64 = 0.15;

/// Detects the gesture from successive positions of the brush.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PaletteGesture {
    last: Option<(DVec2, f64)>,
    /// Set once it has waved, until it has come back.
    gone: bool,
}

impl PaletteGesture {
    /// Tracks the brush: `at` in the view's shares of its width and height from the middle (−½ to ½ is in view),
    /// `None` without a brush; `wide_m` the view's width; `in_air` if it touches nothing.
    pub(crate) fn follow(
        &mut self,
        now_s: f64,
        at: Option<DVec2>,
        wide_m: f64,
        in_air: bool,
        side: Side,
    ) -> bool {
        let Some(at) = at else {
            self.last = None;
            return false;
        };
        let off = match side {
            Side::Left => -at.x,
            Side::Right => at.x,
        };
        let before = self.last.replace((DVec2::new(off, at.y), now_s));
        if off < 0.45 {
            self.gone = false;
        }
        let Some((from, since)) = before else {
            return false;
        };
        let way = (off - from.x) * wide_m;
        let fast = way > FAST_M_S * (now_s - since).max(1e-3);
        let waves = off > OFF && in_air && fast && !self.gone;
        self.gone |= off > OFF;
        waves
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waves(way: impl Fn(f64) -> f64, in_air: bool, side: Side) -> usize {
        let mut palette_gesture = PaletteGesture::default();
        (0..200)
            .filter(|i| {
                let now = f64::from(*i) * 0.01;
                palette_gesture.follow(now, Some(DVec2::new(way(now), 0.0)), 0.5, in_air, side)
            })
            .count()
    }

    #[test]
    fn one_wave_calls_once_and_only_toward_the_palette() {
        let off = |t: f64| -2.0 * t;
        assert_eq!(waves(off, true, Side::Left), 1);
        assert_eq!(waves(off, true, Side::Right), 0);
        assert_eq!(waves(|t| 2.0 * t, true, Side::Right), 1);
        assert_eq!(waves(off, false, Side::Left), 0, "a stroke is no wave");
        assert_eq!(waves(|t| -0.1 * t - 0.4, true, Side::Left), 0, "too slow");
        let twice = |t: f64| if t < 1.0 { -2.0 * t } else { -2.0 * (t - 1.0) };
        assert_eq!(waves(twice, true, Side::Left), 2);
    }
}
