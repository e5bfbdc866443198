//! Shape of a brush over a surface: ferrule and handle as elliptical sections, and its shadow discs.
//!
//! Lengths are desk lengths in the frame of the surface below, m; z is the height above it.

use glam::{DVec2, DVec3};
use maulstick_brush::head::STATIONS;
use maulstick_brush::{BrushFile, HeadPose};
use maulstick_num::geometry::Rigid;
use maulstick_num::sin_cos;

/// Length of the handle, m.
const HANDLE_M: f64 = 0.15;
/// Length of the ferrule by the width of the head.
const FERRULE: f64 = 2.3;
/// Radius of the handle where the ferrule ends, by its thickest part's diameter.
const JOINT: f64 = 0.36;
/// Half the angle under which the lamp and the others are seen, as a slope: by it a shadow blurs with
/// height.
const LAMP_SIZE: f64 = 0.09;
const OTHER_SIZE: f64 = 0.14;
/// Softness of a shadow by the radius of what casts it, for a tuft lets light through at its edge.
const LOOSE: f64 = 0.32;
/// Darkness of a shadow, and its increase under contact.
const SHADOW: f64 = 0.3;
const TOUCH: f64 = 0.14;
/// Darkness of the others' shadows by that of the lamp's.
const OTHER: f64 = 0.4;
/// Direction of the other lights: around the desk from the lamp, rad, and the steepness of their light, as z of the
/// unit vector toward them.
const AROUND: f64 = 2.0;
const OTHER_Z: f64 = 0.75;
/// Lowest assumed height of a lamp beside the desk.
const LOWEST_Z: f64 = 0.2;
/// Height at which the darkness of touching has halved, m.
const NEAR_M: f64 = 1.5e-3;
/// Height at which a shadow has faded to half, m.
const FAR_M: f64 = 0.12;

/// Material of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Material {
    Metal,
    /// A groove of the ferrule, which crimps it to the handle.
    Groove,
    Wood,
}

/// An elliptical cross-section of a brush, and the part that begins there toward the handle's end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Section {
    /// Its middle.
    pub at: DVec3,
    /// Its half axes, along x and y of the brush, m.
    pub half: [DVec3; 2],
    /// The material that begins here.
    pub material: Material,
}

/// A disc of shadow on the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shade {
    /// Its middle on the surface.
    pub at: DVec2,
    /// m.
    pub radius: f64,
    /// Half the width of its soft edge, m.
    pub softness: f64,
    /// 0 to 1.
    pub darkness: f64,
}

/// The ferrule: place along it, how far it has become round and as wide as the handle there, its size
/// by that, and what begins there. Two grooves crimp it.
const METAL: [(f64, f64, f64, Material); 12] = {
    use Material::{Groove, Metal};
    [
        (0.0, 0.0, 1.0, Metal),
        (0.08, 0.0, 1.02, Metal),
        (0.2, 0.12, 1.0, Metal),
        (0.32, 0.42, 1.0, Metal),
        (0.45, 0.8, 1.0, Metal),
        (0.58, 1.0, 1.0, Metal),
        (0.66, 1.0, 1.0, Groove),
        (0.685, 1.0, 0.93, Groove),
        (0.71, 1.0, 1.0, Metal),
        (0.8, 1.0, 1.0, Groove),
        (0.825, 1.0, 0.93, Groove),
        (0.85, 1.0, 1.0, Metal),
    ]
};
/// The handle: place along it and radius by the diameter of its thickest part.
const WOOD: [(f64, f64); 13] = [
    (0.0, JOINT),
    (0.04, 0.43),
    (0.09, 0.48),
    (0.14, 0.5),
    (0.22, 0.475),
    (0.32, 0.42),
    (0.48, 0.335),
    (0.65, 0.27),
    (0.83, 0.22),
    (1.0, 0.19),
    (1.015, 0.165),
    (1.024, 0.11),
    (1.028, 0.0),
];
/// Those sections whose shadow is cast.
const SHADED: [usize; SHADED_SECTIONS] = [0, 5, 15, 19, 21];
/// Discs of ferrule and handle.
pub(crate) const SHADED_SECTIONS: usize = 5;

