//! Bounds of the numbers of a brush file.

use std::ops::RangeInclusive;

use maulstick_types::values::Quantity;

use super::quantities::{Friction, HeadWidth, Lift, LoadFilm, LoadInside, Opening, Unevenness};
use super::sections::{Chain, Layout, Surface};
use super::{BrushError, BrushFile};

/// Joints of a spine at most.
pub const MOST_JOINTS: usize = 64;
/// Greatest number of joints of all spines: a state of one solve fits a message many times over.
pub const MOST_IN_ALL: usize = 512;

/// Strips of a head at most.
pub const STRIPS_MOST: usize = 4096;
/// Corners of all faces of a skin at most, once it is subdivided.
pub const MOST_CORNERS: usize = 60_000;
/// Half a ferrule is at least this share of half the greatest width or thickness.
const LEAST_ROOT: f64 = 0.01;

/// Checks that a field is within its range.
///
/// # Errors
/// [`BrushError::Range`].
pub fn within(field: &str, value: f64, range: RangeInclusive<f64>) -> Result<(), BrushError> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(BrushError::Range {
        field: field.to_owned(),
        value,
        range: format!("{} to {}", range.start(), range.end()),
    })
}

fn quantity<Q: Quantity>(value: f64) -> Result<(), BrushError> {
    within(Q::NAME, value, Q::RANGE)
}

fn must(field: &str, value: usize, holds: bool, range: &str) -> Result<(), BrushError> {
    if holds {
        return Ok(());
    }
    Err(BrushError::Range {
        field: field.to_owned(),
        value: value as f64,
        range: range.to_owned(),
    })
}

/// Checks a curve of places and shares.
fn curve(
    field: &str,
    points: &[[f64; 2]],
    places: RangeInclusive<f64>,
    shares: RangeInclusive<f64>,
) -> Result<(), BrushError> {
    let mut last = f64::NEG_INFINITY;
    for [place, share] in points {
        within(&format!("{field} (share)"), *share, shares.clone())?;
        within(&format!("{field} (place)"), *place, places.clone())?;
        if *place <= last {
            return Err(BrushError::Range {
                field: format!("{field} (place)"),
                value: *place,
                range: "in rising order".to_owned(),
            });
        }
        last = *place;
    }
    must(
        field,
        points.len(),
        points.len() != 1,
        "at least two points",
    )
}

/// Checks all numbers of a file.
///
/// # Errors
/// [`BrushError::Range`] with the field.
pub fn check(file: &BrushFile) -> Result<(), BrushError> {
    head(file)?;
    spines(file)?;
    strips(file)?;
    if let Some(skin) = &file.surface {
        surface(skin, file.spines.all_joints())?;
    }
    let contact = &file.contact;
    quantity::<Friction>(contact.friction)?;
    if let Some(sticking) = contact.friction_static {
        let range = contact.friction..=*Friction::RANGE.end();
        within("contact.friction_static", sticking, range)?;
    }
    within("contact.anisotropy", contact.anisotropy, 0.0..=1.0)?;
    within("contact.focus", contact.focus, 1.01..=100.0)?;
    quantity::<LoadFilm>(file.load.film_um)?;
    quantity::<LoadInside>(file.load.inside_um)?;
    for size in &file.sizes_mm {
        within("sizes_mm", *size, HeadWidth::RANGE)?;
    }
    file.force
        .as_ref()
        .map_or(Ok(()), |force| tuples(&force.hermite))
}

