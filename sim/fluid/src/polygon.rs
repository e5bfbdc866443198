//! Shares of boxes that convex shapes cover.

use maulstick_num::sin_cos;

/// A convex shape about its own origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Corners, counterclockwise, m.
    corners: Vec<[f64; 2]>,
    /// Radii of the circles about the origin within all edges, and around all corners, m.
    radii_m: [f64; 2],
}

/// Corners of the polygon that stands for a disc.
const DISC_CORNERS: usize = 256;

impl Shape {
    fn new(corners: Vec<[f64; 2]>) -> Self {
        let squares = corners.iter().map(|[x, y]| x * x + y * y);
        let outer = squares.fold(0.0, f64::max).sqrt();
        let placed = Placed {
            corners,
            middle: [0.0; 2],
            radii_m: [0.0, outer],
        };
        let inner = placed.edge_depth([0.0; 2]);
        Self {
            corners: placed.corners,
            radii_m: [inner, outer],
        }
    }

    /// A square of side `side_m`.
    #[must_use]
    pub fn square(side_m: f64) -> Self {
        let a = 0.5 * side_m;
        Self::new(vec![[-a, -a], [a, -a], [a, a], [-a, a]])
    }

    /// A disc of radius `radius_m`: a polygon of the same area.
    #[must_use]
    pub fn disc(radius_m: f64) -> Self {
        let step = 2.0 * std::f64::consts::PI / DISC_CORNERS as f64;
        let (sine, _) = sin_cos(step);
        let outer = radius_m * (step / sine).sqrt();
        let corner = |i: usize| {
            let (sine, cosine) = sin_cos(i as f64 * step);
            [outer * cosine, outer * sine]
        };
        Self::new((0..DISC_CORNERS).map(corner).collect())
    }

    /// The shape at a place, turned by `angle`.
    #[must_use]
    pub(crate) fn placed(&self, [x, y]: [f64; 2], angle: f64) -> Placed {
        let (sine, cosine) = sin_cos(angle);
        let turn = |[a, b]: &[f64; 2]| [x + cosine * a - sine * b, y + sine * a + cosine * b];
        Placed {
            corners: self.corners.iter().map(turn).collect(),
            middle: [x, y],
            radii_m: self.radii_m,
        }
    }
}

/// A shape at a place.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    corners: Vec<[f64; 2]>,
    middle: [f64; 2],
    radii_m: [f64; 2],
}

impl Placed {
    /// Lower and upper ends of a box that holds the shape, m.
    pub(crate) fn bounds(&self) -> [[f64; 2]; 2] {
        let ends = |sign: f64| self.middle.map(|at| at + sign * self.radii_m[1]);
        [ends(-1.0), ends(1.0)]
    }

    /// A lower bound of the distance of a place from the outline, m; positive within, and exact near it.
    fn depth(&self, place: [f64; 2], near_m: f64) -> f64 {
        let [x, y] = [place[0] - self.middle[0], place[1] - self.middle[1]];
        let off = (x * x + y * y).sqrt();
        let [inner, outer] = self.radii_m;
        if off <= inner - near_m {
            inner - off
        } else if off >= outer + near_m {
            outer - off
        } else {
            self.edge_depth(place)
        }
    }

    /// Least distance of a place from the edges' lines, m; positive within.
    fn edge_depth(&self, [x, y]: [f64; 2]) -> f64 {
        let mut least = f64::INFINITY;
        for (from, to) in self.edges() {
            let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
            let length = (dx * dx + dy * dy).sqrt();
            least = least.min((dx * (y - from[1]) - dy * (x - from[0])) / length);
        }
        least
    }

    /// True if a place is within.
    pub(crate) fn contains(&self, place: [f64; 2]) -> bool {
        self.depth(place, 0.0) > 0.0
    }

    fn edges(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().copied().zip(next.copied())
    }

    /// Share of the square of side `side` around a place that the shape covers.
    pub(crate) fn share(&self, [x, y]: [f64; 2], side: f64) -> f64 {
        // Half a diagonal.
        let reach = 0.75 * side;
        let depth = self.depth([x, y], reach);
        if depth >= reach {
            return 1.0;
        }
        if depth <= -reach {
            return 0.0;
        }
        let a = 0.5 * side;
        let mut left = vec![
            [x - a, y - a],
            [x + a, y - a],
            [x + a, y + a],
            [x - a, y + a],
        ];
        for (from, to) in self.edges() {
            left = cut(&left, from, to);
        }
        (area(&left) / (side * side)).clamp(0.0, 1.0)
    }
}

/// The part of a convex polygon to the left of a line (Sutherland and Hodgman 1974).
fn cut(polygon: &[[f64; 2]], from: [f64; 2], to: [f64; 2]) -> Vec<[f64; 2]> {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let side = |[x, y]: [f64; 2]| dx * (y - from[1]) - dy * (x - from[0]);
    let mut left = Vec::with_capacity(polygon.len() + 1);
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (sa, sb) = (side(*a), side(b));
        if sa >= 0.0 {
            left.push(*a);
        }
        if (sa > 0.0 && sb < 0.0) || (sa < 0.0 && sb > 0.0) {
            let t = sa / (sa - sb);
            left.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
        }
    }
    left
}

fn area(polygon: &[[f64; 2]]) -> f64 {
    let mut twice = 0.0;
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    0.5 * twice
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_all_boxes_are_the_area_of_the_shape() {
        for (shape, expected) in [
            (Shape::square(0.3), 0.09),
            (Shape::disc(0.2), std::f64::consts::PI * 0.04),
        ] {
            let placed = shape.placed([0.53, 0.48], 0.4);
            let h = 1.0 / 40.0;
            let mut sum = 0.0;
            for j in 0..40 {
                for i in 0..40 {
                    let place = [(f64::from(i) + 0.5) * h, (f64::from(j) + 0.5) * h];
                    sum += placed.share(place, h) * h * h;
                }
            }
            println!("{sum}, expected {expected}");
            assert!((sum - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn a_box_is_covered_as_far_as_the_edge_has_come() {
        let placed = Shape::square(1.0).placed([0.0, 0.0], 0.0);
        for (x, expected) in [(0.45, 1.0), (0.5, 0.5), (0.525, 0.25), (0.6, 0.0)] {
            assert!((placed.share([x, 0.0], 0.1) - expected).abs() < 1e-12);
        }
        assert!((placed.share([0.5, 0.5], 0.1) - 0.25).abs() < 1e-12);
    }
}
