//! The head: bristle strips interpolated from the spines (Baxter 2004, § 3.5.2), and the skin around them.
//!
//! Each spine is a curve p_j(s), s from 0 at the ferrule to 1 at the point. A strip's root within the hull of the
//! spines' roots is their convex sum, and so is the strip, Σ w_j·p_j(s) (eq. 3.16). The head's profile adds an offset
//! at each station, in a frame that turns with the middle of the head. A root outside the hull has the weights of the
//! hull's nearest point. As the head is pressed down the strips open, and wet ones come together in clumps.

mod angles;
mod beside;
mod clump;
pub mod curve;
pub mod disorder;
mod lay;
pub mod place;
pub mod weights;

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec2, DVec3};
use maulstick_num::atan2;
use maulstick_num::geometry::{Rigid, shortest_arc};

use self::curve::{Curve, curve, middle};
use self::disorder::Straying;
use self::lay::{draw_back, place_strips};
use self::place::Random;
use self::weights::{nearest_in_hull, weights_of};
use crate::file::BrushFile;
use crate::file::sections::Hair;
use crate::skin::{Skin, SkinPose};
use crate::spine::SpineShape;
use crate::spine_layout::SpineLayout;
use crate::spine_root::SpineRoot;

/// Number of stations along a strip.
pub const STATIONS: usize = 9;
/// Depth of the point below the surface, as a share of the head's length, at which the head is fully open.
const OPEN_AT: f64 = 0.35;

/// The strips of a brush. A copy shares what no disorder changes.
#[derive(Clone, Debug)]
pub struct Head {
    spine_roots: Arc<[SpineRoot]>,
    joints: usize,
    strips: usize,
    /// Weights of the strips, one plane a spine.
    weights: Arc<[Vec<f32>]>,
    /// Offsets of the profile from the spines' sum, brush frame, m: planes of x, y and z, `station · strips + strip`.
    closed: [Arc<Vec<f32>>; 3],
    /// Offsets in x and y, added when pressed open, m.
    opening: [Arc<Vec<f32>>; 2],
    /// Clumping on a clean brush and on a full one.
    clumping: [f32; 2],
    clumped: Option<Arc<[Vec<f32>; 3]>>,
    /// Roots in shares of half the ferrule's width and thickness.
    roots: Arc<[[f32; 2]]>,
    /// Strips in the order of their roots around the ferrule.
    around: Arc<[u32]>,
    /// Strips in two orders in which neighbours stand beside each other.
    beside: Arc<[Vec<u32>; 2]>,
    /// Height of each strip over the surface while the head is hardly pressed, 0 to 1, seeded.
    lift: Arc<[f32]>,
    /// Paint capacity of each strip by the mean of all, seeded.
    capacity: Vec<f32>,
    /// Tangents of the middle of the head at rest.
    rest: Curve,
    skin: Option<Arc<Skin>>,
    length_m: f64,
    straying: Straying,
    /// Half the width and thickness at each station, m.
    half_m: [[f32; 2]; STATIONS],
}

/// Strips in space: planes of coordinates, `station · strips + strip`, station 0 at the ferrule.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeadPose {
    /// Coordinates to the right.
    pub x: Vec<f32>,
    /// Coordinates up along the surface.
    pub y: Vec<f32>,
    /// Height above the surface, never negative.
    pub z: Vec<f32>,
    /// Opening of the head under pressure, 0 to 1.
    pub press: f32,
    /// Share of the strips that shows beside the skin, 0 to 1; 1 where the head is open or has run dry.
    pub splay: f32,
    /// Bend of the point by the head's length, in the ferrule's cross-section: x and y of the brush frame.
    pub bend: [f32; 2],
    /// The skin, if the head has one.
    pub skin: SkinPose,
}

