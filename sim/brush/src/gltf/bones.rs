//! Bones: the chains that make spines, their positions, and their stiffness.

use std::collections::BTreeMap;

use glam::{DMat4, DVec3, DVec4};
use gltf::accessor::Dimensions;
use gltf::{Node, Skin};

use super::document::{Document, List, name_of};
use super::error::GltfError;
use super::extras::{Owner, Properties};
use super::mesh::Placed;
use super::tree::Tree;
use super::{brush_axes, brush_mm, to_10_nm};
use crate::file::BrushFile;
use crate::file::check::MOST_JOINTS;
use crate::file::sections::Chain;

/// Spines of a head at most.
const MOST_SPINES: usize = 24;
/// Length below which a bone has no direction, mm.
const LEAST_MM: f64 = 1e-3;
/// Difference of joints, as a share of the model's size, above which the model was exported posed.
const POSED: f64 = 1e-3;

/// The joints of a skin, numbered as there.
pub(super) struct Bones {
    names: Vec<String>,
    properties: Vec<Properties>,
    /// Heads of the bones, brush frame, mm.
    heads: Vec<DVec3>,
    /// Unit y axis of each in the brush frame: the direction of a bone in Blender.
    ways: Vec<DVec3>,
    /// The joints of each spine, from the ferrule to the point.
    spines: Vec<Vec<usize>>,
    /// Number of each joint, counted through all spines; `None` for a root that carries them.
    numbers: Vec<Option<usize>>,
}

/// A spine at rest in the brush frame, mm.
pub(super) struct Line {
    root: DVec3,
    /// Each bone from its head to its end.
    segments: Vec<DVec3>,
}

impl Line {
    /// Depth of its end below the ferrule, mm.
    pub(super) fn depth_mm(&self) -> f64 {
        -(self.root + self.segments.iter().sum::<DVec3>()).z
    }
}

impl Bones {
    /// The bones of a skin.
    ///
    /// # Errors
    /// [`GltfError::NoJoints`], [`GltfError::Branching`], [`GltfError::TooManyJoints`],
    /// [`GltfError::TooMany`], or what is wrong with a property.
    pub(super) fn of(tree: &Tree, node: &Node<'_>, skin: &Skin<'_>) -> Result<Self, GltfError> {
        let joints: Vec<Node<'_>> = skin.joints().collect();
        let names: Vec<String> = joints.iter().map(name_of).collect();
        let properties = joints
            .iter()
            .zip(&names)
            .map(|(joint, name)| Properties::of(name, Owner::Bone, joint.extras()))
            .collect::<Result<_, _>>()?;
        let spines = spines(tree, &joints, &names)?;
        if spines.is_empty() {
            return Err(GltfError::NoJoints {
                node: name_of(node),
            });
        }
        let mut numbers = vec![None; joints.len()];
        for (number, joint) in spines.iter().flatten().enumerate() {
            numbers[*joint] = Some(number);
        }
        let world = |joint: &Node<'_>| tree.worlds[joint.index()];
        let way = |joint| brush_axes(world(joint).transform_vector3(DVec3::Y)).normalize_or_zero();
        let head = |joint| brush_mm(world(joint).transform_point3(DVec3::ZERO));
        Ok(Self {
            heads: joints.iter().map(head).collect(),
            ways: joints.iter().map(way).collect(),
            names,
            properties,
            spines,
            numbers,
        })
    }

    /// The shape of each spine at rest.
    ///
    /// # Errors
    /// [`GltfError::NoLength`] or [`GltfError::NotHanging`].
    pub(super) fn lines(&self, mesh: &Placed) -> Result<Vec<Line>, GltfError> {
        let line = |spine: &Vec<usize>| {
            let segments = self.segments(spine, mesh)?;
            let whole: DVec3 = segments.iter().sum();
            if whole.z >= 0.0 {
                return Err(GltfError::NotHanging {
                    what: format!("the spine of bone '{}'", self.names[spine[0]]),
                });
            }
            Ok(Line {
                root: self.heads[spine[0]],
                segments,
            })
        };
        self.spines.iter().map(line).collect()
    }

