//! The mesh as in the file, and as placed in the brush frame.

use glam::{DMat4, DVec3};
use gltf::accessor::Dimensions;
use gltf::mesh::{Mode, Primitive, Semantic};
use gltf::{Accessor, Mesh, Node};

use super::brush_mm;
use super::document::{Document, List, name_of};
use super::error::GltfError;

/// Greatest number of vertices of a file, before those split at seams are merged.
const MOST_VERTICES: usize = 65_536;
/// Triangles of a file at most.
const MOST_TRIANGLES: usize = 16_384;
/// Sets of four joints a vertex at most.
const MOST_SETS: u32 = 4;

/// The mesh of a file in the frame in which it was bound to its joints.
#[derive(Default)]
pub(super) struct Bound {
    positions: Vec<DVec3>,
    weights: Vec<Vec<(usize, f64)>>,
    triangles: Vec<[usize; 3]>,
}

/// The mesh in the brush frame.
pub(super) struct Placed {
    /// Vertex positions, mm.
    pub(super) positions: Vec<DVec3>,
    /// Joints of the skin and their weights, which sum to 1; empty for a vertex without weights.
    pub(super) weights: Vec<Vec<(usize, f64)>>,
    /// Triangles, counterclockwise from outside.
    pub(super) triangles: Vec<[usize; 3]>,
}

impl Bound {
    /// The triangles of a mesh whose skin has `joints` joints.
    ///
    /// # Errors
    /// [`GltfError::TooMany`], [`GltfError::Data`] or [`GltfError::NotFinite`].
    pub(super) fn read(
        document: &Document,
        node: &Node<'_>,
        mesh: &Mesh<'_>,
        joints: usize,
    ) -> Result<Self, GltfError> {
        let mut bound = Self::default();
        for primitive in mesh.primitives() {
            let reader = Reader {
                document,
                node: name_of(node),
                primitive,
            };
            reader.add_to(&mut bound, joints)?;
        }
        Ok(bound)
    }

    /// The corners of its bounding box, two opposite ones first and last.
    pub(super) fn corners(&self) -> Vec<DVec3> {
        let low = self.positions.iter().copied().reduce(DVec3::min);
        let high = self.positions.iter().copied().reduce(DVec3::max);
        let (Some(low), Some(high)) = (low, high) else {
            return Vec::new();
        };
        let corner = |i: usize| {
            let side = |axis: usize| {
                if i >> axis & 1 == 1 {
                    high[axis]
                } else {
                    low[axis]
                }
            };
            DVec3::new(side(0), side(1), side(2))
        };
        (0..8).map(corner).collect()
    }

    /// The mesh moved to `world`, m, y up.
    pub(super) fn placed(self, world: &DMat4) -> Placed {
        let place = |p: &DVec3| brush_mm(world.transform_point3(*p));
        let mut triangles = self.triangles;
        if world.determinant() < 0.0 {
            triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
        Placed {
            positions: self.positions.iter().map(place).collect(),
            weights: self.weights.iter().map(|w| normalised(w)).collect(),
            triangles,
        }
    }
}

impl Placed {
    /// A coordinate farther than `most` from the origin, mm.
    pub(super) fn outside(&self, most: f64) -> Option<f64> {
        let mut coordinates = self.positions.iter().flat_map(|at| at.to_array());
        coordinates.find(|mm| !(-most..=most).contains(mm))
    }

    /// Reach along a direction of the vertices whose weight on a joint is half or more, mm.
    pub(super) fn reach(&self, joint: usize, from: DVec3, along: DVec3) -> f64 {
        let follows = |weights: &[(usize, f64)]| {
            let own = weights.iter().filter(|(other, _)| *other == joint);
            own.map(|(_, weight)| weight).sum::<f64>() >= 0.5
        };
        let vertices = self.positions.iter().zip(&self.weights);
        vertices
            .filter(|(_, weights)| follows(weights))
            .map(|(at, _)| (*at - from).dot(along))
            .fold(0.0, f64::max)
    }
}

/// Weights normalised to the sum 1; empty without weights.
fn normalised(weights: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
    if sum > 1e-6 {
        weights.iter().map(|(joint, w)| (*joint, w / sum)).collect()
    } else {
        Vec::new()
    }
}

/// Reads one primitive of a mesh.
struct Reader<'a> {
    document: &'a Document,
    node: String,
    primitive: Primitive<'a>,
}

