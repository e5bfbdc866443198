//! Errors of a model, each with advice for Blender.

use crate::file::BrushError;

/// The reason why a glTF file gives no brush.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GltfError {
    /// The bytes are no glTF 2.0, or break its rules.
    #[error("this is not a readable glTF 2.0 file ({0}); export it as glTF Binary (.glb)")]
    NotGltf(String),
    /// The file ends too early.
    #[error("the file is cut short: {what} has {has} of {wants} bytes; export or copy it again")]
    Truncated {
        /// The part that ends too early.
        what: String,
        /// Bytes that are there.
        has: usize,
        /// Bytes that should be there.
        wants: usize,
    },
    /// Data lie in another file.
    #[error(
        "the data are in another file, '{uri}'; export as glTF Binary (.glb), which is one file"
    )]
    External {
        /// Location of the data.
        uri: String,
    },
    /// A list of numbers cannot be read.
    #[error("{what} of '{node}' {why}; export it again, without compression")]
    Data {
        /// The list, for example `POSITION`.
        what: &'static str,
        /// The node it belongs to.
        node: String,
        /// The error.
        why: String,
    },
    /// NaN or infinity.
    #[error("{what} of '{node}' is not finite; look for a scale of 0 or a broken modifier")]
    NotFinite {
        /// The list or field.
        what: &'static str,
        /// The node it belongs to.
        node: String,
    },
    /// A node is its own ancestor, or has two parents.
    #[error("the nodes are not a tree: '{node}' {why}; export it again")]
    NoTree {
        /// The node.
        node: String,
        /// The reason.
        why: &'static str,
    },
    /// Nothing to paint with.
    #[error("the file has no mesh; select the head and its armature, then export")]
    NoMesh,
    /// A mesh that nothing bends.
    #[error(
        "'{node}' is a mesh without a skin; parent it to an armature (Ctrl+P, With Automatic Weights)"
    )]
    NoSkin {
        /// The mesh object.
        node: String,
    },
    /// A skin without spines.
    #[error("the armature of '{node}' has no bones; give each spine a chain of them")]
    NoJoints {
        /// The mesh object.
        node: String,
    },
    /// A spine has two ends.
    #[error(
        "bone '{bone}' branches to '{one}' and '{other}'; only one root bone may carry several spines"
    )]
    Branching {
        /// Bone at which it branches.
        bone: String,
        /// One child.
        one: String,
        /// Another.
        other: String,
    },
    /// A spine of too many bones.
    #[error("the spine of '{bone}' has {joints} bones, but must have at most {most}")]
    TooManyJoints {
        /// Its first bone.
        bone: String,
        /// Number of joints.
        joints: usize,
        /// Largest number of joints.
        most: usize,
    },
    /// Too much of something else.
    #[error("there are {count} {what}, but must be at most {most}")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// Their number.
        count: usize,
        /// Largest number.
        most: usize,
    },
    /// A bone that ends where it begins, or whose end is unknown.
    #[error("bone '{bone}' has no length: {why}")]
    NoLength {
        /// The bone.
        bone: String,
        /// Advice.
        why: &'static str,
    },
    /// The model was exported bent.
    #[error("bone '{bone}' is posed; export with Armature > Use Rest Position Armature")]
    Posed {
        /// The bone.
        bone: String,
    },
    /// Vertices that would stay behind.
    #[error(
        "{count} vertices of '{node}' have no weights, the first at ({}, {}, {}) mm; \
         assign them to bones (Weights > Assign Automatic from Bones)",
        .at_mm[0], .at_mm[1], .at_mm[2]
    )]
    Unweighted {
        /// The mesh object.
        node: String,
        /// Their number.
        count: usize,
        /// Position of the first one, brush frame, mm.
        at_mm: [f64; 3],
    },
    /// The bristles point in another direction, or the head is elsewhere.
    #[error(
        "{what} does not hang along -Z of Blender; the origin is where head and ferrule meet, \
         and the bristles go down from it (in the exporter, +Y Up stays on)"
    )]
    NotHanging {
        /// Bone or mesh.
        what: String,
    },
    /// A head of no size that a brush has.
    #[error(
        "the head's {what} is {mm} mm, but must be {range} mm; glTF is in metres, so .01 is 10 mm"
    )]
    Size {
        /// Width, thickness or length.
        what: &'static str,
        /// The size, mm.
        mm: f64,
        /// Allowed range, mm.
        range: String,
    },
    /// A custom property of the wrong kind or out of its range.
    #[error("'{key}' of '{node}' is {value}, but must be {range}")]
    Property {
        /// Object or bone.
        node: String,
        /// The property.
        key: String,
        /// Its value.
        value: String,
        /// Allowed range.
        range: String,
    },
    /// A custom property that is nearly one of ours.
    #[error("'{key}' of '{node}' is not a property of a brush; did you mean '{nearest}'{place}?")]
    Misspelt {
        /// Object or bone.
        node: String,
        /// The property.
        key: String,
        /// The nearest one.
        nearest: &'static str,
        /// Place where that one belongs, if elsewhere.
        place: &'static str,
    },
    /// The whole is no brush that can be simulated.
    #[error("{0}")]
    Brush(#[from] BrushError),
}
