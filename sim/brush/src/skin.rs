//! The skin of a head: a Catmull-Clark surface whose control vertices are tied to the spines by matrix skinning
//! (Baxter 2004, § 3.5.1).
//!
//! A control vertex is the weighted mean of the places to which its segments would carry it rigidly. Its mesh is that
//! of the brush file, for example from Blender, or one around the strips.

use glam::{DMat3, DQuat, DVec3};
use maulstick_num::atan2;
use maulstick_num::geometry::{Rigid, shortest_arc};

use crate::file::BrushFile;
use crate::head::place::edge;
use crate::head::weights::{nearest_in_hull, weights_of};
use crate::spine::{Spine, SpineShape};
use crate::spine_layout::SpineLayout;
use crate::spine_root::SpineRoot;
use crate::subdivide::{Mesh, subdivide};

/// Rings of the skin's own mesh, as places along the head, and vertices of each.
const RINGS: [f64; 6] = [0.0, 0.2, 0.45, 0.7, 0.88, 0.98];
const AROUND: usize = 12;
/// A cubic B-spline through twelve points of a circle runs within it by this factor: (2 + cos 30°)/3.
const SPLINE_RADIUS_FACTOR: f64 = 0.955_341_801_261_479_5;

#[derive(Clone, Debug)]
struct Vertex {
    /// Position at rest, brush frame, m.
    at: DVec3,
    /// Joints, counted through all spines, whose segments move it, with their weights.
    weights: Vec<(usize, f64)>,
}

/// The skin of a head.
#[derive(Clone, Debug)]
pub struct Skin {
    control: Vec<Vertex>,
    /// Inverse frames of the segments at rest, each at its beginning.
    rest: Vec<Rigid>,
    /// Offsets into the weights: those of vertex i are from `starts[i]` to `starts[i + 1]`.
    starts: Vec<usize>,
    shares: Vec<(u32, f32)>,
    faces: Vec<[u32; 4]>,
    /// Place of each vertex around the head and along it, both 0 to 1.
    places: Vec<[f32; 2]>,
}

/// A skin in space, as planes of vertex coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkinPose {
    /// Coordinates to the right.
    pub x: Vec<f32>,
    /// Coordinates up along the surface.
    pub y: Vec<f32>,
    /// Height above the surface, never negative.
    pub z: Vec<f32>,
}

impl SkinPose {
    /// Removes all vertices.
    pub fn clear(&mut self) {
        for plane in [&mut self.x, &mut self.y, &mut self.z] {
            plane.clear();
        }
    }
}

impl Skin {
    /// The skin of a brush file, if it has one.
    #[must_use]
    pub fn of(file: &BrushFile, tuft: &SpineLayout) -> Option<Self> {
        let section = file.surface.as_ref()?;
        let (mesh, control) = if section.vertices_mm.is_empty() {
            around(file, tuft)
        } else {
            let mesh = Mesh {
                vertices: section.vertices_mm.len(),
                faces: section.faces.clone(),
            };
            let places = section.vertices_mm.iter().zip(&section.weights);
            let control = places.map(|(at, weights)| Vertex {
                at: DVec3::from_array(*at) * 1e-3,
                weights: weights.clone(),
            });
            (mesh, control.collect())
        };
        let fine = subdivide(&mesh, section.levels);
        let mut starts = vec![0];
        let mut shares = Vec::new();
        let mut places = Vec::new();
        for stencil in &fine.stencils {
            shares.extend(stencil.iter().map(|(v, share)| (*v as u32, *share as f32)));
            starts.push(shares.len());
            let at: DVec3 = stencil
                .iter()
                .map(|(v, share)| control[*v].at * *share)
                .sum();
            places.push(place_of(file, at));
        }
        let quad = |face: &Vec<usize>| {
            // A triangle of an undivided mesh is a quadrilateral with two corners in one.
            std::array::from_fn(|i| face[i.min(face.len() - 1)] as u32)
        };
        let rest = tuft
            .roots
            .iter()
            .flat_map(|root| frames(&root.spine, &root.at_rest(&Rigid::IDENTITY)))
            .map(|frame| frame.inverse())
            .collect();
        Some(Self {
            control,
            rest,
            starts,
            shares,
            faces: fine.mesh.faces.iter().map(quad).collect(),
            places,
        })
    }

    /// Faces, as four vertex numbers each.
    #[must_use]
    pub fn faces(&self) -> &[[u32; 4]] {
        &self.faces
    }

