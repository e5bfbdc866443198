//! The shape of a brush over a surface: its ferrule and handle as a chain of discs, its shadow.
//!
//! Lengths are desk lengths in the frame of the surface below, m; z is the height above it.

use glam::{DVec2, DVec3};
use maulstick_brush::head::STATIONS;
use maulstick_brush::{BrushFile, HeadPose};
use maulstick_num::geometry::Rigid;

/// Length of the handle, m.
const HANDLE_M: f64 = 0.15;
/// Length of the ferrule by the width of the head.
const FERRULE: f64 = 2.3;
/// Half the angle under which the lamp is seen, as a slope: by it a shadow blurs with height.
const LAMP_SIZE: f64 = 0.09;
/// How dark a shadow is, and how much darker under what touches.
const SHADOW: f64 = 0.3;
const TOUCH: f64 = 0.2;
/// Height at which the darkness of touching has halved, m.
const NEAR_M: f64 = 1.5e-3;
/// Height at which a shadow has faded to half, m.
const FAR_M: f64 = 0.12;

/// Cross-sections of ferrule and handle.
pub const SECTIONS: usize = 11;

/// What a part is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Material {
    /// The ferrule.
    Metal,
    /// A groove of the ferrule, which crimps it to the handle.
    Groove,
    /// The handle.
    Wood,
}

/// A round cross-section of a brush, and the part that begins there toward the handle's end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Its middle.
    pub at: DVec3,
    /// m.
    pub radius: f64,
    /// What begins here.
    pub material: Material,
}

/// A disc of shadow on the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shade {
    /// Its middle on the surface.
    pub at: DVec2,
    /// m.
    pub radius: f64,
    /// Half the width of its soft edge, m.
    pub softness: f64,
    /// 0 to 1.
    pub darkness: f64,
}

/// Ferrule and handle of a brush at `brush` (brush frame to surface frame) whose head is `width_m`
/// wide and leaves the ferrule with `root_m` radius: from the head upward.
#[must_use]
pub fn sections(brush: &Rigid, width_m: f64, root_m: f64) -> [Section; SECTIONS] {
    use Material::{Groove, Metal, Wood};
    let top = 0.36 * width_m;
    let metal = |place: f64, material: Material| {
        let radius = root_m * 1.04 + (top - root_m * 1.04) * place;
        (place * FERRULE * width_m, radius, material)
    };
    let wood = |place: f64, radius: f64| {
        let z = FERRULE * width_m + place * HANDLE_M;
        (z, radius * width_m, Wood)
    };
    [
        metal(0.0, Metal),
        metal(0.66, Groove),
        metal(0.71, Metal),
        metal(0.8, Groove),
        metal(0.85, Metal),
        wood(0.0, 0.36),
        wood(0.05, 0.44),
        wood(0.14, 0.5),
        wood(0.32, 0.42),
        wood(0.65, 0.27),
        wood(1.0, 0.19),
    ]
    .map(|(z, radius, material)| Section {
        at: brush.point(DVec3::new(0.0, 0.0, z)),
        radius,
        material,
    })
}

/// Width by thickness from which a head casts its shadow in three parts.
const WIDE: f64 = 1.8;
/// Discs of a head at most.
pub const HEAD_DISCS: usize = 12;
/// Stations of such a part.
const OF_A_PART: [usize; 4] = [0, 3, 6, STATIONS - 1];

/// Width of the handle's thickest part for the head of a brush file, m: a fan spreads beyond its
/// ferrule.
#[must_use]
pub fn handle_width_m(file: &BrushFile) -> f64 {
    let root = file.radius_m(0.0).max(file.half_thickness_m(0.0));
    (1e-3 * file.head.width_mm).min(3.0 * root)
}

