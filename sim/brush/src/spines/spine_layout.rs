//! The tuft: positions of a head's spines in the ferrule.

use glam::{DVec2, DVec3};
use maulstick_num::geometry::{Rigid, shortest_arc};
use maulstick_num::sin_cos;

use crate::core_spine::Core;
use crate::file::BrushFile;
use crate::file::sections::{Chain, Layout};
use crate::solver::Neighbour;
use crate::spine::Spine;
use crate::spine_root::SpineRoot;

/// Least height of the ferrule over the surface, as a share of the head's length.
const LEAST_HEIGHT: f64 = 0.05;

/// The spines of a head.
#[derive(Clone, Debug, PartialEq)]
pub struct SpineLayout {
    /// Spines with their roots. Ring: the one in the middle first, then those around it, counterclockwise seen from
    /// the handle. Row: along x.
    pub roots: Vec<SpineRoot>,
    /// For each spine, the joints of other spines that repel it.
    pub rooms: Vec<Vec<Room>>,
    /// Stiffness of the repulsion, N/m.
    pub repulsion_n_m: f64,
    /// Core to which the spines are bound.
    pub core: Core,
    /// Stiffness of the bonds as a multiple of that of the joints.
    pub bond: f64,
}

/// Spacing of a joint from the same joint of another spine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// The other spine.
    pub other: usize,
    /// The joint, of both spines.
    pub joint: usize,
    /// Distance at rest, m.
    pub at_rest_m: f64,
}

impl SpineLayout {
    /// The tuft of a brush file.
    #[must_use]
    pub fn of(file: &BrushFile) -> Self {
        let spines = &file.spines;
        let places: Vec<[f64; 2]> = match spines.layout {
            Layout::Ring => std::iter::once([0.0; 2])
                .chain((0..spines.count).map(|i| {
                    let turn = 2.0 * std::f64::consts::PI * i as f64 / spines.count as f64;
                    let (sine, cosine) = sin_cos(turn);
                    [cosine * spines.share, sine * spines.share]
                }))
                .collect(),
            Layout::Row => (0..spines.count)
                .map(|i| {
                    let place = 2.0 * i as f64 / (spines.count.max(2) - 1) as f64 - 1.0;
                    let only = if spines.count > 1 { spines.share } else { 0.0 };
                    [place * only, 0.0]
                })
                .collect(),
            Layout::Chains => Vec::new(),
        };
        let roots: Vec<SpineRoot> = match spines.layout {
            Layout::Ring | Layout::Row => places
                .iter()
                .map(|place| spine_root(file, *place))
                .collect(),
            Layout::Chains => spines.chains.iter().map(chain_root).collect(),
        };
        let rooms = rooms(&roots);
        // The stiffness of a spine's point against a force across it is 3·EI/L³.
        let soft = |root: &SpineRoot| {
            let spine = &root.spine;
            let n = spine.joints();
            let ei = spine.stiffness[n - 1] * spine.lengths_m[n - 1];
            let length = spine.length_m();
            3.0 * ei / (length * length * length)
        };
        let mean = roots.iter().map(soft).sum::<f64>() / roots.len().max(1) as f64;
        Self {
            rooms,
            repulsion_n_m: spines.volume * mean,
            core: Core::of(&roots),
            bond: spines.bond[0],
            roots,
        }
    }

    /// Positions of the spines, in shares of half the ferrule's width and thickness.
    #[must_use]
    pub fn places(&self, file: &BrushFile) -> Vec<DVec2> {
        let half = DVec2::new(file.radius_m(0.0), file.half_thickness_m(0.0));
        let roots = self.roots.iter();
        roots.map(|root| root.origin.truncate() / half).collect()
    }

    /// Height of the lowest root of a brush at pose `brush`, m.
    #[must_use]
    pub fn lowest_root(&self, brush: &Rigid) -> f64 {
        let roots = self.roots.iter().map(|root| brush.point(root.origin).z);
        roots.fold(brush.translation.z, f64::min)
    }

    /// Raises the ferrule of a head of `length_m` until no spine begins below the surface z = 0.
    pub fn raise(&self, brush: &mut Rigid, length_m: f64) {
        let lacking = LEAST_HEIGHT * length_m - self.lowest_root(brush);
        brush.translation.z += lacking.max(0.0);
    }

    /// Joints of all spines of a brush at pose `brush`, unbent.
    #[must_use]
    pub fn joints_at_rest(&self, brush: &Rigid) -> Vec<DVec3> {
        let mut joints = Vec::new();
        let mut all = Vec::new();
        for root in &self.roots {
            root.at_rest(brush).joints(&root.spine, &mut joints);
            all.extend_from_slice(&joints);
        }
        all
    }

    /// Multiplies all stiffness by a factor.
    pub fn stiffen(&mut self, factor: f64) {
        self.repulsion_n_m *= factor;
        for root in self.roots.iter_mut().chain([&mut self.core.root]) {
            let spine = &mut root.spine;
            let torques = spine.stiffness.iter_mut().chain(&mut spine.damping);
            torques.for_each(|torque| *torque *= factor);
        }
    }

    /// True if its joints have inner friction.
    #[must_use]
    pub fn is_plastic(&self) -> bool {
        let roots = self.roots.iter();
        roots.flat_map(|root| &root.spine.damping).any(|d| *d > 0.0)
    }

    /// Number of joints of all spines.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.roots.iter().map(|root| root.spine.joints()).sum()
    }

    /// Neighbours that repel spine `number`, given the ends of all segments.
    pub fn neighbours(&self, number: usize, ends: &[Vec<DVec3>], into: &mut Vec<Neighbour>) {
        into.clear();
        if self.repulsion_n_m > 0.0 {
            into.extend(self.rooms[number].iter().map(|room| Neighbour {
                joint: room.joint,
                at: ends[room.other][room.joint],
                at_rest_m: room.at_rest_m,
            }));
        }
    }
}

