//! The nodes as a tree: parent and frame of each.

use glam::{DMat4, DQuat, DVec3, DVec4};
use gltf::Node;
use gltf::scene::Transform;

use super::document::{Document, name_of};
use super::error::GltfError;

/// The nodes of a file, by their numbers.
pub(super) struct Tree {
    /// The parent of each.
    pub(super) parents: Vec<Option<usize>>,
    /// Node frame to world, m, y up.
    pub(super) worlds: Vec<DMat4>,
}

impl Tree {
    /// The tree of a file.
    ///
    /// # Errors
    /// [`GltfError::NoTree`] or [`GltfError::NotFinite`].
    pub(super) fn of(document: &Document) -> Result<Self, GltfError> {
        let nodes: Vec<Node<'_>> = document.json.nodes().collect();
        let mut parents = vec![None; nodes.len()];
        for node in &nodes {
            for child in node.children() {
                if parents[child.index()].replace(node.index()).is_some() {
                    return Err(GltfError::NoTree {
                        node: name_of(&child),
                        why: "has two parents",
                    });
                }
            }
        }
        let mut worlds: Vec<Option<DMat4>> = vec![None; nodes.len()];
        let mut next: Vec<usize> = (0..nodes.len()).filter(|i| parents[*i].is_none()).collect();
        while let Some(number) = next.pop() {
            let node = &nodes[number];
            let above = parents[number].and_then(|parent| worlds[parent]);
            let world = above.unwrap_or(DMat4::IDENTITY) * own(node);
            if !world.is_finite() {
                return Err(GltfError::NotFinite {
                    what: "the transform",
                    node: name_of(node),
                });
            }
            worlds[number] = Some(world);
            next.extend(node.children().map(|child| child.index()));
        }
        let placed = worlds.into_iter().enumerate().map(|(number, world)| {
            world.ok_or_else(|| GltfError::NoTree {
                node: name_of(&nodes[number]),
                why: "is its own ancestor",
            })
        });
        Ok(Self {
            worlds: placed.collect::<Result<_, _>>()?,
            parents,
        })
    }

    /// A node's ancestors, the parent first.
    pub(super) fn ancestors(&self, node: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(self.parents[node], |above| self.parents[*above])
    }
}

/// Node frame to its parent's.
fn own(node: &Node<'_>) -> DMat4 {
    match node.transform() {
        Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|c| c.map(f64::from)))
        }
        Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => DMat4::from_scale_rotation_translation(
            DVec3::from_array(scale.map(f64::from)),
            DQuat::from_vec4(DVec4::from_array(rotation.map(f64::from)).normalize()),
            DVec3::from_array(translation.map(f64::from)),
        ),
    }
}
