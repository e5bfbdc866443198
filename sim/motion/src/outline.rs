//! An area on the desk enclosed by closed polygons, and the parts of lines within it at a distance from its edge.

use glam::DVec2;
use maulstick_num::sin_cos;
use maulstick_types::limits::FARTHEST_M;

use crate::MotionError;

/// Smallest area, m².
const LEAST_M2: f64 = 1e-8;

/// An area: a point is within where a line from it crosses the contours an odd number of times.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Edges by their ends, m.
    edges: Vec<[DVec2; 2]>,
}

/// A direction in the plane and the one across it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    along: DVec2,
}

impl Frame {
    /// The frame whose first axis is turned by this from x, rad.
    #[must_use]
    pub fn turned(by_rad: f64) -> Self {
        let (s, c) = sin_cos(by_rad);
        Self {
            along: DVec2::new(c, s),
        }
    }

    /// A point in this frame: along and across, m.
    #[must_use]
    pub fn of(self, at: DVec2) -> DVec2 {
        DVec2::new(at.dot(self.along), at.dot(self.along.perp()))
    }

    /// A point of this frame in the desk's, m.
    #[must_use]
    pub fn to_desk(self, at: DVec2) -> DVec2 {
        self.along * at.x + self.along.perp() * at.y
    }
}

impl Outline {
    /// The area of closed contours, each a list of points, m; the last one joins the first.
    ///
    /// # Errors
    /// [`MotionError::NoArea`]; [`MotionError::OutOfRange`] for a point off the desk.
    pub fn new(contours: &[Vec<[f64; 2]>]) -> Result<Self, MotionError> {
        for metres in contours.iter().flatten().flatten() {
            crate::error::within("a point at", *metres, -FARTHEST_M..=FARTHEST_M)?;
        }
        let mut edges = Vec::new();
        let mut area_m2 = 0.0;
        for contour in contours {
            let points: Vec<DVec2> = contour.iter().map(|at| DVec2::from_array(*at)).collect();
            let nexts = points.iter().cycle().skip(1);
            let own = points.iter().zip(nexts).filter(|(a, b)| a != b);
            let own: Vec<[DVec2; 2]> = own.map(|(a, b)| [*a, *b]).collect();
            area_m2 += (0.5 * own.iter().map(|[a, b]| a.perp_dot(*b)).sum::<f64>()).abs();
            edges.extend(own);
        }
        if area_m2 > LEAST_M2 {
            Ok(Self { edges })
        } else {
            Err(MotionError::NoArea)
        }
    }

    /// Least and greatest coordinate along and across in a frame, m.
    #[must_use]
    pub fn bounds(&self, frame: Frame) -> [[f64; 2]; 2] {
        let places = self.edges.iter().map(|[at, _]| frame.of(*at));
        let none = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        places.fold(none, |[[u0, u1], [v0, v1]], at| {
            [[u0.min(at.x), u1.max(at.x)], [v0.min(at.y), v1.max(at.y)]]
        })
    }

    /// Parts of the line at `across` that are within, and at least `clearance_m` from the edge: their beginnings and
    /// ends along it, m.
    #[must_use]
    pub fn spans(&self, frame: Frame, across: f64, clearance_m: f64) -> Vec<[f64; 2]> {
        let edges = self.edges.iter().map(|ends| ends.map(|at| frame.of(at)));
        let mut crossings = Vec::new();
        let mut near = Vec::new();
        for [a, b] in edges {
            // An end on the line counts for one of its two edges.
            if (a.y <= across) != (b.y <= across) {
                crossings.push(a.x + (across - a.y) / (b.y - a.y) * (b.x - a.x));
            }
            near.extend(near_segment([a, b], across, clearance_m));
        }
        crossings.sort_by(f64::total_cmp);
        near.sort_by(|a: &[f64; 2], b| a[0].total_cmp(&b[0]));
        let mut spans = Vec::new();
        for pair in crossings.chunks_exact(2) {
            let mut from = pair[0];
            for [start, end] in &near {
                if *end <= from || *start >= pair[1] {
                    continue;
                }
                if *start > from {
                    spans.push([from, *start]);
                }
                from = from.max(*end);
            }
            if from < pair[1] {
                spans.push([from, pair[1]]);
            }
        }
        spans
    }

    /// True if a point is within, and at least `clearance_m` from the edge.
    #[must_use]
    pub fn holds(&self, at: DVec2, clearance_m: f64) -> bool {
        let mut is_within = false;
        for [a, b] in &self.edges {
            if (a.y <= at.y) != (b.y <= at.y) {
                let crossing = a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x);
                is_within ^= crossing > at.x;
            }
            let way = *b - *a;
            let share = ((at - *a).dot(way) / way.length_squared()).clamp(0.0, 1.0);
            if (at - (*a + way * share)).length_squared() < clearance_m * clearance_m {
                return false;
            }
        }
        is_within
    }
}

