//! Errors of a model, each with advice for Blender.

use crate::file::BrushError;

/// Errors of reading a brush from a glTF file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GltfError {
    /// The bytes are not glTF 2.0, or break its rules.
    #[error("this is not a readable glTF 2.0 file ({0}); export it as glTF Binary (.glb)")]
    NotGltf(String),
    /// The file ends too early.
    #[error("the file is cut short: {what} has {has} of {wants} bytes; export or copy it again")]
    Truncated {
        /// The part that ends too early.
        what: String,
        /// Number of bytes in the file.
        has: usize,
        /// Number of bytes needed.
        wants: usize,
    },
    /// The data are in another file.
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
        /// Name of the list, for example `POSITION`.
        what: &'static str,
        /// The node it belongs to.
        node: String,
        /// Reason that it cannot be read.
        why: String,
    },
    /// NaN or infinity.
    #[error("{what} of '{node}' is not finite; look for a scale of 0 or a broken modifier")]
    NotFinite {
        /// Name of the list or field.
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
    /// The file has no mesh.
    #[error("the file has no mesh; select the head and its armature, then export")]
    NoMesh,
    /// A mesh without a skin.
    #[error(
        "'{node}' is a mesh without a skin; parent it to an armature (Ctrl+P, With Automatic Weights)"
    )]
    NoSkin {
        /// The mesh object.
        node: String,
    },
    /// The skin has no joints.
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
    /// Too many of another item.
    #[error("there are {count} {what}, but must be at most {most}")]
    TooMany {
        /// The item.
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
        /// Reason, with advice.
        why: &'static str,
    },
    /// The model was exported bent.
    #[error("bone '{bone}' is posed; export with Armature > Use Rest Position Armature")]
    Posed {
        /// The bone.
        bone: String,
    },
    /// Vertices without weights, which would not move with the head.
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
    /// The bristles point in a wrong direction, or the head is not at the origin.
    #[error(
        "{what} does not hang along -Z of Blender; the origin is where head and ferrule meet, \
         and the bristles go down from it (in the exporter, +Y Up stays on)"
    )]
    NotHanging {
        /// Bone or mesh.
        what: String,
    },
    /// A head whose size is out of range.
    #[error(
        "the head's {what} is {mm} mm, but must be {range} mm; glTF is in metres, so .01 is 10 mm"
    )]
    Size {
        /// The dimension: width, thickness or length.
        what: &'static str,
        /// The size, mm.
        mm: f64,
        /// Allowed range, mm.
        range: String,
    },
    /// A custom property of a wrong type or out of range.
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
    /// A custom property whose name resembles a known one.
    #[error("'{key}' of '{node}' is not a property of a brush; did you mean '{nearest}'{place}?")]
    Misspelt {
        /// Object or bone.
        node: String,
        /// The property.
        key: String,
        /// The nearest one.
        nearest: &'static str,
        /// Owner of the nearest property, if it is another.
        place: &'static str,
    },
    /// The result is not a valid brush.
    #[error("{0}")]
    Brush(#[from] BrushError),
}