    /// Places of the vertices around the head and along it, both 0 to 1.
    #[must_use]
    pub fn places(&self) -> &[[f32; 2]] {
        &self.places
    }

    /// The skin of bent spines, with `per_m` units a metre.
    pub fn pose(
        &self,
        roots: &[SpineRoot],
        shapes: &[SpineShape],
        per_m: f64,
        into: &mut SkinPose,
    ) {
        let spines = roots.iter().zip(shapes);
        let bones: Vec<(DMat3, DVec3)> = spines
            .flat_map(|(root, shape)| frames(&root.spine, shape))
            .zip(&self.rest)
            .map(|(frame, rest)| {
                let bone = frame.after(rest);
                (DMat3::from_quat(bone.rotation), bone.translation)
            })
            .collect();
        let control: Vec<DVec3> = self
            .control
            .iter()
            .map(|vertex| {
                let carried = |(joint, weight): &(usize, f64)| {
                    let (turn, shift) = bones[*joint];
                    (turn * vertex.at + shift) * *weight
                };
                vertex.weights.iter().map(carried).sum::<DVec3>() * per_m
            })
            .collect();
        into.clear();
        for range in self.starts.windows(2) {
            let shares = &self.shares[range[0]..range[1]];
            let sum: DVec3 = shares
                .iter()
                .map(|(v, share)| control[*v as usize] * f64::from(*share))
                .sum();
            into.x.push(sum.x as f32);
            into.y.push(sum.y as f32);
            into.z.push((sum.z as f32).max(0.0));
        }
    }
}

/// The frames of a spine's segments, each rotated from the one before by the shortest arc.
fn frames(spine: &Spine, shape: &SpineShape) -> Vec<Rigid> {
    let mut rotation: DQuat = shape.frame;
    let mut before = shape.base();
    let mut at = shape.root;
    let segments = shape.directions.iter().zip(&spine.lengths_m);
    segments
        .map(|(direction, length)| {
            rotation = shortest_arc(before, *direction) * rotation;
            before = *direction;
            let frame = Rigid {
                rotation,
                translation: at,
            };
            at += *direction * *length;
            frame
        })
        .collect()
}

/// Place of a vertex at rest around the head and along it.
fn place_of(file: &BrushFile, at: DVec3) -> [f32; 2] {
    let along = (-at.z / file.length_m()).clamp(0.0, 1.0);
    let half = [file.radius_m(along), file.half_thickness_m(along)].map(|v| v.max(1e-9));
    let turn = atan2(at.y / half[1], at.x / half[0]) / (2.0 * std::f64::consts::PI);
    [turn.rem_euclid(1.0) as f32, along as f32]
}

