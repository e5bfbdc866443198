//! The tuft: where the spines of a head stand in the ferrule.

use glam::{DQuat, DVec2, DVec3};
use maulstick_num::geometry::{Rigid, shortest_arc};
use maulstick_num::sin_cos;

use crate::core_spine::Core;
use crate::file::BrushFile;
use crate::file::sections::{Chain, Layout};
use crate::solver::Neighbour;
use crate::spine::{Spine, SpineShape};

/// The ferrule is held off the surface by at least this share of the head's length.
const LEAST_HEIGHT: f64 = 0.05;

/// A spine and where it begins.
#[derive(Clone, Debug, PartialEq)]
pub struct Seat {
    /// Its root in the brush frame, m.
    pub root: DVec3,
    /// Turns the brush frame so that its −z is the spine's direction where it leaves the ferrule.
    pub lean: DQuat,
    /// What it is made of: each has its share of the head's stiffness.
    pub spine: Spine,
}

impl Seat {
    /// A spine that rests as drawn: from a root on by segments, brush frame, m.
    #[must_use]
    pub fn drawn(root: DVec3, segments: &[DVec3], spine: Spine) -> Self {
        let lean = shortest_arc(DVec3::NEG_Z, segments[0].normalize());
        let directions: Vec<DVec3> = segments
            .iter()
            .map(|segment| lean.conjugate() * segment.normalize())
            .collect();
        let straight = directions
            .iter()
            .all(|d| (*d - DVec3::NEG_Z).length() < 1e-9);
        Self {
            root,
            lean,
            spine: match straight {
                true => spine,
                false => spine.resting(&directions),
            },
        }
    }

    /// The seat of a brush that is held at `brush`: root and orientation of the spine's own frame.
    #[must_use]
    pub fn held(&self, brush: &Rigid) -> Rigid {
        Rigid {
            rotation: brush.rotation * self.lean,
            translation: brush.point(self.root),
        }
    }

    /// The spine at rest in a brush that is held at `brush`.
    #[must_use]
    pub fn at_rest(&self, brush: &Rigid) -> SpineShape {
        let held = self.held(brush);
        SpineShape::at_rest(held.translation, held.rotation, &self.spine)
    }
}

/// The spines of a head.
#[derive(Clone, Debug, PartialEq)]
pub struct Tuft {
    /// Ring: the one in the middle first, then those around it, counterclockwise seen from the
    /// handle. Row: along x.
    pub seats: Vec<Seat>,
    /// For each spine the joints of the others that keep it out of their room: number of the other
    /// spine, joint, and the distance at rest, m.
    pub rooms: Vec<Vec<Room>>,
    /// Stiffness of that room, N/m.
    pub crowd_n_m: f64,
    /// What the spines are bound to.
    pub core: Core,
    /// Stiffness of their bonds by that of their joints.
    pub bond: f64,
}

/// Room that a joint of one spine keeps from the same joint of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// The other spine.
    pub other: usize,
    /// The joint of both.
    pub joint: usize,
    /// How far apart they are at rest, m.
    pub at_rest_m: f64,
}