/// Ferrule and handle of a brush with this file at `brush` (brush frame to surface frame), from the
/// head upward.
#[must_use]
pub(crate) fn sections(brush: &Rigid, file: &BrushFile) -> Vec<Section> {
    let width = handle_width_m(file);
    let wide = file.radius_m(0.0);
    // Sheet metal around a thin head has a thickness of its own.
    let thick = file.half_thickness_m(0.0).max(0.15 * wide);
    let (wide, thick) = (wide.max(0.15 * thick) * 1.04, thick * 1.06);
    let section = |z: f64, [a, b]: [f64; 2], material: Material| Section {
        at: brush.point(DVec3::new(0.0, 0.0, z)),
        half: [brush.vector(DVec3::X) * a, brush.vector(DVec3::Y) * b],
        material,
    };
    let metal = METAL.map(|(place, round, size, material)| {
        let half = [wide, thick].map(|own| size * (own + (JOINT * width - own) * round));
        section(place * FERRULE * width, half, material)
    });
    let wood = WOOD.map(|(place, radius)| {
        let z = FERRULE * width + place * HANDLE_M;
        section(z, [radius * width; 2], Material::Wood)
    });
    metal.into_iter().chain(wood).collect()
}

/// Width by thickness from which a head casts its shadow in three parts.
const WIDE: f64 = 1.8;
/// Discs of a narrow head.
pub(crate) const HEAD_DISCS: usize = 5;
/// Discs of a wide head.
pub(crate) const HEAD_DISCS_WIDE: usize = 12;
/// Stations of a narrow head's discs, from the point.
const OF_ALL: [usize; HEAD_DISCS] = [STATIONS - 1, 6, 4, 2, 0];
/// Width of a part's discs over its own, so that no light falls between two.
const JOINED: f64 = 1.25;
/// Stations of such a part.
const OF_A_PART: [usize; 4] = [0, 3, 6, STATIONS - 1];

/// Width of the handle's thickest part for the head of a brush file, m: a fan spreads beyond its
/// ferrule.
#[must_use]
pub(crate) fn handle_width_m(file: &BrushFile) -> f64 {
    let root = file.radius_m(0.0).max(file.half_thickness_m(0.0));
    (1e-3 * file.head.width_mm).min(3.0 * root)
}

/// Discs that cover a head, in a chain that ends at the ferrule: the middle of the strips at each station and their
/// radius across their direction along the surface. A wide head is three such chains, joined.
#[must_use]
pub(crate) fn head_discs(pose: &HeadPose, roots: &[[f32; 2]], wide: bool) -> Vec<(DVec3, f64)> {
    let part = |from: f32, to: f32| -> Vec<usize> {
        let within = |strip: &usize| (from..to).contains(&roots[*strip][0]);
        (0..roots.len()).filter(within).collect()
    };
    let strips = roots.len().max(1);
    if !wide {
        return part_discs(pose, strips, &part(-2.0, 2.0), &OF_ALL);
    }
    let third = 1.0 / 3.0;
    let (down, mut up) = (OF_A_PART, OF_A_PART);
    up.reverse();
    let parts = [(-2.0, -third, up), (-third, third, down), (third, 2.0, up)];
    parts
        .into_iter()
        .flat_map(|(from, to, stations)| part_discs(pose, strips, &part(from, to), &stations))
        .map(|(at, radius)| (at, JOINED * radius))
        .collect()
}

/// True if the head of a brush file is wide.
#[must_use]
pub(crate) fn is_wide(file: &BrushFile) -> bool {
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

/// A light that casts a shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Caster {
    /// Unit vector toward it.
    pub toward: DVec3,
    /// Darkness of its shadows relative to the lamp's.
    pub strength: f64,
    /// Apparent size, as a slope.
    pub size: f64,
}

