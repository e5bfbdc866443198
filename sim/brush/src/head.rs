//! The head: bristle strips interpolated from the spines (Baxter 2004, § 3.5.2).
//!
//! Each spine is a curve p_j(s), s from 0 at the ferrule to 1 at the point. A strip with its root
//! inside the hull of the spines' roots is their convex sum Σ w_j·p_j(s) (eq. 3.16); one outside
//! keeps the weights of the nearest point of the hull and stands farther from the middle by a
//! constant factor. Spines run straight from ferrule to point; the profile of the brush file gives
//! the strips their belly, and as the head is pressed down they open.

use glam::{DVec2, DVec3};
use maulstick_num::geometry::Rigid;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

use crate::file::BrushFile;
use crate::qp::DualSolver;
use crate::spine::{Spine, SpineShape};
use crate::tuft::{Seat, Tuft};

/// Stations along a strip.
pub const STATIONS: usize = 9;
/// Turn from strip to strip of a spiral that covers a disc evenly, rad.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
/// The head is fully open when its point would be this share of its length below the surface.
const OPEN_AT: f64 = 0.35;

/// The strips of a brush.
#[derive(Clone, Debug)]
pub struct Head {
    spine: Spine,
    seats: Vec<Seat>,
    strips: usize,
    /// Weights, a plane a spine.
    weights: Vec<Vec<f32>>,
    /// Distance from the middle where the root lies outside the hull of the spines, 1 inside.
    reach: Vec<f32>,
    /// Seeded, 0 to 1: how far a strip keeps off the surface while the head is hardly pressed.
    lift: Vec<f32>,
    /// Seeded, about 1: how much paint a strip takes by the mean of all.
    capacity: Vec<f32>,
    /// Half the head's width by that of the spines' cone at each station, at rest.
    closed: [f64; STATIONS],
    /// As `closed`, pressed down.
    open: [f64; STATIONS],
    length_m: f64,
}

/// Strips in space: planes of coordinates, `station · strips + strip`, station 0 at the ferrule.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeadPose {
    /// Right.
    pub x: Vec<f32>,
    /// Up along the surface.
    pub y: Vec<f32>,
    /// Above the surface: never below it.
    pub z: Vec<f32>,
    /// How far the head is pressed open, 0 to 1.
    pub press: f32,
}

