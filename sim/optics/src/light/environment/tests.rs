use super::*;
use crate::light::{Facet, Lamp, LampSetup, SURFACE, Spot, lit};

/// Surroundings that are black but for a lamp of this half-angle, rad, straight before the picture.
fn behind_the_viewer(half: f64) -> EnvironmentMap {
    let least = maulstick_num::cos(half);
    let map = EnvironmentMap::of(|[_, _, z]| [f64::from(u8::from(z > least)); 3]);
    map.expect("a lamp")
}

fn over_texels(map: &EnvironmentMap, level: usize) -> f64 {
    let texel = 2.0 / (side(level) - 1) as f64;
    let sum: f64 = map.level(level).iter().map(|t| f64::from(t[1])).sum();
    sum * texel * texel
}

#[test]
fn white_surroundings_are_the_same_at_any_slope_and_roughness() {
    let farthest = |map: &EnvironmentMap| {
        let slopes = [[0.0; 2], [0.3, -0.2], [-0.9, 0.1], [0.0, 7.0], [1e4, 1e4]];
        let all = slopes.iter().flat_map(|slope| {
            [0.05, 0.1, 0.17, 0.3, 0.55, 0.8, 2.0].map(|rough| map.mirrored(*slope, rough))
        });
        all.flatten().map(|v| (v - 1.0).abs()).fold(0.0, f32::max)
    };
    let white = EnvironmentMap::of(|_| [3.0; 3]).expect("white");
    assert!(farthest(&white) < 1e-5, "{}", farthest(&white));
    let tilted = EnvironmentMap::of(|[x, _, _]| [3.0 + 0.1 * x; 3]).expect("almost white");
    assert!(farthest(&tilted) > 1e-3, "a fault would pass");
}

#[test]
fn a_point_of_light_is_as_broad_as_the_paint_is_rough() {
    // GGX's density falls to a quarter where the slope is its roughness (Walter et al. 2007, eq. 33, by slopes).
    let map = behind_the_viewer(0.05);
    let share = |slope: f32, rough: f32| {
        let at = |slope: f32| map.mirrored([0.6 * slope, 0.8 * slope], rough)[1];
        at(slope) / at(0.0)
    };
    for rough in [0.1f32, 0.2, 0.4, 0.8] {
        let (got, fault) = (share(rough, rough), share(rough, 2.0 * rough));
        println!("roughness {rough}: {got:.3}, twice as rough {fault:.3}");
        assert!((got / 0.25 - 1.0).abs() < 0.15, "{got}");
        assert!(rough > 0.5 || (fault / 0.25 - 1.0).abs() > 0.5, "{fault}");
    }
    // Between two levels it is between both.
    let peaks = [0.2f32, 0.3, 0.4].map(|rough| map.mirrored([0.0; 2], rough)[1]);
    assert!(peaks.is_sorted_by(|a, b| a > b), "{peaks:?}");
}

#[test]
fn no_light_is_lost_or_gained_by_roughness() {
    let map = behind_the_viewer(0.05);
    let all = [0, 1].map(|level| over_texels(&map, level));
    // Of the lobes 1/(1 + 1/α²) lies beyond the horizon: 1 and 4 %.
    let expected = [0.99, 0.96].map(|share| share / 0.99 * all[0]);
    println!("{all:.4?} of {expected:.4?}");
    assert!((all[1] / expected[1] - 1.0).abs() < 0.02, "{all:?}");
    // Its share of the plane of slopes: π·tan²(half the angle) of a lamp whose own light is π·sin²θ of π.
    let (tangent, sine) = (0.05f64 / 2.0, 0.05f64);
    let own = 0.99 * std::f64::consts::PI * tangent * tangent / (sine * sine);
    assert!((all[0] / own - 1.0).abs() < 0.05, "{} {own}", all[0]);
}

#[test]
fn brighter_surroundings_are_the_same_map_and_black_ones_none() {
    let of =
        |strength: f64| EnvironmentMap::of(|[x, y, z]| [x + 1.0, y + 1.0, z].map(|v| strength * v));
    let (one, strong) = (of(1.0).expect("a map"), of(1e3).expect("a map"));
    let off = one
        .texels
        .iter()
        .flatten()
        .zip(strong.texels.iter().flatten());
    assert!(off.clone().all(|(a, b)| (a - b).abs() < 1e-4 * a.max(1e-2)));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(of(bad), None, "{bad}");
    }
}