/// Discs that cover a head, in a chain that ends at the ferrule: the middle of the strips at each
/// station and their radius across the way that they go along the surface. A wide head is three such
/// chains, joined.
#[must_use]
pub fn head_discs(pose: &HeadPose, roots: &[[f32; 2]], wide: bool) -> Vec<(DVec3, f64)> {
    let part = |from: f32, to: f32| -> Vec<usize> {
        let within = |strip: &usize| (from..to).contains(&roots[*strip][0]);
        (0..roots.len()).filter(within).collect()
    };
    let strips = roots.len().max(1);
    if !wide {
        let stations: Vec<usize> = (0..pose.x.len() / strips).rev().collect();
        return part_discs(pose, strips, &part(-2.0, 2.0), &stations);
    }
    let third = 1.0 / 3.0;
    let (down, mut up) = (OF_A_PART, OF_A_PART);
    up.reverse();
    let parts = [(-2.0, -third, up), (-third, third, down), (third, 2.0, up)];
    parts
        .into_iter()
        .flat_map(|(from, to, stations)| part_discs(pose, strips, &part(from, to), &stations))
        .collect()
}

/// Whether the head of a brush file is wide.
#[must_use]
pub fn is_wide(file: &BrushFile) -> bool {
    file.radius_m(0.5) > WIDE * file.half_thickness_m(0.5)
}

/// The discs of some of the strips at some of the stations.
fn part_discs(
    pose: &HeadPose,
    strips: usize,
    members: &[usize],
    stations: &[usize],
) -> Vec<(DVec3, f64)> {
    let count = members.len().max(1) as f64;
    let last = pose.x.len() / strips - 1;
    let at = |station: usize, strip: usize| {
        let i = station * strips + strip;
        let [x, y, z] = [&pose.x, &pose.y, &pose.z].map(|plane| f64::from(plane[i]));
        DVec3::new(x, y, z)
    };
    let points = |station: usize| members.iter().map(move |strip| at(station, *strip));
    let middle = |station: usize| points(station).sum::<DVec3>() / count;
    stations
        .iter()
        .map(|&station| {
            let own = middle(station);
            let way = middle((station + 1).min(last)) - middle(station.saturating_sub(1));
            let ahead = way.truncate().normalize_or(DVec2::X);
            let off = |p: DVec3| (p - own).truncate().perp_dot(ahead);
            let square = points(station).map(|p| off(p) * off(p)).sum::<f64>() / count;
            // An even disc of radius R has the variance R²/4 along each axis.
            (own, 2.0 * square.sqrt())
        })
        .collect()
}