/// Smooth from 0 at 0 to 1 at 1.
fn smoothstep(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

impl Head {
    /// The head of a brush file.
    #[must_use]
    pub fn of(file: &BrushFile) -> Self {
        let Tuft { seats, spine } = file.tuft();
        let roots: Vec<DVec2> = seats.iter().map(|seat| seat.root.truncate()).collect();
        let half = file.radius_m(0.0);
        let mut random = Pcg32::new(file.strips.seed, 1);
        let mut unit = || f64::from(random.next_u32()) / 4_294_967_296.0;
        let count = file.strips.count;
        let mut weights = vec![Vec::with_capacity(count); seats.len()];
        let [mut reach, mut lift, mut capacity] = [const { Vec::new() }; 3];
        for i in 0..count {
            let ring = (i as f64 + unit()) / count as f64;
            let turn = (i as f64 + 0.6 * unit()) * GOLDEN_ANGLE;
            let (sine, cosine) = maulstick_num::sin_cos(turn);
            let root = DVec2::new(cosine, sine) * (half * ring.sqrt());
            let outside = outside(&roots, root);
            let row = weights_of(&roots, root / outside);
            for (plane, weight) in weights.iter_mut().zip(row) {
                plane.push(weight as f32);
            }
            reach.push(outside as f32);
            lift.push(unit() as f32);
            capacity.push((1.0 + file.strips.unevenness * (2.0 * unit() - 1.0)) as f32);
        }
        let station = |i: usize| i as f64 / (STATIONS - 1) as f64;
        let (first, last) = (file.radius_m(0.0), file.radius_m(1.0));
        let cone = |s: f64| first + (last - first) * s;
        let opened = file.strips.open * 0.5e-3 * file.head.width_mm;
        Self {
            strips: count,
            weights,
            reach,
            lift,
            capacity,
            closed: std::array::from_fn(|i| file.radius_m(station(i)) / cone(station(i))),
            open: std::array::from_fn(|i| file.radius_m(station(i)).max(opened) / cone(station(i))),
            length_m: spine.length_m(),
            spine,
            seats,
        }
    }

    /// Number of strips.
    #[must_use]
    pub fn strips(&self) -> usize {
        self.strips
    }

    /// Stations along a strip.
    #[must_use]
    pub fn stations(&self) -> usize {
        STATIONS
    }

    /// How far each strip keeps off the surface while the head is hardly pressed, 0 to 1.
    #[must_use]
    pub fn lift(&self) -> &[f32] {
        &self.lift
    }

    /// How much paint each strip takes by the mean of all.
    #[must_use]
    pub fn capacity(&self) -> &[f32] {
        &self.capacity
    }

    /// Whether a state with this many joint angles belongs to this head.
    #[must_use]
    pub fn fits(&self, angles: usize) -> bool {
        angles == self.seats.len() * self.spine.joints()
    }

    /// The strips of a brush at `brush` (brush frame to surface frame) with the angles of its
    /// joints, spine after spine; in metres.
    pub fn pose(&self, brush: &Rigid, angles: &[[f32; 2]], into: &mut HeadPose) {
        self.pose_scaled(brush, angles, 1.0, into);
    }

    /// As [`pose`](Self::pose), with `per_m` units a metre.
    pub fn pose_scaled(&self, brush: &Rigid, angles: &[[f32; 2]], per_m: f64, into: &mut HeadPose) {
        let joints = self.spine.joints();
        let curves: Vec<[DVec3; STATIONS]> = self
            .seats
            .iter()
            .zip(angles.chunks(joints))
            .map(|(seat, angles)| {
                let held = seat.held(brush);
                let shape = SpineShape::from_angles(held.translation, held.rotation, angles);
                stations(&self.spine, &shape)
            })
            .collect();
        let unbent = brush.point(DVec3::new(0.0, 0.0, -self.length_m)).z;
        let press = smoothstep(-unbent / (OPEN_AT * self.length_m));
        into.press = press as f32;
        let count = self.strips * STATIONS;
        for plane in [&mut into.x, &mut into.y, &mut into.z] {
            plane.clear();
            plane.resize(count, 0.0);
        }
        let Some((middle, others)) = curves.split_first() else {
            return;
        };
        for station in 0..STATIONS {
            let center = middle[station];
            let spread = self.closed[station] + press * (self.open[station] - self.closed[station]);
            let row = station * self.strips..(station + 1) * self.strips;
            let planes = [
                &mut into.x[row.clone()],
                &mut into.y[row.clone()],
                &mut into.z[row],
            ];
            for (axis, plane) in planes.into_iter().enumerate() {
                for (curve, weights) in others.iter().zip(&self.weights[1..]) {
                    let off = ((curve[station][axis] - center[axis]) * spread * per_m) as f32;
                    plane
                        .iter_mut()
                        .zip(weights)
                        .for_each(|(p, w)| *p += w * off);
                }
                let center = (center[axis] * per_m) as f32;
                let floor = if axis == 2 { 0.0 } else { f32::MIN };
                plane
                    .iter_mut()
                    .zip(&self.reach)
                    .for_each(|(p, reach)| *p = (*p * reach + center).max(floor));
            }
        }
    }
}

/// A smooth curve through the joints (Catmull and Rom 1974) at the stations.
fn stations(spine: &Spine, shape: &SpineShape) -> [DVec3; STATIONS] {
    let joints = spine.joints();
    let at = |i: usize| {
        if i == 0 {
            shape.root
        } else {
            shape.joint(spine, i - 1)
        }
    };
    let knots: Vec<DVec3> = (0..=joints).map(at).collect();
    std::array::from_fn(|station| {
        let place = station as f64 / (STATIONS - 1) as f64 * joints as f64;
        let i = (place as usize).min(joints - 1);
        let t = place - i as f64;
        let (b, c) = (knots[i], knots[i + 1]);
        let a = if i == 0 {
            b - shape.base * spine.lengths_m[0]
        } else {
            knots[i - 1]
        };
        let d = if i + 2 <= joints {
            knots[i + 2]
        } else {
            c + (c - b)
        };
        let (t2, t3) = (t * t, t * t * t);
        (b * 2.0
            + (c - a) * t
            + (a * 2.0 - b * 5.0 + c * 4.0 - d) * t2
            + (b * 3.0 - a - c * 3.0 + d) * t3)
            * 0.5
    })
}

/// By how much a root lies outside the hull of the spines' roots: the first is the middle, the
/// others stand around it in order; 1 inside.
fn outside(roots: &[DVec2], root: DVec2) -> f64 {
    let ring = &roots[1..];
    let mut farthest = 1.0f64;
    for (i, a) in ring.iter().enumerate() {
        let b = ring[(i + 1) % ring.len()];
        let edge = b - *a;
        let normal = DVec2::new(edge.y, -edge.x);
        let (at, limit) = (normal.dot(root - roots[0]), normal.dot(*a - roots[0]));
        if limit > 0.0 {
            farthest = farthest.max(at / limit);
        }
    }
    farthest * (1.0 + 1e-9)
}

/// The weights of a root among the spines' (eq. 3.17-3.20): of those that put it where it is, the
/// ones that prefer near spines most.
fn weights_of(roots: &[DVec2], root: DVec2) -> Vec<f64> {
    /// Price of missing the sum or the place, by the squared size of the head; what is missed at it
    /// is added to what is wanted until nothing is (Hestenes 1969).
    const PRICE: f64 = 1e3;
    const ROUNDS: usize = 6;
    let m = roots.len();
    let size = roots
        .iter()
        .map(|other| other.length_squared())
        .fold(1e-18, f64::max);
    let place = |p: DVec2| [1.0, p.x / size.sqrt(), p.y / size.sqrt()];
    let rows: Vec<[f64; 3]> = roots.iter().map(|other| place(*other)).collect();
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut g = Vec::with_capacity(m * m);
    for (i, a) in rows.iter().enumerate() {
        for (j, b) in rows.iter().enumerate() {
            let near = (root - roots[i]).length_squared() / size;
            let own = if i == j { 2.0 * near } else { 0.0 };
            g.push(own + PRICE * dot(a, b));
        }
    }
    let goal = place(root);
    let mut wanted = goal;
    let mut weights = vec![1.0 / m as f64; m];
    let mut solver = DualSolver::default();
    for _ in 0..ROUNDS {
        let r: Vec<f64> = rows.iter().map(|row| PRICE * dot(row, &wanted)).collect();
        solver.solve(&g, &r, 1e-12, &mut weights);
        for (axis, wanted) in wanted.iter_mut().enumerate() {
            let got: f64 = rows
                .iter()
                .zip(&weights)
                .map(|(row, w)| row[axis] * w)
                .sum();
            *wanted += goal[axis] - got;
        }
    }
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head() -> (BrushFile, Head) {
        let file = BrushFile::library("round").expect("round");
        let head = Head::of(&file);
        (file, head)
    }

    fn rest(height: f64) -> HeadPose {
        let (file, head) = head();
        let brush = Rigid {
            translation: DVec3::new(0.1, 0.2, height),
            ..Rigid::IDENTITY
        };
        let angles = vec![[0.0; 2]; file.spines.number() * file.spines.joints];
        let mut pose = HeadPose::default();
        head.pose(&brush, &angles, &mut pose);
        pose
    }

    #[test]
    fn weights_are_convex_and_place_their_root() {
        let roots: Vec<DVec2> = std::iter::once(DVec2::ZERO)
            .chain((0..6).map(|i| {
                let (s, c) = maulstick_num::sin_cos(f64::from(i) * std::f64::consts::PI / 3.0);
                DVec2::new(c, s) * 3e-3
            }))
            .collect();
        for i in 0..200 {
            let (s, c) = maulstick_num::sin_cos(f64::from(i) * 0.7);
            let root = DVec2::new(c, s) * (2.5e-3 * f64::from(i) / 200.0);
            let weights = weights_of(&roots, root);
            let sum: f64 = weights.iter().sum();
            let place: DVec2 = roots.iter().zip(&weights).map(|(p, w)| *p * *w).sum();
            assert!((sum - 1.0).abs() < 1e-12 && weights.iter().all(|w| *w >= 0.0));
            assert!((place - root).length() < 1e-8, "{root} {place}");
            assert!(
                (place - root * 1.001).length() > 1e-8 || i < 5,
                "a fault would pass"
            );
        }
        for (i, root) in roots.iter().enumerate() {
            assert!(
                weights_of(&roots, *root)[i] > 1.0 - 1e-6,
                "a root on a spine's"
            );
        }
    }

    #[test]
    fn at_rest_the_strips_fill_the_profile() {
        let (file, head) = head();
        let pose = rest(0.1);
        assert_eq!(pose.press, 0.0);
        for station in 0..STATIONS {
            let s = station as f64 / (STATIONS - 1) as f64;
            let row = station * head.strips()..(station + 1) * head.strips();
            let widest = row
                .map(|i| (pose.x[i] - 0.1).hypot(pose.y[i] - 0.2))
                .fold(0.0, f32::max);
            let profile = file.radius_m(s) as f32;
            assert!(
                (0.8..1.05).contains(&(widest / profile)),
                "{s}: {widest} {profile}"
            );
        }
    }

    #[test]
    fn a_pressed_head_opens_and_stays_above_the_surface() {
        let (file, _) = head();
        let pose = rest(0.7 * file.length_m());
        assert!(pose.press > 0.5);
        assert!(pose.z.iter().all(|z| *z >= 0.0));
    }

    #[test]
    fn the_seed_places_the_strips() {
        let (mut file, head) = head();
        assert_eq!(Head::of(&file).lift, head.lift);
        file.strips.seed += 1;
        assert_ne!(Head::of(&file).lift, head.lift);
    }
}