/// Checks the tuples of the Hermite curve: the force rises with depth throughout, which a cubic does
/// where its slopes are at most three times that of the chord (Fritsch and Carlson 1980).
fn tuples(tuples: &[[f64; 3]]) -> Result<(), BrushError> {
    let count = tuples.len();
    must("force.hermite", count, count == 5, "five tuples")?;
    for (place, [depth, force, slope]) in tuples.iter().enumerate() {
        let depths = match place {
            0 => 0.0..=0.0,
            3 => 1.0..=1.0,
            _ => 0.0..=3.0,
        };
        within("force.hermite (depth)", *depth, depths)?;
        let most = if place == 0 { 0.0 } else { 50.0 };
        within("force.hermite (force)", *force, 0.0..=most)?;
        within("force.hermite (slope)", *slope, 0.0..=1000.0)?;
    }
    for pair in tuples.windows(2) {
        let [[x0, y0, m0], [x1, y1, m1]] = [pair[0], pair[1]];
        let rising = |field: &str, value: f64, holds: bool, range: String| {
            if holds {
                Ok(())
            } else {
                Err(BrushError::Range {
                    field: field.to_owned(),
                    value,
                    range,
                })
            }
        };
        rising(
            "force.hermite (depth)",
            x1,
            x1 > x0,
            "in rising order".into(),
        )?;
        rising(
            "force.hermite (force)",
            y1,
            y1 >= y0,
            format!("at least {y0}"),
        )?;
        let most = 3.0 * (y1 - y0) / (x1 - x0);
        // A number with few digits may exceed the bound by its rounding.
        let within = |slope: f64| slope <= most * (1.0 + 1e-9);
        let range = format!("at most {most:.3} for the force to rise from depth {x0} to {x1}");
        rising("force.hermite (slope)", m0, within(m0), range.clone())?;
        rising("force.hermite (slope)", m1, within(m1), range)?;
    }
    Ok(())
}

fn head(file: &BrushFile) -> Result<(), BrushError> {
    let head = &file.head;
    quantity::<HeadWidth>(head.width_mm)?;
    within(
        "head.thickness_mm",
        head.thickness_mm.unwrap_or(1.0),
        0.05..=300.0,
    )?;
    within("head.length_mm", head.length_mm, 0.5..=500.0)?;
    must(
        "head.profile",
        head.profile.len(),
        head.profile.len() > 1,
        "at least two points",
    )?;
    curve("head.profile", &head.profile, 0.0..=1.0, 0.0..=1.0)?;
    curve(
        "head.thickness_profile",
        &head.thickness_profile,
        0.0..=1.0,
        0.0..=1.0,
    )?;
    let widest = 0.5e-3 * head.width_mm;
    let root = file.radius_m(0.0) / widest;
    within(
        "head.profile (share at the ferrule)",
        root,
        LEAST_ROOT..=1.0,
    )?;
    let thickest = 0.5e-3 * head.thickness_mm.unwrap_or(head.width_mm);
    let root = file.half_thickness_m(0.0) / thickest;
    within(
        "head.thickness_profile (share at the ferrule)",
        root,
        LEAST_ROOT..=1.0,
    )?;
    curve("head.tip", &head.tip, -1.0..=1.0, 0.05..=1.0)
}

fn spines(file: &BrushFile) -> Result<(), BrushError> {
    let spines = &file.spines;
    within("spines.volume", spines.volume, 0.0..=1000.0)?;
    within("spines.damping_soaked", spines.damping_soaked, 0.0..=100.0)?;
    for bond in spines.bond {
        within("spines.bond", bond, 0.0..=1000.0)?;
    }
    if spines.layout == Layout::Chains {
        let count = spines.chains.len();
        must(
            "spines.chain",
            count,
            (1..=24).contains(&count),
            "1 to 24 chains",
        )?;
        spines.chains.iter().try_for_each(chain)?;
    } else {
        let foreign = spines.chains.len();
        must(
            "spines.chain",
            foreign,
            foreign == 0,
            "absent: the layout is not 'chains'",
        )?;
        let most = 24.0;
        let least = if spines.layout == Layout::Ring {
            3.0
        } else {
            1.0
        };
        within("spines.count", spines.count as f64, least..=most)?;
        within("spines.share", spines.share, 0.05..=1.0)?;
        within(
            "spines.joints",
            spines.joints as f64,
            1.0..=MOST_JOINTS as f64,
        )?;
        let stiffness = spines.bending_stiffness_n_mm2;
        within("spines.bending_stiffness_n_mm2", stiffness, 1e-6..=1e9)?;
        let profile = &spines.stiffness_profile;
        curve("spines.stiffness_profile", profile, 0.0..=1.0, 1e-3..=10.0)?;
        within("spines.damping", spines.damping, 0.0..=1.0)?;
        within("spines.curl_deg", spines.curl_deg, -120.0..=120.0)?;
    }
    let joints = spines.all_joints();
    let range = format!("at most {MOST_IN_ALL} joints in all");
    must("spines", joints, joints <= MOST_IN_ALL, &range)
}