/// The lamp and those around it: where the shadow of one falls outside of the view or on what does not
/// show it, another's is seen (Baxter 2004, § 8.4.5).
#[must_use]
pub(crate) fn casters(toward: DVec3) -> [Caster; 3] {
    let lamp = Caster {
        toward: DVec3::new(toward.x, toward.y, toward.z.max(LOWEST_Z)).normalize_or(DVec3::Z),
        strength: 1.0,
        size: LAMP_SIZE,
    };
    let run = (1.0 - OTHER_Z * OTHER_Z).sqrt();
    let beside = |turn: f64| {
        let (sin, cos) = sin_cos(turn);
        let ahead = toward.truncate().normalize_or(DVec2::new(-1.0, 0.0));
        Caster {
            toward: (DVec2::new(cos, sin).rotate(ahead) * run).extend(OTHER_Z),
            strength: OTHER,
            size: OTHER_SIZE,
        }
    };
    [lamp, beside(AROUND), beside(-AROUND)]
}

/// The discs of ferrule and handle whose shadow is cast along `run`, the distance that it covers per metre of height.
pub(crate) fn shaded_sections(
    sections: &[Section],
    run: DVec2,
) -> impl Iterator<Item = (DVec3, f64)> {
    let fallen = move |at: DVec3| at.truncate() - run * at.z;
    let ends = [sections.first(), sections.last()].map(|end| end.map_or(DVec3::ZERO, |s| s.at));
    let across = (fallen(ends[1]) - fallen(ends[0]))
        .perp()
        .normalize_or(DVec2::X);
    SHADED
        .iter()
        .filter_map(|i| sections.get(*i))
        .map(move |section| {
            let [x, y] = section.half.map(|half| fallen(half).dot(across));
            (section.at, (x * x + y * y).sqrt())
        })
}

/// The shadow of discs under a light.
#[must_use]
pub(crate) fn shadow(discs: &[(DVec3, f64)], caster: &Caster) -> Vec<Shade> {
    let run = caster.run();
    discs
        .iter()
        .map(|(at, radius)| {
            let height = at.z.max(0.0);
            let touch = TOUCH * NEAR_M / (NEAR_M + height);
            Shade {
                at: at.truncate() - run * height,
                radius: *radius,
                softness: caster.size * height + LOOSE * radius,
                darkness: caster.strength * (SHADOW * FAR_M / (FAR_M + height) + touch),
            }
        })
        .collect()
}

