//! A brush modelled in Blender: glTF 2.0 with an armature for the spines and a skinned mesh for the head (Khronos,
//! glTF 2.0 specification, § 3.7).
//!
//! | of the model | in the brush file |
//! | --- | --- |
//! | the first object with a mesh and a skin | the head; its custom properties, and those of its armature, are the brush's |
//! | a chain of bones | a spine; one root bone may carry several chains, and is then no spine |
//! | property `stiffness` of a bone, N·mm² | the bending stiffness EI of its spine there: K = EI/l, doubled at the clamp |
//! | property `damping` of a bone | its inner friction by its spring's torque at 1 rad |
//! | property `length_m` of a last bone, m | its length along its y axis, which glTF does not have |
//! | faces and weights | the skin: seams are welded, and quadrilaterals made whole again |
//!
//! Blender's z is up, and its exporter turns that to glTF's y; the brush frame is Blender's, in mm: bristles along
//! −z, the origin where head and ferrule meet. Properties that the model lacks are those of the library's `round` of
//! the same width. `docs/brushes.md` explains modelling.

mod bones;
mod document;
mod error;
mod extras;
mod measure;
mod mesh;
mod tree;
mod weld;

use std::ops::RangeInclusive;

use glam::DVec3;
use gltf::{Mesh, Node, Skin};

use self::bones::{Bones, Line};
use self::document::{Document, name_of};
pub use self::error::GltfError;
use self::extras::{Owner, Properties};
use self::measure::{Measured, measure};
use self::mesh::{Bound, Placed};
use self::tree::Tree;
use crate::file::BrushFile;
use crate::file::sections::{Contact, Head, Layout, Load, Spines, Strips, Surface};

/// The library's brush that supplies properties a model lacks.
const LIKE: &str = "round";
/// Number of subdivisions of the mesh, and recession of the skin as the head opens, mm.
const SKIN: (f64, f64) = (2.0, 0.3);
/// Coordinates of a brush file's skin at most, mm.
const FARTHEST_MM: f64 = 500.0;
/// Vertices of a brush file's skin at most.
const MOST_VERTICES: usize = 4096;

/// Reads a brush from a .glb, or from a .gltf with its data embedded.
///
/// # Errors
/// [`GltfError`], which names the node, the fault and its remedy.
pub fn read(bytes: &[u8]) -> Result<BrushFile, GltfError> {
    let document = Document::parse(bytes)?;
    let tree = Tree::of(&document)?;
    let (node, mesh, skin) = skinned(&document)?;
    let properties = properties(&document, &tree, &node, &mesh, &skin)?;
    let bones = Bones::of(&tree, &node, &skin)?;
    let bound = Bound::read(&document, &node, &mesh, skin.joints().count())?;
    let world = bones::bind(&document, &tree, &node, &skin, &bound.corners())?;
    let placed = bound.placed(&world);
    if let Some(mm) = placed.outside(FARTHEST_MM) {
        size("distance from the origin", mm.abs(), 0.0..=FARTHEST_MM)?;
    }
    let surface = surface(&node, &bones, &placed, &properties)?;
    let brush = brush(&node, &bones, &placed, surface, &properties)?;
    brush.check()?;
    Ok(brush)
}

/// A direction in glTF's frame, turned into the brush's, which is Blender's.
fn brush_axes(world: DVec3) -> DVec3 {
    DVec3::new(world.x, -world.z, world.y)
}

/// A position in glTF's frame, m, in the brush's frame, mm.
fn brush_mm(world: DVec3) -> DVec3 {
    to_10_nm(brush_axes(world) * 1e3)
}

/// Rounded to 10 nm to remove the noise of single precision, mm.
fn to_10_nm(mm: DVec3) -> DVec3 {
    (mm * 1e5).round() / 1e5
}

/// The first node with a mesh and a skin.
fn skinned(document: &Document) -> Result<(Node<'_>, Mesh<'_>, Skin<'_>), GltfError> {
    let mut bare = None;
    for node in document.json.nodes() {
        match (node.mesh(), node.skin()) {
            (Some(mesh), Some(skin)) => return Ok((node, mesh, skin)),
            (Some(_), None) if bare.is_none() => bare = Some(name_of(&node)),
            _ => (),
        }
    }
    Err(bare.map_or(GltfError::NoMesh, |node| GltfError::NoSkin { node }))
}

/// The properties of the mesh, then of its data, its armature and what both are parented to.
fn properties(
    document: &Document,
    tree: &Tree,
    node: &Node<'_>,
    mesh: &Mesh<'_>,
    skin: &Skin<'_>,
) -> Result<Properties, GltfError> {
    let joints: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
    let nodes: Vec<Node<'_>> = document.json.nodes().collect();
    let data = mesh.name().unwrap_or("the mesh");
    let own = Properties::of(&name_of(node), Owner::Object, node.extras())?;
    let own = own.or(Properties::of(data, Owner::Object, mesh.extras())?);
    let first = joints.first().into_iter();
    first
        .flat_map(|joint| tree.ancestors(*joint))
        .chain(tree.ancestors(node.index()))
        .filter(|above| !joints.contains(above))
        .try_fold(own, |own, above| {
            let above = &nodes[above];
            let its = Properties::of(&name_of(above), Owner::Object, above.extras())?;
            Ok(own.or(its))
        })
}