/// Pose and state of a head.
#[derive(Clone, Copy, Debug)]
pub struct Hold<'a> {
    /// Brush frame to surface frame.
    pub brush: &'a Rigid,
    /// θ and φ of all joints, spine after spine.
    pub angles: &'a [[f32; 2]],
    /// Units of the pose per metre.
    pub per_m: f64,
    /// Wetness of the brush, 0 to 1: wet bristles clump.
    pub wetness: f32,
}

/// Smooth from 0 at 0 to 1 at 1.
fn smoothstep(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Weights of the strips for each spine.
fn weights_by_spine(spines: &[DVec2], roots: &[DVec2]) -> Vec<Vec<f32>> {
    let mut weights = vec![Vec::with_capacity(roots.len()); spines.len()];
    for root in roots {
        let row = weights_of(spines, nearest_in_hull(spines, *root));
        for (plane, weight) in weights.iter_mut().zip(row) {
            plane.push(weight as f32);
        }
    }
    weights
}

impl Head {
    /// The head of a brush file.
    #[must_use]
    pub fn of(file: &BrushFile) -> Self {
        let tuft = SpineLayout::of(file);
        let spines = tuft.places(file);
        let mut random = Random::new(file.strips.seed);
        let roots = place::roots(file, &spines, &mut random);
        let count = roots.len();
        let curves: Vec<Curve> = tuft
            .roots
            .iter()
            .map(|root| curve(&root.spine, &root.at_rest(&Rigid::IDENTITY)))
            .collect();
        let (_, rest) = middle(&curves, DVec3::NEG_Z);
        let unruly = |range: f64, random: &mut Random| range * (2.0 * random.unit() - 1.0);
        let rigid = file.head.hair == Hair::Steel;
        // A blade lifts as a whole.
        let lift = |own: f64| if rigid { 1.0 } else { own as f32 };
        // A thinned head has the first strips of the whole one.
        let whole = (count as f64 * file.strips.stands_for).round() as usize;
        let mut lift: Vec<f32> = (0..whole).map(|_| lift(random.unit())).collect();
        lift.truncate(count);
        let capacity = (0..count)
            .map(|_| (1.0 + unruly(file.strips.unevenness, &mut random)) as f32)
            .collect();
        let mut head = Self {
            joints: tuft.joints(),
            strips: count,
            closed: Default::default(),
            opening: Default::default(),
            clumping: file.strips.clumping.map(|share| share as f32),
            clumped: None,
            roots: roots
                .iter()
                .map(|root| [root.x as f32, root.y as f32])
                .collect(),
            around: order_around(&roots).into(),
            beside: Arc::new(beside::orders(
                &roots,
                DVec2::new(file.radius_m(0.0), file.half_thickness_m(0.0)),
            )),
            lift: lift.into(),
            capacity,
            rest,
            skin: Skin::of(file, &tuft).map(Arc::new),
            length_m: file.length_m(),
            straying: Straying::of(file),
            half_m: std::array::from_fn(|station| {
                let at = place_along(station);
                [file.radius_m(at), file.half_thickness_m(at)].map(|half| half as f32)
            }),
            weights: weights_by_spine(&spines, &roots).into(),
            spine_roots: tuft.roots.into(),
        };
        head.lay(file, &roots, &curves);
        head.clump(file, &roots);
        head
    }

    /// Computes the offsets that fit the strips at rest to the head's profile.
    fn lay(&mut self, file: &BrushFile, roots: &[DVec2], curves: &[Curve]) {
        let opened = file.strips.open * 0.5e-3 * file.head.width_mm;
        for station in 0..STATIONS {
            for (strip, root) in roots.iter().enumerate() {
                let sum: DVec3 = curves
                    .iter()
                    .zip(&*self.weights)
                    .map(|(curve, plane)| curve[station] * f64::from(plane[strip]))
                    .sum();
                let off = rest_point(file, *root, station) - sum;
                let planes = self.closed.iter_mut().zip(off.to_array());
                planes.for_each(|(plane, value)| Arc::make_mut(plane).push(value as f32));
                let at = place_along(station) * file.length_share(root.to_array());
                let wide = file.radius_m(at).max(1e-9);
                let wider = (opened / wide).max(1.0) - 1.0;
                let half = [wide, file.half_thickness_m(at)];
                for axis in 0..2 {
                    let opening = Arc::make_mut(&mut self.opening[axis]);
                    opening.push((root[axis] * half[axis] * wider) as f32);
                }
            }
        }
    }

    /// Number of joints of all spines: the length of [`Hold::angles`].
    #[must_use]
    pub fn joints(&self) -> usize {
        self.joints
    }

    /// Number of strips.
    #[must_use]
    pub fn strips(&self) -> usize {
        self.strips
    }

    /// Roots in shares of half the ferrule's width and thickness.
    #[must_use]
    pub fn roots(&self) -> &[[f32; 2]] {
        &self.roots
    }

    /// For each strip, the nearest of the first `strips`, which represents it in a thinned head.
    #[must_use]
    pub fn nearest_of_first(&self, strips: usize) -> Vec<usize> {
        let first = &self.roots[..strips.min(self.strips)];
        let nearest = |root: &[f32; 2]| {
            let off = |other: &[f32; 2]| {
                let off = [0, 1].map(|i| (root[i] - other[i]) * self.half_m[0][i]);
                off[0] * off[0] + off[1] * off[1]
            };
            let near = |a: &usize, b: &usize| off(&first[*a]).total_cmp(&off(&first[*b]));
            (0..first.len()).min_by(near).unwrap_or(0)
        };
        self.roots.iter().map(nearest).collect()
    }

    /// The strip at a place around the head, 0 to 1 from +x counterclockwise.
    #[must_use]
    pub fn strip_around(&self, place: f32) -> usize {
        let turn = place - place.floor();
        let number = (turn * self.strips as f32) as usize;
        self.around[number.min(self.strips - 1)] as usize
    }

    /// The strips in two orders in which neighbours are adjacent: in columns across the thickness, and in rows along
    /// the width.
    #[must_use]
    pub fn beside(&self) -> &[Vec<u32>; 2] {
        &self.beside
    }

    /// Height of each strip over the surface while the head is hardly pressed, 0 to 1.
    #[must_use]
    pub fn lift(&self) -> &[f32] {
        &self.lift
    }

    /// Paint capacity of each strip by the mean of all.
    #[must_use]
    pub fn capacity(&self) -> &[f32] {
        &self.capacity
    }

    /// True for a blade, or for a skin that comes to a point.
    #[must_use]
    pub fn is_fine(&self) -> bool {
        self.straying.rigid || self.skin.is_some()
    }

    /// The skin, if it has one.
    #[must_use]
    pub fn skin(&self) -> Option<&Skin> {
        self.skin.as_deref()
    }

    /// True if a state with this many joint angles belongs to this head.
    #[must_use]
    pub fn fits(&self, angles: usize) -> bool {
        angles == self.joints
    }

    /// The spines of a hold.
    fn shapes(&self, hold: &Hold<'_>) -> Vec<SpineShape> {
        let mut angles = hold.angles;
        self.spine_roots
            .iter()
            .map(|root| {
                let frame = root.frame(hold.brush);
                let (own, others) = angles.split_at(root.spine.joints().min(angles.len()));
                angles = others;
                SpineShape::from_angles(frame.translation, frame.rotation, own)
            })
            .collect()
    }

    /// The strips of a hold, whose state must [`fit`](Self::fits).
    pub fn pose(&self, hold: &Hold<'_>, into: &mut HeadPose) {
        let shapes = self.shapes(hold);
        let spines = self.spine_roots.iter().zip(&shapes);
        let curves: Vec<Curve> = spines
            .map(|(root, shape)| curve(&root.spine, shape))
            .collect();
        let brush = hold.brush;
        let unbent = brush.point(DVec3::new(0.0, 0.0, -self.length_m));
        let press = smoothstep(-unbent.z / (OPEN_AT * self.length_m));
        into.press = press as f32;
        into.splay = into.press.max(1.0 - 2.0 * hold.wetness);
        let (mean, tangents) = middle(&curves, brush.vector(DVec3::NEG_Z));
        let bend = brush.rotation.conjugate() * (mean[STATIONS - 1] - unbent) / self.length_m;
        into.bend = [bend.x as f32, bend.y as f32];
        let count = self.strips * STATIONS;
        for plane in [&mut into.x, &mut into.y, &mut into.z] {
            plane.resize(count, 0.0);
        }
        let clump = self.clumping[0] + (self.clumping[1] - self.clumping[0]) * hold.wetness;
        for station in 0..STATIONS {
            let row = station * self.strips..(station + 1) * self.strips;
            let turned = brush.vector(self.rest[station]);
            let frame = shortest_arc(turned, tangents[station]) * brush.rotation;
            let frame = DMat3::from_quat(frame) * hold.per_m;
            let center = mean[station];
            let in_units = |place: DVec3| (place * hold.per_m).to_array().map(|v| v as f32);
            let curves = curves.iter().zip(&*self.weights);
            let spines: Vec<_> = curves
                .map(|(curve, weights)| (in_units(curve[station] - center), &weights[..]))
                .collect();
            let HeadPose { x, y, z, .. } = into;
            let planes = [x, y, z].map(|plane| &mut plane[row.clone()]);
            let clumped = self.clumped.iter().flat_map(|planes| &**planes);
            let clumped: Vec<_> = clumped.map(|plane| &plane[row.clone()]).collect();
            let common = lay::Station {
                closed: self.closed.each_ref().map(|plane| &plane[row.clone()]),
                opening: self.opening.each_ref().map(|plane| &plane[row.clone()]),
                press: into.press,
                clumped: &clumped,
                clump,
                turn: [0, 1, 2].map(|axis| [0, 1, 2].map(|i| frame.col(i)[axis] as f32)),
                spines: &spines,
                center: in_units(center),
            };
            place_strips(planes, &common);
        }
        let floor = |z: &mut f32| *z = z.max(0.0);
        into.z.iter_mut().for_each(floor);
        for plane in [&mut into.x, &mut into.y, &mut into.z] {
            draw_back(plane, &self.straying.drawn_back);
        }
        into.z.iter_mut().for_each(floor);
        self.wear(&brush.rotation, hold.per_m, into);
        into.skin.clear();
        if let Some(skin) = &self.skin {
            skin.pose(&self.spine_roots, &shapes, hold.per_m, &mut into.skin);
        }
    }
}

impl Head {
    /// Moves the points of worn tresses before and behind the others, along the surface.
    fn wear(&self, brush: &DQuat, per_m: f64, into: &mut HeadPose) {
        let ahead = &self.straying.ahead;
        let thick = (*brush * DVec3::Y).truncate().normalize_or_zero() * per_m;
        if ahead.is_empty() {
            return;
        }
        for station in 1..STATIONS {
            let way = (thick * smoothstep(place_along(station))).to_array();
            for (plane, way) in [&mut into.x, &mut into.y].into_iter().zip(way) {
                let own = plane[station * ahead.len()..].iter_mut();
                own.zip(ahead)
                    .for_each(|(place, ahead)| *place += ahead * way as f32);
            }
        }
    }
}

/// Roots ordered by their angle around the middle.
fn order_around(roots: &[DVec2]) -> Vec<u32> {
    let turn = |i: u32| {
        let root = roots[i as usize];
        atan2(root.y, root.x).rem_euclid(2.0 * std::f64::consts::PI)
    };
    let mut order: Vec<u32> = (0..roots.len() as u32).collect();
    order.sort_by(|a, b| turn(*a).total_cmp(&turn(*b)));
    order
}

/// A station's place along a strip, 0 to 1.
fn place_along(station: usize) -> f64 {
    station as f64 / (STATIONS - 1) as f64
}

/// Rest position at a station of the strip with a root, brush frame, m.
fn rest_point(file: &BrushFile, root: DVec2, station: usize) -> DVec3 {
    let at = place_along(station) * file.length_share(root.to_array());
    DVec3::new(
        root.x * file.radius_m(at),
        root.y * file.half_thickness_m(at),
        -at * file.length_m(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::library::LIBRARY;

    fn head(kind: &str) -> (BrushFile, Head) {
        let file = BrushFile::library(kind).expect(kind);
        let head = Head::of(&file);
        (file, head)
    }

    /// A head as it rests, with its ferrule at a height.
    fn rest(kind: &str, height: f64, wetness: f32) -> HeadPose {
        let (file, head) = head(kind);
        let brush = Rigid {
            translation: DVec3::new(0.1, 0.2, height),
            ..Rigid::IDENTITY
        };
        let mut angles = Vec::new();
        for root in &SpineLayout::of(&file).roots {
            root.at_rest(&brush).angles(&mut angles);
        }
        assert!(head.fits(angles.len()));
        let mut pose = HeadPose::default();
        let hold = Hold {
            brush: &brush,
            angles: &angles,
            per_m: 1.0,
            wetness,
        };
        head.pose(&hold, &mut pose);
        pose
    }

    #[test]
    fn at_rest_the_strips_fill_the_profile() {
        for (kind, _) in LIBRARY {
            let (mut file, _) = head(kind);
            file.strips.clumping = [0.0; 2];
            let head = Head::of(&file);
            let pose = rest(kind, 0.2, 0.0);
            assert_eq!(pose.press, 0.0);
            for station in [0, 3, 6] {
                let row = station * head.strips()..(station + 1) * head.strips();
                let widest = row
                    .clone()
                    .map(|i| (pose.x[i] - 0.1).abs())
                    .fold(0.0, f32::max);
                let at = |share: f64| file.radius_m(place_along(station) * share);
                let shares = file.head.tip.iter().map(|[_, share]| *share);
                let profile = shares.chain([1.0]).map(at).fold(0.0, f64::max);
                let share = f64::from(widest) / profile;
                assert!((0.7..1.06).contains(&share), "{kind} {station}: {share}");
            }
            let tip = pose.z.iter().copied().fold(f32::MAX, f32::min);
            let lowest = 0.2 - file.length_m() as f32;
            assert!(
                (tip - lowest).abs() < 0.02 * file.length_m() as f32,
                "{kind}"
            );
        }
    }

    #[test]
    fn a_pressed_head_opens_and_stays_above_the_surface() {
        let (file, _) = head("round");
        let pose = rest("round", 0.7 * file.length_m(), 0.0);
        assert!(pose.press > 0.5);
        assert!(pose.z.iter().all(|z| *z >= 0.0));
    }

    #[test]
    fn wet_strips_clump_at_the_point() {
        let (file, head) = head("fan");
        assert!(file.strips.clumping[1] > file.strips.clumping[0]);
        let gaps = |wetness: f32| {
            let pose = rest("fan", 0.2, wetness);
            let mut tips = pose.x[(STATIONS - 1) * head.strips()..].to_vec();
            tips.sort_by(f32::total_cmp);
            tips.windows(2)
                .map(|pair| pair[1] - pair[0])
                .fold(0.0, f32::max)
        };
        assert!(gaps(1.0) > 1.3 * gaps(0.0), "{} {}", gaps(1.0), gaps(0.0));
    }

    #[test]
    fn the_seed_places_the_strips() {
        let (mut file, head) = head("round");
        assert_eq!(Head::of(&file).lift, head.lift);
        file.strips.seed += 1;
        assert_ne!(Head::of(&file).lift, head.lift);
    }
}
