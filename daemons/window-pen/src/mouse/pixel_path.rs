//! Path of a pointer that goes in whole pixels, without their steps.
//!
//! Along the stroke places are unchanged; across it they follow a line that turns with them, an α-β filter by travelled
//! distance: so nothing lags behind the hand.

use glam::DVec2;
use maulstick_num::exp;

/// Distance over which lateral changes are followed, pixels.
const FOLLOWED: f64 = 6.0;
/// A place farther than this beside the line is a corner, pixels: the path goes there at once.
const CORNER: f64 = 1.6;

/// Distance after which a stroke has a direction again, pixels.
const TELLING: f64 = 6.0;

/// The path of a stroke.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PixelPath {
    at: Option<DVec2>,
    /// Direction, a unit vector; `None` while it is unknown.
    along: Option<DVec2>,
    /// Place where it became unknown.
    corner: DVec2,
}

impl PixelPath {
    /// Begins a stroke in a direction, a unit vector.
    pub(super) fn begin(&mut self, along: DVec2) {
        *self = Self {
            along: Some(along),
            ..Self::default()
        };
    }

    /// The next place of the path for one of the pointer, in pixels of `pixel_m`.
    pub(super) fn smooth(&mut self, to: DVec2, pixel_m: f64) -> DVec2 {
        let Some(from) = self.at.filter(|_| pixel_m > 0.0) else {
            (self.at, self.corner) = (Some(to), to);
            return to;
        };
        let way = to - from;
        let goes_on =
            |along: &DVec2| way.dot(*along) >= 0.0 && along.perp_dot(way).abs() <= CORNER * pixel_m;
        let Some(along) = self.along.filter(goes_on) else {
            if self.along.take().is_some() {
                self.corner = to;
            }
            let way = to - self.corner;
            let is_known = way.length() >= TELLING * pixel_m;
            self.along = is_known.then(|| way.normalize_or_zero());
            self.at = Some(to);
            return to;
        };
        let (gone, beside) = (way.dot(along), along.perp_dot(way));
        let gain = 1.0 - exp(-gone / (FOLLOWED * pixel_m));
        if gone > 0.0 {
            let turn = gain * gain / (2.0 - gain) * beside / gone;
            self.along = Some((along + along.perp() * turn).normalize_or_zero());
        }
        let at = from + along * gone + along.perp() * (gain * beside);
        self.at = Some(at);
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIXEL_M: f64 = 0.4e-3;

    /// A pixel up in ten across: the raw places leap by a whole one.
    #[test]
    fn a_slanting_stroke_has_no_steps() {
        let mut path = PixelPath::default();
        path.begin(DVec2::new(10.0, 1.0).normalize_or_zero());
        let raw = |step: u32| DVec2::new(f64::from(step), f64::from(step / 10)) * PIXEL_M;
        let places: Vec<DVec2> = (0..200)
            .map(|step| path.smooth(raw(step), PIXEL_M))
            .collect();
        let rises = places.windows(2).map(|two| two[1].y - two[0].y);
        let steepest = rises.fold(0.0, f64::max) / PIXEL_M;
        assert!(steepest < 0.4, "{steepest} of a pixel");
    }

    #[test]
    fn a_corner_is_kept_and_a_curve_followed() {
        let mut path = PixelPath::default();
        let corner = [
            [0.0, 0.0],
            [10.0, 0.0],
            [20.0, 0.0],
            [20.0, 10.0],
            [20.0, 20.0],
        ];
        for [x, y] in corner {
            let to = DVec2::new(x, y) * PIXEL_M;
            assert!(path.smooth(to, PIXEL_M).distance(to) < 0.1 * PIXEL_M);
        }
        let mut path = PixelPath::default();
        let mut farthest = 0.0_f64;
        for step in 0..400 {
            let (sine, cosine) = maulstick_num::sin_cos(0.02 * f64::from(step));
            let to = DVec2::new(cosine, sine) * 40.0 * PIXEL_M;
            farthest = farthest.max(path.smooth(to, PIXEL_M).distance(to));
        }
        assert!(farthest < 1.6 * PIXEL_M, "{farthest}");
    }
}