/// The part of the line at `across` that is nearer to a segment than `radius`, if any: convexity leaves at most one.
fn near_segment([a, b]: [DVec2; 2], across: f64, radius: f64) -> Option<[f64; 2]> {
    let mut ends: Option<[f64; 2]> = None;
    let mut take = |u: f64| {
        let [least, most] = ends.unwrap_or([u, u]);
        ends = Some([least.min(u), most.max(u)]);
    };
    for end in [a, b] {
        let off = across - end.y;
        if off.abs() < radius {
            let half = (radius * radius - off * off).sqrt();
            take(end.x - half);
            take(end.x + half);
        }
    }
    let side = (b - a).normalize_or_zero().perp() * radius;
    let corners = [a + side, b + side, b - side, a - side];
    for (number, corner) in corners.iter().enumerate() {
        let next = corners[(number + 1) % 4];
        if (corner.y <= across) != (next.y <= across) {
            take(corner.x + (across - corner.y) / (next.y - corner.y) * (next.x - corner.x));
        }
    }
    ends.filter(|[least, most]| most > least)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 40 mm with a hole of 10 mm in its middle.
    fn ring() -> Outline {
        let square = |half: f64| vec![[-half, -half], [half, -half], [half, half], [-half, half]];
        Outline::new(&[square(0.02), square(0.005)]).expect("an area")
    }

    #[test]
    fn a_line_lies_within_between_edges_and_holes() {
        let spans = ring().spans(Frame::turned(0.0), 0.0, 0.0);
        assert_eq!(spans, [[-0.02, -0.005], [0.005, 0.02]]);
        let clear = ring().spans(Frame::turned(0.0), 0.0, 0.002);
        let expected = [[-0.018, -0.007], [0.007, 0.018]];
        for (got, wanted) in clear.iter().flatten().zip(expected.iter().flatten()) {
            assert!((got - wanted).abs() < 1e-15, "{clear:?}");
        }
        assert_eq!(clear.len(), 2);
        assert!(ring().spans(Frame::turned(0.3), 0.0, 0.009).is_empty());
        // Beside the hole's corner the distance is that of the corner.
        let [[_, end], [start, _]] = ring().spans(Frame::turned(0.0), 0.006, 0.002)[..] else {
            panic!("two parts");
        };
        let half = 0.005 + (0.002f64 * 0.002 - 0.001 * 0.001).sqrt();
        assert!((end + half).abs() < 1e-15 && (start - half).abs() < 1e-15);
    }

    #[test]
    fn spans_are_what_points_say_in_whatever_direction() {
        let star: Vec<[f64; 2]> = (0..10)
            .map(|corner| {
                let (s, c) = sin_cos(f64::from(corner) * 0.6283);
                let radius = if corner % 2 == 0 { 0.05 } else { 0.02 };
                [radius * c, radius * s]
            })
            .collect();
        let star = Outline::new(&[star]).expect("an area");
        // Step of the walk along each line, and tolerance of its ends.
        let step = 1e-4;
        let agree = |clearance: f64, asked: f64| {
            (0..40).all(|number| {
                let frame = Frame::turned(f64::from(number) * 0.1);
                let across = -0.045 + f64::from(number) * 0.0023;
                let spans = star.spans(frame, across, clearance);
                (-600..600).all(|walked| {
                    let along = f64::from(walked) * step;
                    let at = frame.to_desk(DVec2::new(along, across));
                    let is_near_an_end =
                        spans.iter().flatten().any(|end| (end - along).abs() < 1e-9);
                    let in_span = spans.iter().any(|[a, b]| (*a..=*b).contains(&along));
                    is_near_an_end || in_span == star.holds(at, asked)
                })
            })
        };
        for clearance in [0.0, 0.001, 0.004] {
            assert!(agree(clearance, clearance), "{clearance}");
            assert!(!agree(clearance, clearance + 0.0005), "a fault passes");
        }
    }

    #[test]
    fn what_encloses_nothing_is_refused() {
        let none = Outline::new(&[vec![[0.0, 0.0], [0.1, 0.0]]]);
        assert_eq!(none, Err(MotionError::NoArea));
        let far = Outline::new(&[vec![[0.0, 0.0], [f64::NAN, 0.0], [0.0, 1.0]]]);
        assert!(
            matches!(far, Err(MotionError::OutOfRange { .. })),
            "{far:?}"
        );
    }
}