/// The skin: the welded mesh, in quadrilaterals where it was, tied to the spines.
fn surface(
    node: &Node<'_>,
    bones: &Bones,
    placed: &Placed,
    properties: &Properties,
) -> Result<Surface, GltfError> {
    let firsts = weld::same(&placed.positions);
    let mut numbers = vec![0; firsts.len()];
    let mut kept = Vec::new();
    for (i, first) in firsts.iter().enumerate() {
        if *first == i {
            numbers[i] = kept.len();
            kept.push(i);
        }
    }
    let stays = |i: &&usize| {
        let weights = &placed.weights[**i];
        weights.is_empty() || weights.iter().any(|(joint, _)| bones.is_neutral(*joint))
    };
    if let Some(first) = kept.iter().find(stays) {
        return Err(GltfError::Unweighted {
            node: name_of(node),
            count: kept.iter().filter(stays).count(),
            at_mm: placed.positions[*first]
                .to_array()
                .map(|mm| (mm * 1e3).round() / 1e3),
        });
    }
    if kept.len() > MOST_VERTICES {
        return Err(GltfError::TooMany {
            what: "vertices",
            count: kept.len(),
            most: MOST_VERTICES,
        });
    }
    let welded = placed
        .triangles
        .iter()
        .map(|t| t.map(|corner| numbers[firsts[corner]]));
    let triangles: Vec<[usize; 3]> = welded
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    let positions: Vec<DVec3> = kept.iter().map(|i| placed.positions[*i]).collect();
    let carriers = |i: &usize| bones.carriers(placed.positions[*i], &placed.weights[*i]);
    let (levels, recede_mm) = SKIN;
    Ok(Surface {
        levels: properties.number("levels").unwrap_or(levels) as usize,
        recede_mm: properties.number("recede_mm").unwrap_or(recede_mm),
        faces: weld::quads(&positions, &triangles),
        vertices_mm: positions.iter().map(|at| at.to_array()).collect(),
        weights: kept.iter().map(carriers).collect(),
    })
}

fn brush(
    node: &Node<'_>,
    bones: &Bones,
    placed: &Placed,
    surface: Surface,
    properties: &Properties,
) -> Result<BrushFile, GltfError> {
    let round = BrushFile::library(LIKE)?;
    let vertices: Vec<DVec3> = surface.vertices_mm.iter().map(|at| (*at).into()).collect();
    let deepest = vertices.iter().map(|at| -at.z).fold(0.0, f64::max);
    let elsewhere = || GltfError::NotHanging {
        what: format!("'{}'", name_of(node)),
    };
    let lines = bones.lines(placed)?;
    let length_mm = lines.iter().map(Line::depth_mm).fold(deepest, f64::max);
    size("length", length_mm, 0.5..=500.0)?;
    let measured =
        measure(&vertices, &surface.faces, surface.levels, length_mm).ok_or_else(elsewhere)?;
    let [width_mm, thickness_mm] = measured.across_mm;
    size("width", width_mm, 0.1..=300.0)?;
    size("thickness", thickness_mm, 0.05..=300.0)?;
    let like = round.scaled_to(width_mm)?;
    let chains = bones.chains(&lines, &like);
    Ok(BrushFile {
        kind: properties.kind().map_or(name_of(node), str::to_owned),
        about: String::new(),
        sizes_mm: Vec::new(),
        head: head(like.head, measured, length_mm),
        spines: Spines {
            layout: Layout::Chains,
            chains,
            count: 0,
            joints: 0,
            bending_stiffness_n_mm2: 0.0,
            stiffness_profile: Vec::new(),
            damping: 0.0,
            damping_soaked: like.spines.damping_soaked,
            curl_deg: 0.0,
            ..like.spines
        },
        strips: Strips {
            count: properties
                .number("strips")
                .map_or(like.strips.count, |count| count as usize),
            width_mm: properties
                .number("strip_width_mm")
                .unwrap_or(like.strips.width_mm),
            ..like.strips
        },
        surface: Some(surface),
        contact: contact(like.contact, properties),
        load: Load {
            film_um: properties.number("film_um").unwrap_or(like.load.film_um),
            ..like.load
        },
        // Follows from the head's stiffness.
        force: None,
    })
}

fn head(like: Head, measured: Measured, length_mm: f64) -> Head {
    let [profile, thickness_profile] = measured.profiles;
    let [width_mm, thickness_mm] = measured.across_mm;
    Head {
        outline: measured.outline,
        width_mm,
        thickness_mm: Some(thickness_mm),
        length_mm,
        profile,
        thickness_profile,
        ..like
    }
}

/// Friction; sliding friction alone counts for sticking as well.
fn contact(like: Contact, properties: &Properties) -> Contact {
    let friction = properties.number("friction");
    let sticking = match friction {
        Some(_) => None,
        None => like.friction_static,
    };
    Contact {
        friction: friction.unwrap_or(like.friction),
        friction_static: properties.number("friction_static").or(sticking),
        anisotropy: properties.number("anisotropy").unwrap_or(like.anisotropy),
        ..like
    }
}

fn size(what: &'static str, mm: f64, range: RangeInclusive<f64>) -> Result<(), GltfError> {
    if range.contains(&mm) {
        Ok(())
    } else {
        Err(GltfError::Size {
            what,
            mm,
            range: format!("{} to {}", range.start(), range.end()),
        })
    }
}