impl Caster {
    /// Distance that its light covers along the surface per metre of height.
    #[must_use]
    pub(crate) fn run(&self) -> DVec2 {
        self.toward.truncate() / self.toward.z.max(LOWEST_Z)
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::shortest_arc;

    use super::*;

    const TOWARD: DVec3 = DVec3::new(-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2);

    fn tilted() -> Rigid {
        Rigid {
            rotation: shortest_arc(DVec3::Z, DVec3::new(0.3, -0.2, 1.0).normalize()),
            translation: DVec3::new(0.1, 0.1, 0.02),
        }
    }

    #[test]
    fn the_handle_goes_straight_up_the_brush_and_tapers_to_a_point() {
        let (brush, file) = (tilted(), BrushFile::library("flat").expect("flat"));
        let sections = sections(&brush, &file);
        let axis = brush.vector(DVec3::Z);
        let mut last = -1.0;
        for section in &sections {
            let off = section.at - brush.translation;
            assert!(off.cross(axis).length() < 1e-12, "{section:?}");
            assert!(off.dot(axis) > last, "in order from the head");
            last = off.dot(axis);
        }
        let end = sections.last().expect("some");
        assert!(end.half[0].length() < 1e-9 && end.material == Material::Wood);
        assert_eq!(sections[0].material, Material::Metal);
        assert!(SHADED.iter().all(|i| *i < sections.len()));
    }

    #[test]
    fn a_flat_brush_has_a_flat_ferrule_that_gets_round_at_the_handle() {
        let shape = |kind: &str| {
            let file = BrushFile::library(kind).expect(kind);
            sections(&Rigid::IDENTITY, &file)
                .iter()
                .map(|s| s.half[0].length() / s.half[1].length().max(1e-9))
                .collect::<Vec<_>>()
        };
        let (flat, round) = (shape("flat"), shape("round"));
        assert!(flat[0] > 3.0, "{}", flat[0]);
        assert!((flat[5] - 1.0).abs() < 1e-9, "{flat:?}");
        assert!(
            round.iter().take(24).all(|s| (s - 1.0).abs() < 0.05),
            "a fault would pass"
        );
    }

    #[test]
    fn a_shadow_falls_away_from_the_lamp_wider_softer_and_fainter_with_height() {
        let disc = |z: f64| (DVec3::new(0.0, 0.0, z), 1e-3);
        let falls = |toward: DVec3| {
            let lamp = casters(toward)[0];
            let shades = shadow(&[disc(0.0), disc(0.01), disc(0.02)], &lamp);
            let away = |i: usize| {
                shades[i].at.x > shades[i - 1].at.x && shades[i].at.y < shades[i - 1].at.y
            };
            let softer = |i: usize| shades[i].softness > shades[i - 1].softness;
            let fainter = |i: usize| shades[i].darkness < shades[i - 1].darkness;
            (1..3).all(|i| away(i) && softer(i) && fainter(i))
        };
        assert!(falls(TOWARD));
        assert!(!falls(DVec3::new(0.5, 0.5, TOWARD.z)), "a fault would pass");
        let touching = shadow(&[disc(0.0)], &casters(TOWARD)[0])[0];
        assert_eq!(
            (touching.at, touching.softness),
            (DVec2::ZERO, LOOSE * 1e-3)
        );
    }

    #[test]
    fn the_other_lights_stand_around_the_desk_and_cast_fainter_softer_shadows() {
        let [lamp, one, two] = casters(TOWARD);
        let at = |caster: &Caster| shadow(&[(DVec3::new(0.0, 0.0, 0.01), 1e-3)], caster)[0];
        let (own, first, second) = (at(&lamp), at(&one), at(&two));
        for other in [first, second] {
            assert!(other.darkness < 0.5 * own.darkness && other.softness > own.softness);
            assert!(
                other.at.dot(own.at) < 0.0,
                "{other:?}: to the other side of the brush"
            );
        }
        let mirrored = own.at.normalize();
        let off = first.at - 2.0 * first.at.dot(mirrored) * mirrored;
        assert!((second.at + off).length() < 1e-9, "on either side");
        // Straight below a lamp at the zenith there are still two more.
        let above = casters(DVec3::Z);
        assert!(at(&above[0]).at.length() < 1e-12 && at(&above[1]).at.length() > 5e-3);
    }

    #[test]
    fn discs_are_as_wide_as_the_head() {
        let (strips, radius) = (400, 3e-3f32);
        let ring = |i: usize| radius * (((i % strips) as f32 + 0.5) / strips as f32).sqrt();
        let turn = |i: usize| f64::from((i % strips) as u32) * 2.399_963;
        let all = strips * STATIONS;
        let place = |f: fn(f64) -> f64| (0..all).map(move |i| ring(i) * f(turn(i)) as f32);
        let pose = HeadPose {
            x: place(maulstick_num::cos).map(|x| x + 0.1).collect(),
            y: place(maulstick_num::sin).collect(),
            z: vec![0.02; all],
            ..HeadPose::default()
        };
        let discs = head_discs(&pose, &vec![[0.0; 2]; strips], false);
        assert_eq!(discs.len(), HEAD_DISCS);
        let (middle, found) = discs[2];
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
            let expected = if wide { HEAD_DISCS_WIDE } else { HEAD_DISCS };
            assert_eq!(discs.len(), expected);
            discs.iter().map(|(_, radius)| *radius).fold(0.0, f64::max)
        };
        assert!(
            widest(true) < 0.5 * widest(false).max(0.009),
            "{}",
            widest(true)
        );
    }
}