impl Reader<'_> {
    fn add_to(&self, bound: &mut Bound, joints: usize) -> Result<(), GltfError> {
        let first = bound.positions.len();
        let Some(positions) = self.primitive.get(&Semantic::Positions) else {
            let list = self.list("POSITION", Dimensions::Vec3);
            return Err(list.fault("is missing".to_owned()));
        };
        let numbers = self
            .document
            .numbers(&positions, self.list("POSITION", Dimensions::Vec3))?;
        bound
            .positions
            .extend(numbers.chunks_exact(3).map(DVec3::from_slice));
        most("vertices", bound.positions.len(), MOST_VERTICES)?;
        let count = bound.positions.len() - first;
        bound.weights.extend(self.weights(count, joints)?);
        let corners = self.corners(count)?;
        let triangles = corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]);
        bound
            .triangles
            .extend(triangles.map(|triangle| triangle.map(|corner| first + corner)));
        most("triangles", bound.triangles.len(), MOST_TRIANGLES)
    }

    /// The vertices of all triangles, three by three.
    fn corners(&self, vertices: usize) -> Result<Vec<usize>, GltfError> {
        let list = || self.list("the faces", Dimensions::Scalar);
        if self.primitive.mode() != Mode::Triangles {
            let why = format!("are {:?}, not triangles", self.primitive.mode());
            return Err(list().fault(why));
        }
        let corners = match self.primitive.indices() {
            Some(accessor) => self.document.indices(&accessor, list())?,
            None => (0..vertices).collect(),
        };
        match corners.iter().find(|corner| **corner >= vertices) {
            Some(corner) => Err(list().fault(format!("name vertex {corner} of {vertices}"))),
            None => Ok(corners),
        }
    }

    /// The joints of each vertex with their weights.
    fn weights(&self, vertices: usize, joints: usize) -> Result<Vec<Vec<(usize, f64)>>, GltfError> {
        let mut all = vec![Vec::new(); vertices];
        for set in 0..MOST_SETS {
            let (Some(tied), Some(shares)) = (
                self.primitive.get(&Semantic::Joints(set)),
                self.primitive.get(&Semantic::Weights(set)),
            ) else {
                break;
            };
            let (numbers, shares) = self.set(&tied, &shares)?;
            let list = |what| self.list(what, Dimensions::Vec4);
            if numbers.len() != 4 * vertices || shares.len() != 4 * vertices {
                return Err(list("WEIGHTS").fault("are not as many as the vertices".to_owned()));
            }
            for (i, (joint, share)) in numbers.into_iter().zip(shares).enumerate() {
                if share < 0.0 {
                    return Err(list("WEIGHTS").fault(format!("has {share}")));
                }
                if share > 0.0 && joint >= joints {
                    return Err(list("JOINTS").fault(format!("names bone {joint} of {joints}")));
                }
                if share > 0.0 {
                    all[i / 4].push((joint, share));
                }
            }
        }
        Ok(all)
    }

    fn set(
        &self,
        tied: &Accessor<'_>,
        shares: &Accessor<'_>,
    ) -> Result<(Vec<usize>, Vec<f64>), GltfError> {
        let list = |what| self.list(what, Dimensions::Vec4);
        let document = self.document;
        Ok((
            document.indices(tied, list("JOINTS"))?,
            document.numbers(shares, list("WEIGHTS"))?,
        ))
    }

    fn list(&self, what: &'static str, shape: Dimensions) -> List {
        List {
            what,
            node: self.node.clone(),
            shape,
        }
    }
}

fn most(what: &'static str, count: usize, most: usize) -> Result<(), GltfError> {
    if count <= most {
        Ok(())
    } else {
        Err(GltfError::TooMany { what, count, most })
    }
}