impl Tuft {
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
        let seats: Vec<Seat> = match spines.layout {
            Layout::Ring | Layout::Row => places.iter().map(|place| seat(file, *place)).collect(),
            Layout::Chains => spines.chains.iter().map(chain_seat).collect(),
        };
        let rooms = rooms(&seats);
        // The stiffness of a spine's point against a force across it is 3·EI/L³.
        let soft = |seat: &Seat| {
            let spine = &seat.spine;
            let n = spine.joints();
            let ei = spine.stiffness[n - 1] * spine.lengths_m[n - 1];
            let length = spine.length_m();
            3.0 * ei / (length * length * length)
        };
        let mean = seats.iter().map(soft).sum::<f64>() / seats.len().max(1) as f64;
        Self {
            rooms,
            crowd_n_m: spines.volume * mean,
            core: Core::of(&seats),
            bond: spines.bond[0],
            seats,
        }
    }

    /// Where the spines stand, in shares of half the ferrule's width and thickness.
    #[must_use]
    pub fn places(&self, file: &BrushFile) -> Vec<DVec2> {
        let half = DVec2::new(file.radius_m(0.0), file.half_thickness_m(0.0));
        let seats = self.seats.iter();
        seats.map(|seat| seat.root.truncate() / half).collect()
    }

    /// Height of the lowest root of a brush that is held at `brush`, m.
    #[must_use]
    pub fn lowest_root(&self, brush: &Rigid) -> f64 {
        let roots = self.seats.iter().map(|seat| brush.point(seat.root).z);
        roots.fold(brush.translation.z, f64::min)
    }

    /// Holds the ferrule of a head of `length_m` so high that no spine begins below the surface z = 0.
    pub fn raise(&self, brush: &mut Rigid, length_m: f64) {
        let lacking = LEAST_HEIGHT * length_m - self.lowest_root(brush);
        brush.translation.z += lacking.max(0.0);
    }

    /// Multiplies all stiffness by a factor.
    pub fn stiffen(&mut self, factor: f64) {
        self.crowd_n_m *= factor;
        for seat in self.seats.iter_mut().chain([&mut self.core.seat]) {
            let spine = &mut seat.spine;
            let torques = spine.stiffness.iter_mut().chain(&mut spine.damping);
            torques.for_each(|torque| *torque *= factor);
        }
    }

    /// Number of joints of all spines.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.seats.iter().map(|seat| seat.spine.joints()).sum()
    }

    /// What pushes spine `number` aside, given where the ends of all segments are.
    pub fn neighbours(&self, number: usize, ends: &[Vec<DVec3>], into: &mut Vec<Neighbour>) {
        into.clear();
        if self.crowd_n_m > 0.0 {
            into.extend(self.rooms[number].iter().map(|room| Neighbour {
                joint: room.joint,
                at: ends[room.other][room.joint],
                at_rest_m: room.at_rest_m,
            }));
        }
    }
}

fn seat(file: &BrushFile, place: [f64; 2]) -> Seat {
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
    Seat { root, lean, spine }
}

fn chain_seat(chain: &Chain) -> Seat {
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
    Seat::drawn(DVec3::from_array(chain.root_mm) * 1e-3, &segments, spine)
}

fn rooms(seats: &[Seat]) -> Vec<Vec<Room>> {
    let ends: Vec<Vec<DVec3>> = seats
        .iter()
        .map(|seat| {
            let shape = seat.at_rest(&Rigid::IDENTITY);
            (0..seat.spine.joints())
                .map(|i| shape.joint(&seat.spine, i))
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
    (0..seats.len())
        .map(|one| {
            let others = (0..seats.len()).filter(|other| *other != one);
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
        let tuft = Tuft::of(&file);
        assert_eq!(tuft.seats.len(), file.spines.number());
        assert_eq!(tuft.joints(), file.spines.all_joints());
        let reach = file.spines.share * file.radius_m(1.0);
        for seat in &tuft.seats[1..] {
            let tip = seat.at_rest(&Rigid::IDENTITY).tip(&seat.spine);
            assert!(
                (tip.truncate().length() - reach).abs() < 0.05 * file.radius_m(0.0),
                "{tip}"
            );
            assert!(tip.truncate().dot(seat.root.truncate()) > 0.0);
        }
        let whole: f64 = tuft.seats.iter().map(|seat| seat.spine.stiffness[0]).sum();
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
            let tuft = Tuft::of(file);
            let seat = tuft.seats.last().expect("some");
            seat.at_rest(&Rigid::IDENTITY).tip(&seat.spine).x.abs()
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
        let seat = chain_seat(&chain);
        let tip = seat.at_rest(&Rigid::IDENTITY).tip(&seat.spine);
        assert!(
            (tip - DVec3::new(10e-3, 3e-3, -24e-3)).length() < 1e-12,
            "{tip}"
        );
    }
}