    /// The spines as a brush file has them; properties that the model lacks are those of `like`.
    pub(super) fn chains(&self, lines: &[Line], like: &BrushFile) -> Vec<Chain> {
        let chain = |(spine, line): (&Vec<usize>, &Line)| {
            let stiffness = self.stiffness(spine, &line.segments, like);
            let damping = |(joint, k): (&usize, &f64)| {
                let share = self.properties[*joint].number("damping");
                share.unwrap_or(like.spines.damping) * k
            };
            Chain {
                root_mm: line.root.to_array(),
                segments_mm: line.segments.iter().map(|s| s.to_array()).collect(),
                damping_n_mm: spine.iter().zip(&stiffness).map(damping).collect(),
                stiffness_n_mm: stiffness,
            }
        };
        self.spines.iter().zip(lines).map(chain).collect()
    }

    /// Each bone of a spine from its head to the next one's, the last to its own end, mm.
    fn segments(&self, spine: &[usize], mesh: &Placed) -> Result<Vec<DVec3>, GltfError> {
        let head = |joint: &usize| self.heads[*joint];
        let mut segments: Vec<DVec3> = spine
            .windows(2)
            .map(|pair| head(&pair[1]) - head(&pair[0]))
            .collect();
        let Some(last) = spine.last() else {
            return Ok(segments);
        };
        segments.push(match self.properties[*last].number("length_m") {
            Some(length) => to_10_nm(self.ways[*last] * (1e3 * length)),
            None => {
                let along = segments
                    .last()
                    .map_or(DVec3::NEG_Z, |s| s.normalize_or_zero());
                to_10_nm(along * mesh.reach(*last, head(last), along))
            }
        });
        let short = segments.iter().position(|s| s.length() < LEAST_MM);
        match short {
            Some(i) => Err(GltfError::NoLength {
                bone: self.names[spine[i]].clone(),
                why: if i + 1 == segments.len() {
                    "export with the add-on, which sets 'length_m', or tie the point to it"
                } else {
                    "move the bone that follows it away from its head"
                },
            }),
            None => Ok(segments),
        }
    }

    /// K = EI/l of each joint, N·mm/rad, doubled at the clamp as in [`crate::spine::Spine::uniform`].
    fn stiffness(&self, spine: &[usize], segments: &[DVec3], like: &BrushFile) -> Vec<f64> {
        let whole: f64 = segments.iter().map(|segment| segment.length()).sum();
        let mut before = 0.0;
        let joints = spine.iter().zip(segments).enumerate();
        joints
            .map(|(i, (joint, segment))| {
                let length = segment.length();
                let default = like.spines.bending_stiffness_n_mm2
                    * like.stiffness_share(before / whole)
                    / self.spines.len() as f64;
                before += length;
                let ei = self.properties[*joint].number("stiffness");
                let clamped = if i == 0 { 2.0 } else { 1.0 };
                clamped * ei.unwrap_or(default) / length
            })
            .collect()
    }

    /// Weights of a vertex at `at` on joints counted through all spines, instead of the joints of the skin. A root
    /// bone that is no spine itself gives its share to the nearest spine.
    pub(super) fn carriers(&self, at: DVec3, weights: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let from = |spine: &Vec<usize>| (self.heads[spine[0]] - at).length_squared();
        let nearest = self
            .spines
            .iter()
            .min_by(|a, b| from(a).total_cmp(&from(b)));
        let instead = nearest.and_then(|spine| self.numbers[spine[0]]);
        let mut carriers = BTreeMap::<usize, f64>::new();
        for (joint, weight) in weights {
            if let Some(number) = self.numbers[*joint].or(instead) {
                *carriers.entry(number).or_default() += weight;
            }
        }
        carriers.into_iter().collect()
    }

    /// True if Blender's exporter made this joint for vertices without weights.
    pub(super) fn is_neutral(&self, joint: usize) -> bool {
        self.names[joint] == "neutral_bone"
    }
}