/// The shadow of discs under a lamp in the direction `toward`.
#[must_use]
pub fn shadow(discs: &[(DVec3, f64)], toward: [f32; 3]) -> Vec<Shade> {
    let [x, y, z] = toward.map(f64::from);
    let run = DVec2::new(x, y) / z;
    discs
        .iter()
        .map(|(at, radius)| {
            let height = at.z.max(0.0);
            let touch = TOUCH * NEAR_M / (NEAR_M + height);
            Shade {
                at: at.truncate() - run * height,
                radius: *radius,
                softness: LAMP_SIZE * height,
                darkness: SHADOW * FAR_M / (FAR_M + height) + touch,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::shortest_arc;

    use super::*;

    const TOWARD: [f32; 3] = [-0.5, 0.5, std::f32::consts::FRAC_1_SQRT_2];

    fn tilted() -> Rigid {
        Rigid {
            rotation: shortest_arc(DVec3::Z, DVec3::new(0.3, -0.2, 1.0).normalize()),
            translation: DVec3::new(0.1, 0.1, 0.02),
        }
    }

    #[test]
    fn the_handle_goes_straight_up_the_brush_and_tapers() {
        let brush = tilted();
        let sections = sections(&brush, 0.01, 0.0041);
        let axis = brush.vector(DVec3::Z);
        let mut last = -1.0;
        for section in &sections {
            let off = section.at - brush.translation;
            assert!(off.cross(axis).length() < 1e-12, "{section:?}");
            assert!(off.dot(axis) > last, "in order from the head");
            last = off.dot(axis);
        }
        let end = sections.last().expect("some");
        assert!(end.radius < 0.5 * sections[0].radius && end.material == Material::Wood);
        assert_eq!(sections[0].material, Material::Metal);
    }

    #[test]
    fn a_shadow_falls_away_from_the_lamp_wider_softer_and_fainter_with_height() {
        let disc = |z: f64| (DVec3::new(0.0, 0.0, z), 1e-3);
        let falls = |toward: [f32; 3]| {
            let shades = shadow(&[disc(0.0), disc(0.01), disc(0.02)], toward);
            let away = |i: usize| {
                shades[i].at.x > shades[i - 1].at.x && shades[i].at.y < shades[i - 1].at.y
            };
            let softer = |i: usize| shades[i].softness > shades[i - 1].softness;
            let fainter = |i: usize| shades[i].darkness < shades[i - 1].darkness;
            (1..3).all(|i| away(i) && softer(i) && fainter(i))
        };
        assert!(falls(TOWARD));
        assert!(!falls([0.5, 0.5, TOWARD[2]]), "a fault would pass");
        let touching = shadow(&[disc(0.0)], TOWARD)[0];
        assert_eq!((touching.at, touching.softness), (DVec2::ZERO, 0.0));
        let at = |toward: [f32; 3]| shadow(&[disc(0.01)], toward)[0].at;
        let mirrored = at([0.5, 0.5, TOWARD[2]]);
        assert!((mirrored - at(TOWARD) * DVec2::new(-1.0, 1.0)).length() < 1e-12);
    }

    #[test]
    fn discs_are_as_wide_as_the_head() {
        let (strips, radius) = (400, 3e-3f32);
        let ring = |i: usize| radius * ((i as f32 + 0.5) / strips as f32).sqrt();
        let turn = |i: usize| f64::from(i as u32) * 2.399_963;
        let place = |f: fn(f64) -> f64| (0..strips).map(move |i| ring(i) * f(turn(i)) as f32);
        let pose = HeadPose {
            x: place(maulstick_num::cos).map(|x| x + 0.1).collect(),
            y: place(maulstick_num::sin).collect(),
            z: vec![0.02; strips],
            ..HeadPose::default()
        };
        let [(middle, found)] = head_discs(&pose, &vec![[0.0; 2]; strips], false)[..] else {
            panic!("one station")
        };
        assert!(
            (middle - DVec3::new(0.1, 0.0, 0.02)).length() < 1e-4,
            "{middle}"
        );
        assert!((found / f64::from(radius) - 1.0).abs() < 0.02, "{found}");
    }

    #[test]
    fn a_wide_head_casts_the_shadow_of_its_width_and_thickness() {
        let file = BrushFile::library("flat").expect("flat");
        assert!(is_wide(&file) && !is_wide(&BrushFile::library("round").expect("round")));
        // Upright, 20 mm wide and 2 mm thick.
        let strips = 300;
        let root = |i: usize| [2.0 * (i as f32 + 0.5) / strips as f32 - 1.0, 0.0];
        let roots: Vec<[f32; 2]> = (0..strips).map(root).collect();
        let place = |i: usize| 0.01 * roots[i % strips][0];
        let pose = HeadPose {
            x: (0..strips * STATIONS).map(place).collect(),
            y: (0..strips * STATIONS)
                .map(|i| 1e-3 * ((i % 2) as f32 * 2.0 - 1.0) * 0.577)
                .collect(),
            z: vec![0.02; strips * STATIONS],
            ..HeadPose::default()
        };
        let widest = |wide: bool| {
            let discs = head_discs(&pose, &roots, wide);
            assert!(discs.len() <= HEAD_DISCS);
            discs.iter().map(|(_, radius)| *radius).fold(0.0, f64::max)
        };
        assert!(
            widest(true) < 0.5 * widest(false).max(0.009),
            "{}",
            widest(true)
        );
    }
}