/// A mesh around the strips: rings, and a lid at either end.
fn around(file: &BrushFile, tuft: &SpineLayout) -> (Mesh, Vec<Vertex>) {
    let spines = tuft.places(file);
    let mut firsts = Vec::new();
    for root in &tuft.roots {
        let last = firsts.last().map_or(0, |(first, n)| first + n);
        firsts.push((last, root.spine.joints()));
    }
    let mut vertices = Vec::new();
    for ring in RINGS {
        for i in 0..AROUND {
            let turn = 2.0 * std::f64::consts::PI * i as f64 / AROUND as f64;
            let root = edge(file.head.outline, turn);
            let place = ring * file.length_share(root.to_array());
            let at = DVec3::new(
                root.x * file.radius_m(place) / SPLINE_RADIUS_FACTOR,
                root.y * file.half_thickness_m(place) / SPLINE_RADIUS_FACTOR,
                -place * file.length_m(),
            );
            let shares = weights_of(&spines, nearest_in_hull(&spines, root));
            let mut weights = Vec::new();
            for (share, (first, joints)) in shares.iter().zip(&firsts) {
                if *share > 1e-6 {
                    // Between the middles of two segments both carry the vertex.
                    let along = (ring * *joints as f64 - 0.5).clamp(0.0, (*joints - 1) as f64);
                    let (low, t) = (along as usize, along.fract());
                    weights.push((first + low, share * (1.0 - t)));
                    if t > 0.0 {
                        weights.push((first + low + 1, share * t));
                    }
                }
            }
            let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
            weights.iter_mut().for_each(|(_, weight)| *weight /= sum);
            vertices.push(Vertex { at, weights });
        }
    }
    let mut faces = vec![(0..AROUND).collect::<Vec<usize>>()];
    for ring in 1..RINGS.len() {
        for i in 0..AROUND {
            let next = (i + 1) % AROUND;
            let (above, below) = ((ring - 1) * AROUND, ring * AROUND);
            faces.push(vec![above + next, above + i, below + i, below + next]);
        }
    }
    let lowest = (RINGS.len() - 1) * AROUND;
    faces.push((0..AROUND).rev().map(|i| lowest + i).collect());
    let mesh = Mesh {
        vertices: vertices.len(),
        faces,
    };
    (mesh, vertices)
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::rotation;

    use super::*;

    fn skinned() -> (BrushFile, SpineLayout, Skin) {
        let mut file = BrushFile::library("round").expect("round");
        file.surface = Some(crate::file::sections::Surface {
            levels: 2,
            recede_mm: 0.3,
            vertices_mm: Vec::new(),
            faces: Vec::new(),
            weights: Vec::new(),
        });
        let tuft = SpineLayout::of(&file);
        let skin = Skin::of(&file, &tuft).expect("a skin");
        (file, tuft, skin)
    }

    fn posed(tuft: &SpineLayout, skin: &Skin, brush: &Rigid, bend: f32) -> SkinPose {
        let shapes: Vec<SpineShape> = tuft
            .roots
            .iter()
            .map(|root| {
                let held = root.frame(brush);
                let angles = vec![[bend, 0.0]; root.spine.joints()];
                SpineShape::from_angles(held.translation, held.rotation, &angles)
            })
            .collect();
        let mut pose = SkinPose::default();
        skin.pose(&tuft.roots, &shapes, 1.0, &mut pose);
        pose
    }

    #[test]
    fn at_rest_it_is_as_wide_as_the_head_and_moves_rigidly_with_it() {
        let (file, tuft, skin) = skinned();
        let brush = Rigid {
            translation: DVec3::new(0.0, 0.0, 0.1),
            ..Rigid::IDENTITY
        };
        let pose = posed(&tuft, &skin, &brush, 0.0);
        let widest = pose.x.iter().copied().fold(0.0, f32::max);
        let share = f64::from(widest) / file.radius_m(0.25);
        assert!((share - 1.0).abs() < 0.05, "{share}");
        let turned = Rigid {
            rotation: rotation(DVec3::new(0.6, 0.0, 0.8), 0.5),
            translation: DVec3::new(0.3, 0.2, 0.2),
        };
        let moved = posed(&tuft, &skin, &turned, 0.0);
        let carry = turned.after(&brush.inverse());
        for i in 0..pose.x.len() {
            let at = |p: &SkinPose| DVec3::new(p.x[i].into(), p.y[i].into(), p.z[i].into());
            assert!((carry.point(at(&pose)) - at(&moved)).length() < 1e-6);
        }
    }

    #[test]
    fn it_bends_with_the_spines() {
        let (file, tuft, skin) = skinned();
        let brush = Rigid {
            translation: DVec3::new(0.0, 0.0, 0.1),
            ..Rigid::IDENTITY
        };
        let (straight, bent) = (
            posed(&tuft, &skin, &brush, 0.0),
            posed(&tuft, &skin, &brush, 0.4),
        );
        let shift = |along: f32| {
            let near = |i: &usize| (skin.places[*i][1] - along).abs() < 0.1;
            let of: Vec<f32> = (0..skin.places.len())
                .filter(near)
                .map(|i| (bent.y[i] - straight.y[i]).abs())
                .collect();
            of.iter().sum::<f32>() / of.len() as f32
        };
        let length = file.length_m() as f32;
        assert!(shift(0.9) > 0.3 * length && shift(0.1) < 0.1 * length);
    }

    #[test]
    fn faces_look_outward() {
        let (_, tuft, skin) = skinned();
        let brush = Rigid {
            translation: DVec3::new(0.0, 0.0, 0.1),
            ..Rigid::IDENTITY
        };
        let pose = posed(&tuft, &skin, &brush, 0.0);
        let at = |i: u32| {
            let i = i as usize;
            DVec3::new(pose.x[i].into(), pose.y[i].into(), pose.z[i].into())
        };
        let outward = |face: &[u32; 4]| {
            let normal = (at(face[2]) - at(face[0])).cross(at(face[3]) - at(face[1]));
            let middle = (at(face[0]) + at(face[2])) * 0.5;
            normal.dot(DVec3::new(middle.x, middle.y, 0.0)) >= -1e-12
        };
        let good = skin.faces.iter().filter(|face| outward(face)).count();
        assert!(good as f64 > 0.95 * skin.faces.len() as f64, "{good}");
    }
}