fn chain(chain: &Chain) -> Result<(), BrushError> {
    let joints = chain.segments_mm.len();
    let range = format!("1 to {MOST_JOINTS} segments");
    must(
        "spines.chain.segments_mm",
        joints,
        (1..=MOST_JOINTS).contains(&joints),
        &range,
    )?;
    for value in chain.root_mm {
        within("spines.chain.root_mm", value, -500.0..=500.0)?;
    }
    for segment in &chain.segments_mm {
        let length = segment.iter().map(|v| v * v).sum::<f64>().sqrt();
        within("spines.chain.segments_mm (length)", length, 1e-3..=500.0)?;
    }
    let (stiffness, damping) = (&chain.stiffness_n_mm, &chain.damping_n_mm);
    let each = "one for each segment";
    must(
        "spines.chain.stiffness_n_mm",
        stiffness.len(),
        stiffness.len() == joints,
        each,
    )?;
    must(
        "spines.chain.damping_n_mm",
        damping.len(),
        damping.len() == joints,
        each,
    )?;
    for value in stiffness {
        within("spines.chain.stiffness_n_mm", *value, 1e-9..=1e9)?;
    }
    for value in damping {
        within("spines.chain.damping_n_mm", *value, 0.0..=1e9)?;
    }
    Ok(())
}

fn strips(file: &BrushFile) -> Result<(), BrushError> {
    let strips = &file.strips;
    within(
        "strips.count",
        strips.count as f64,
        1.0..=STRIPS_MOST as f64,
    )?;
    within("strips.width_mm", strips.width_mm, 0.01..=50.0)?;
    within("strips.thickness_mm", strips.thickness_mm, 0.0..=10.0)?;
    within("strips.taper", strips.taper, 0.0..=1.0)?;
    quantity::<Lift>(strips.lift_mm)?;
    within("strips.sink_mm", strips.sink_mm, 0.0..=10.0)?;
    quantity::<Opening>(strips.open)?;
    quantity::<Unevenness>(strips.unevenness)?;
    within("strips.clumps", strips.clumps as f64, 0.0..=4096.0)?;
    for value in strips.clumping {
        within("strips.clumping", value, 0.0..=1.0)?;
    }
    Ok(())
}

fn surface(skin: &Surface, joints: usize) -> Result<(), BrushError> {
    within("surface.levels", skin.levels as f64, 1.0..=3.0)?;
    within("surface.recede_mm", skin.recede_mm, 0.0..=10.0)?;
    let vertices = skin.vertices_mm.len();
    must(
        "surface.vertices_mm",
        vertices,
        vertices <= 4096,
        "at most 4096 vertices",
    )?;
    for value in skin.vertices_mm.iter().flatten() {
        within("surface.vertices_mm", *value, -500.0..=500.0)?;
    }
    let weighted = skin.weights.len();
    must(
        "surface.weights",
        weighted,
        weighted == vertices,
        "one list for each vertex",
    )?;
    must(
        "surface.faces",
        skin.faces.len(),
        skin.faces.is_empty() == (vertices == 0),
        "faces over the vertices",
    )?;
    let corners: usize = skin.faces.iter().map(Vec::len).sum();
    let fine = corners << (2 * (skin.levels - 1));
    let range = format!("at most {MOST_CORNERS} corners once it is subdivided");
    must("surface.faces", fine, fine <= MOST_CORNERS, &range)?;
    let pairs: usize = skin.weights.iter().map(Vec::len).sum();
    must(
        "surface.weights",
        pairs,
        pairs <= 8 * vertices,
        "at most 8 joints a vertex",
    )?;
    faces(skin)?;
    weights(skin, joints)
}

fn faces(skin: &Surface) -> Result<(), BrushError> {
    let vertices = skin.vertices_mm.len();
    for face in &skin.faces {
        must(
            "surface.faces",
            face.len(),
            face.len() >= 3,
            "at least three vertices a face",
        )?;
        for vertex in face {
            must(
                "surface.faces",
                *vertex,
                *vertex < vertices,
                "the number of a vertex",
            )?;
        }
    }
    Ok(())
}

fn weights(skin: &Surface, joints: usize) -> Result<(), BrushError> {
    for weights in &skin.weights {
        for (joint, weight) in weights {
            must(
                "surface.weights (joint)",
                *joint,
                *joint < joints,
                "the number of a joint",
            )?;
            within("surface.weights (weight)", *weight, 0.0..=1.0)?;
        }
        let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
        within("surface.weights (sum)", sum, 0.999..=1.001)?;
    }
    Ok(())
}