/// The joints of each spine: chains of joints that begin at a joint without a parent, or at the children of one
/// common root.
fn spines(
    tree: &Tree,
    joints: &[Node<'_>],
    names: &[String],
) -> Result<Vec<Vec<usize>>, GltfError> {
    let mut numbers = vec![None; tree.parents.len()];
    for (i, joint) in joints.iter().enumerate() {
        numbers[joint.index()] = Some(i);
    }
    let mut children = vec![Vec::new(); joints.len()];
    let mut roots = Vec::new();
    for (i, joint) in joints.iter().enumerate() {
        let mut ancestors = tree.ancestors(joint.index());
        match ancestors.find_map(|above| numbers[above]) {
            Some(above) => children[above].push(i),
            None => roots.push(i),
        }
    }
    let branching = |bone: usize| GltfError::Branching {
        bone: names[bone].clone(),
        one: names[children[bone][0]].clone(),
        other: names[children[bone][1]].clone(),
    };
    let mut carriers = roots.iter().filter(|root| children[**root].len() > 1);
    if let (Some(carrier), other) = (carriers.next().copied(), carriers.next()) {
        if let Some(other) = other {
            return Err(branching(*other));
        }
        roots.retain(|root| *root != carrier);
        roots.extend(&children[carrier]);
    }
    if roots.len() > MOST_SPINES {
        return Err(GltfError::TooMany {
            what: "spines",
            count: roots.len(),
            most: MOST_SPINES,
        });
    }
    let chain = |root: usize| {
        let mut spine = vec![root];
        let mut end = root;
        while let [first, others @ ..] = &children[end][..] {
            if !others.is_empty() {
                return Err(branching(end));
            }
            end = *first;
            spine.push(end);
        }
        match spine.len() {
            ..=MOST_JOINTS => Ok(spine),
            count => Err(GltfError::TooManyJoints {
                bone: names[root].clone(),
                joints: count,
                most: MOST_JOINTS,
            }),
        }
    };
    roots.into_iter().map(chain).collect()
}

/// Motion from the mesh's bind pose to its rest pose, world frame, the same for all joints; without inverse bind
/// matrices, the transform of the mesh's own node.
///
/// # Errors
/// [`GltfError::Posed`], or that the matrices cannot be read.
pub(super) fn bind(
    document: &Document,
    tree: &Tree,
    node: &Node<'_>,
    skin: &Skin<'_>,
    corners: &[DVec3],
) -> Result<DMat4, GltfError> {
    let Some(accessor) = skin.inverse_bind_matrices() else {
        return Ok(tree.worlds[node.index()]);
    };
    let list = |node: &Node<'_>| List {
        what: "the inverse bind matrix",
        node: name_of(node),
        shape: Dimensions::Mat4,
    };
    let numbers = document.numbers(&accessor, list(node))?;
    let columns: Vec<DVec4> = numbers.chunks_exact(4).map(DVec4::from_slice).collect();
    let joints: Vec<Node<'_>> = skin.joints().collect();
    let binds: Vec<DMat4> = joints
        .iter()
        .zip(columns.chunks_exact(4))
        .map(|(joint, c)| tree.worlds[joint.index()] * DMat4::from_cols(c[0], c[1], c[2], c[3]))
        .collect();
    if binds.len() < joints.len() {
        return Err(list(node).fault("is missing for some bones".to_owned()));
    }
    let placed = |bind: &DMat4| -> Vec<DVec3> {
        let points = corners.iter();
        points
            .map(|corner| bind.transform_point3(*corner))
            .collect()
    };
    let Some(first) = binds.first() else {
        return Ok(tree.worlds[node.index()]);
    };
    let rest = placed(first);
    let size = match rest[..] {
        [a, .., b] => (a - b).length(),
        _ => 0.0,
    };
    for (joint, bind) in joints.iter().zip(&binds) {
        if !bind.is_finite() {
            return Err(GltfError::NotFinite {
                what: "the inverse bind matrix",
                node: name_of(joint),
            });
        }
        let moved = placed(bind);
        let apart = moved.iter().zip(&rest).map(|(a, b)| (*a - *b).length());
        if apart.fold(0.0, f64::max) > POSED * size {
            return Err(GltfError::Posed {
                bone: name_of(joint),
            });
        }
    }
    Ok(*first)
}