fn spine_root(file: &BrushFile, place: [f64; 2]) -> SpineRoot {
    let spines = &file.spines;
    let half = |s: f64| [file.radius_m(s), file.half_thickness_m(s)];
    let at = |s: f64| {
        let half = half(s);
        DVec3::new(place[0] * half[0], place[1] * half[1], 0.0)
    };
    let length = file.length_m() * file.length_share(place);
    let (root, point) = (at(0.0), at(1.0));
    let along = (point - root - DVec3::Z * length).normalize();
    let lean = shortest_arc(DVec3::NEG_Z, along);
    let n = spines.joints;
    let segment = length / n as f64;
    let ei = spines.bending_stiffness_n_mm2 * 1e-6 / spines.number() as f64;
    let mut stiffness: Vec<f64> = (0..n)
        .map(|i| ei * file.stiffness_share(i as f64 / n as f64) / segment)
        .collect();
    // Half a segment lies between the clamp and the first joint.
    stiffness[0] *= 2.0;
    let spine = Spine {
        lengths_m: vec![segment; n],
        damping: stiffness.iter().map(|k| spines.damping * k).collect(),
        stiffness,
        rest: Vec::new(),
    };
    let out = DVec3::new(place[0], place[1], 0.0);
    let curl = spines.curl_deg.to_radians() * out.length();
    let spine = if curl == 0.0 {
        spine
    } else {
        let inward = lean.conjugate() * -out.normalize();
        let bent = |i: usize| {
            let (sine, cosine) = sin_cos(curl * (i as f64 + 0.5) / n as f64);
            (inward * sine + DVec3::NEG_Z * cosine).normalize()
        };
        spine.resting(&(0..n).map(bent).collect::<Vec<DVec3>>())
    };
    SpineRoot {
        origin: root,
        lean,
        spine,
    }
}

fn chain_root(chain: &Chain) -> SpineRoot {
    let segments: Vec<DVec3> = chain
        .segments_mm
        .iter()
        .map(|segment| DVec3::from_array(*segment) * 1e-3)
        .collect();
    let spine = Spine {
        lengths_m: segments.iter().map(|segment| segment.length()).collect(),
        stiffness: chain.stiffness_n_mm.iter().map(|k| k * 1e-3).collect(),
        damping: chain.damping_n_mm.iter().map(|d| d * 1e-3).collect(),
        rest: Vec::new(),
    };
    SpineRoot::drawn(DVec3::from_array(chain.root_mm) * 1e-3, &segments, spine)
}

fn rooms(roots: &[SpineRoot]) -> Vec<Vec<Room>> {
    let ends: Vec<Vec<DVec3>> = roots
        .iter()
        .map(|root| {
            let shape = root.at_rest(&Rigid::IDENTITY);
            (0..root.spine.joints())
                .map(|i| shape.joint(&root.spine, i))
                .collect()
        })
        .collect();
    let room = |one: usize, other: usize| {
        let joints = ends[one].len().min(ends[other].len());
        let (a, b) = (&ends[one], &ends[other]);
        (0..joints).map(move |joint| Room {
            other,
            joint,
            at_rest_m: (a[joint] - b[joint]).length(),
        })
    };
    (0..roots.len())
        .map(|one| {
            let others = (0..roots.len()).filter(|other| *other != one);
            let rooms = others.flat_map(|other| room(one, other));
            rooms.filter(|room| room.at_rest_m > 1e-6).collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spines_lean_to_the_point() {
        let file = BrushFile::library("round").expect("round");
        let tuft = SpineLayout::of(&file);
        assert_eq!(tuft.roots.len(), file.spines.number());
        assert_eq!(tuft.joints(), file.spines.all_joints());
        let reach = file.spines.share * file.radius_m(1.0);
        for root in &tuft.roots[1..] {
            let tip = root.at_rest(&Rigid::IDENTITY).tip(&root.spine);
            assert!(
                (tip.truncate().length() - reach).abs() < 0.05 * file.radius_m(0.0),
                "{tip}"
            );
            assert!(tip.truncate().dot(root.origin.truncate()) > 0.0);
        }
        let whole: f64 = tuft.roots.iter().map(|root| root.spine.stiffness[0]).sum();
        let ei = file.spines.bending_stiffness_n_mm2 * 1e-6;
        let one = Spine::uniform(file.length_m(), file.spines.joints, ei);
        assert!((whole / one.stiffness[0] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn outer_bristles_of_a_filbert_curve_inward() {
        let file = BrushFile::library("filbert").expect("filbert");
        let mut straight = file.clone();
        straight.spines.curl_deg = 0.0;
        let reach = |file: &BrushFile| {
            let tuft = SpineLayout::of(file);
            let root = tuft.roots.last().expect("some");
            root.at_rest(&Rigid::IDENTITY).tip(&root.spine).x.abs()
        };
        assert!(reach(&file) < 0.9 * reach(&straight));
    }

    #[test]
    fn chains_rest_where_they_are_drawn() {
        let chain = Chain {
            root_mm: [1.0, 2.0, 0.0],
            segments_mm: vec![[0.0, 0.0, -10.0], [3.0, 0.0, -9.0], [6.0, 1.0, -5.0]],
            stiffness_n_mm: vec![1.0; 3],
            damping_n_mm: vec![0.0; 3],
        };
        let root = chain_root(&chain);
        let tip = root.at_rest(&Rigid::IDENTITY).tip(&root.spine);
        assert!(
            (tip - DVec3::new(10e-3, 3e-3, -24e-3)).length() < 1e-12,
            "{tip}"
        );
    }
}