#[test]
fn a_map_comes_back_from_its_bytes() {
    let map = EnvironmentMap::room();
    let bytes = map.to_bytes();
    assert_eq!(bytes.len(), 5936);
    let back = EnvironmentMap::from_bytes(&bytes).expect("its own bytes");
    assert_eq!(back.to_bytes(), bytes);
    let far = |other: &EnvironmentMap| {
        let pairs = map.texels.iter().zip(&other.texels);
        let off = pairs.flat_map(|(a, b)| {
            let most = a.iter().copied().fold(0.0, f32::max);
            [0, 1, 2].map(|i| (a[i] - b[i]).abs() / most)
        });
        off.fold(0.0, f32::max)
    };
    assert!(far(&back) <= 1.0 / 256.0, "{}", far(&back));
    let mut other = bytes.clone();
    other[0] ^= 4;
    assert!(far(&EnvironmentMap::from_bytes(&other).expect("whole")) > 1.0 / 256.0);
    assert_eq!(EnvironmentMap::from_bytes(&bytes[4..]), None);
    assert_eq!(EnvironmentMap::from_bytes(&[bytes, vec![0]].concat()), None);
    for (colour, of) in [([1.0f32, 0.5, 0.0], [128, 64, 0, 129]), ([0.0; 3], [0; 4])] {
        assert_eq!((rgbe::encode(&colour), rgbe::decode(&of)), (of, colour));
    }
    assert_eq!(rgbe::encode(&[f32::NAN, -1.0, 0.999_9]), [0, 0, 128, 129]);
}

#[test]
fn a_panorama_hangs_as_one_sees_it_from_the_picture() {
    let bright = |columns: std::ops::Range<usize>, rows: std::ops::Range<usize>| {
        let mut panorama = Panorama::new([1200, 600]).expect("twice as wide");
        for row in 0..600 {
            let at = |column| {
                if rows.contains(&row) && columns.contains(&column) {
                    1.0
                } else {
                    0.01
                }
            };
            let line: Vec<[f32; 3]> = (0..1200).map(|column| [at(column); 3]).collect();
            panorama.add(row, &line);
        }
        let map = panorama.map().expect("light");
        let of = |slope: [f32; 2]| map.mirrored(slope, 0.1)[0];
        [
            of([0.4, 0.0]),
            of([-0.4, 0.0]),
            of([0.0, 0.4]),
            of([0.0, -0.4]),
        ]
    };
    // A window at the right of one who looks out of the picture is at the left of it: what rises to the right shows it.
    let [left, right, ..] = bright(700..800, 200..400);
    assert!(left > 5.0 * right, "{left} {right}");
    let [.., floor, ceiling] = bright(500..700, 100..250);
    assert!(ceiling > 5.0 * floor, "{ceiling} {floor}");
    let behind = bright(0..200, 200..400);
    assert!(behind.iter().all(|v| (v - 1.0).abs() < 0.02), "{behind:?}");
    assert!(Panorama::new([1200, 601]).is_none() && Panorama::new([0, 0]).is_none());
}

/// Luminance of dark paint of this gloss and slope in a room.
fn shown(environment: Option<Arc<EnvironmentMap>>, gloss: f32, slope: [f32; 2]) -> f32 {
    let lamp = Lamp::new(&LampSetup {
        environment,
        ..LampSetup::default()
    });
    let facet = Facet {
        slope,
        ..Facet::LEVEL
    };
    let unlit = [0.01; 3];
    lit(
        &Spot {
            unlit,
            gloss,
            facet,
        },
        &lamp,
    )[1]
}

#[test]
fn gloss_deepens_what_is_level_and_mirrors_the_window_where_it_leans() {
    for room in [EnvironmentMap::room(), EnvironmentMap::window()] {
        let of = |gloss, slope| shown(Some(Arc::clone(&room)), gloss, slope);
        let [matt, glossy] = [0.0, 1.0].map(|gloss| of(gloss, [0.0; 2]));
        println!("level: matt {matt:.4}, glossy {glossy:.4}");
        assert!(glossy < 0.7 * matt, "{glossy} {matt}");
        let [matt, glossy] = [0.0, 1.0].map(|gloss| of(gloss, [0.5, 0.0]));
        println!("toward the window: matt {matt:.4}, glossy {glossy:.4}");
        assert!(glossy > 1.5 * matt, "{glossy} {matt}");
        let away = of(1.0, [-0.5, 0.0]);
        assert!(away < 0.6 * glossy, "{away} {glossy}");
    }
    let [matt, glossy] = [0.0, 1.0].map(|gloss| shown(None, gloss, [0.0; 2]));
    assert_eq!(
        [matt, glossy],
        [0.01 + SURFACE; 2],
        "even, it does not depend on gloss"
    );
}
