//! Strokes of a take as lines, as wide as they are pressed.

use eframe::egui::{Color32, Painter, Pos2, Rect, Stroke, pos2, vec2};
use maulstick_device::Take;
use maulstick_motion::strokes;
use maulstick_motion::strokes::middle;

/// Points of a path are drawn where they lie at least this share of the whole apart.
const APART: f64 = 0.01;
/// Points that are drawn of a take at most: of a long one each stroke has fewer.
const MOST: usize = 6_000;
/// Least and greatest width of a line, points.
const WIDTHS: [f32; 2] = [0.7, 4.0];

/// Paths of a take's strokes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct DrawnPaths {
    /// Points by stroke: x and y, m, and how far the brush is pressed in.
    pub strokes: Vec<Vec<[f64; 3]>>,
    /// Middle of the rectangle around them, m.
    pub middle: [f64; 2],
    /// Half of its larger side, m.
    pub half_m: f64,
}

impl DrawnPaths {
    /// Those of a take; `head_m` is the length of the head that a 6-DOF stylus holds.
    #[must_use]
    pub(crate) fn of(take: &Take, head_m: f64) -> Self {
        let all = strokes(&take.samples, head_m);
        let paths: Vec<Vec<[f64; 3]>> = all
            .iter()
            .map(|stroke| stroke.path(&take.samples, head_m))
            .collect();
        let middle = middle(&take.samples, head_m);
        let far = |[x, y, _]: &[f64; 3]| (x - middle[0]).abs().max((y - middle[1]).abs());
        let half_m = paths.iter().flatten().map(far).fold(1e-4, f64::max);
        let count: usize = paths.iter().map(Vec::len).sum();
        let apart = APART * half_m * (count.div_ceil(MOST)) as f64;
        let strokes = paths.into_iter().map(|path| thinned(path, apart)).collect();
        Self {
            strokes,
            middle,
            half_m,
        }
    }

    /// Draws them where `place` has each point, m; `scale` is that of their widths.
    pub(crate) fn draw(
        &self,
        painter: &Painter,
        colour: Color32,
        scale: f32,
        place: impl Fn([f64; 2]) -> Pos2,
    ) {
        let [least, most] = WIDTHS;
        for path in &self.strokes {
            let at = |point: &[f64; 3]| place([point[0], point[1]]);
            let width = |press: f64| scale * (least + (most - least) * press as f32);
            for pair in path.windows(2) {
                let stroke = Stroke::new(width(0.5 * (pair[0][2] + pair[1][2])), colour);
                painter.line_segment([at(&pair[0]), at(&pair[1])], stroke);
            }
            if let [dab] = &path[..] {
                painter.circle_filled(at(dab), 0.5 * width(dab[2]), colour);
            }
        }
    }

    /// Draws them into a rectangle.
    pub(crate) fn draw_within(&self, painter: &Painter, colour: Color32, within: Rect) {
        let half = 0.5 * within.size().min_elem() - WIDTHS[1];
        let place = |[x, y]: [f64; 2]| {
            let [x, y] = [x - self.middle[0], y - self.middle[1]];
            let share = vec2((x / self.half_m) as f32, (-y / self.half_m) as f32);
            within.center() + half.max(1.0) * share
        };
        let clipped = painter.with_clip_rect(within.intersect(painter.clip_rect()));
        self.draw(&clipped, colour, 0.6, |at| {
            let at = place(at);
            pos2(at.x, at.y)
        });
    }
}

/// A path without the points that lie nearer to the one before than `apart`; its ends stay.
fn thinned(path: Vec<[f64; 3]>, apart: f64) -> Vec<[f64; 3]> {
    let mut kept: Vec<[f64; 3]> = Vec::new();
    let last = path.len().saturating_sub(1);
    for (number, point) in path.into_iter().enumerate() {
        let is_far = kept.last().is_none_or(|before| {
            let [x, y] = [0, 1].map(|axis| point[axis] - before[axis]);
            x * x + y * y >= apart * apart
        });
        if is_far || number == last {
            kept.push(point);
        }
    }
    kept
}
