use maulstick_num::{atan2, cos, powf, sin};
use proptest::prelude::*;

use super::*;
use crate::colour::{RgbSpace, apply, delta_e_2000, lab};
use crate::{PaintLibrary, Studio};

fn soft(space: RgbSpace) -> Gamut {
    Gamut::new(GamutMapping::Soft, &space.from_working())
}

fn clamp(space: RgbSpace) -> Gamut {
    Gamut::new(GamutMapping::Clamp, &space.from_working())
}

/// Oklab of a colour of the working space, in double precision.
fn oklab(working: [f64; 3]) -> [f64; 3] {
    let root = |v: f64| powf(v.abs(), 1.0 / 3.0).copysign(v);
    apply(&LAB, apply(&CONES, working).map(root))
}

/// The colour of the working space of an Oklab.
fn working([l, a, b]: [f64; 3]) -> [f64; 3] {
    let cones = apply(&inverse(&LAB), [l, a, b]).map(|v| v * v * v);
    apply(&inverse(&CONES), cones)
}

/// A mapped colour, back in the working space.
fn shown(gamut: &Gamut, space: RgbSpace, colour: [f64; 3]) -> [f64; 3] {
    let mapped = gamut.map(colour.map(|v| v as f32)).map(f64::from);
    apply(&inverse(&space.from_working()), mapped)
}

/// Degrees from one hue to another.
fn hue_error(one: [f64; 3], two: [f64; 3]) -> f64 {
    let [one, two] = [one, two].map(|lab| atan2(lab[2], lab[1]).to_degrees());
    let off = (one - two).rem_euclid(360.0);
    off.min(360.0 - off)
}

fn chroma(lab: [f64; 3]) -> f64 {
    (lab[1] * lab[1] + lab[2] * lab[2]).sqrt()
}

#[test]
fn oklab_has_its_published_values_and_the_cube_root_its_bound() {
    // https://bottosson.github.io/posts/oklab/: XYZ (1, 0, 0) and (0, 1, 0) have these Lab.
    let to_srgb = inverse(&RgbSpace::Srgb.to_xyz());
    for (xyz, published) in [
        ([1.0, 0.0, 0.0], [0.450, 1.236, -0.019]),
        ([0.0, 1.0, 0.0], [0.922, -0.671, 0.263]),
        ([0.0, 0.0, 1.0], [0.153, -1.415, -0.449]),
    ] {
        let got = oklab(apply(&to_srgb, xyz));
        let off = (0..3)
            .map(|i| (got[i] - published[i]).abs())
            .fold(0.0, f64::max);
        println!("{got:.3?} expected {published:?}");
        assert!(off < 1e-3, "{got:?}");
    }
    let mut worst = 0.0f64;
    for i in 0..200_000 {
        let x = f64::from(i) * 1e-5 - 1.0 + 1e-7;
        let exact = powf(x.abs(), 1.0 / 3.0).copysign(x);
        worst = worst.max((f64::from(cube_root(x as f32)) / exact - 1.0).abs());
    }
    println!("cube root: {worst:.1e}");
    assert!(worst < 1e-6, "{worst}");
    assert_eq!(
        (cube_root(0.0), cube_root(-8.0), cube_root(27.0)),
        (0.0, -2.0, 3.0)
    );
}

/// Opaque layers and thick films of every paint, and of mixtures of neighbours, under a strong lamp too.
fn paint_colours() -> Vec<[f64; 3]> {
    let library = PaintLibrary::measured().expect("whole");
    let mut studio = Studio::daylight();
    let white = vec![0.95; studio.wavelengths()];
    let slots: Vec<_> = library
        .paints()
        .iter()
        .map(|paint| studio.add(paint))
        .collect();
    let mut colours = Vec::new();
    for (i, slot) in slots.iter().enumerate() {
        let next = slots[(i + 1) % slots.len()];
        for thickness in [2e-5, 1e-4, 1e-2] {
            colours.push(studio.colour(&[(*slot, thickness)], &white));
            colours
                .push(studio.colour(&[(*slot, 0.5 * thickness), (next, 0.5 * thickness)], &white));
        }
    }
    let brighter: Vec<_> = colours
        .iter()
        .map(|colour| colour.map(|v| 1.3 * v))
        .collect();
    colours.extend(brighter);
    colours
}

#[test]
fn soft_mapping_keeps_hues_that_the_clamp_turns() {
    let space = RgbSpace::Srgb;
    let white = apply(&space.to_xyz(), [1.0; 3]);
    let outside = |colour: &[f64; 3]| colour.iter().any(|v| !(0.0..=1.0).contains(v));
    let colours: Vec<_> = paint_colours().into_iter().filter(outside).collect();
    assert!(colours.len() > 20, "{}", colours.len());
    let judge = |gamut: Gamut| {
        let mut sum = [0.0; 2];
        let mut worst = 0.0f64;
        for colour in &colours {
            let mapped = shown(&gamut, space, *colour);
            let cie = |rgb: [f64; 3]| lab(apply(&space.to_xyz(), rgb), white);
            let turned = hue_error(oklab(mapped), oklab(*colour));
            sum[0] += delta_e_2000(cie(mapped), cie(*colour));
            sum[1] += turned;
            worst = worst.max(turned);
        }
        (sum.map(|v| v / colours.len() as f64), worst)
    };
    let (soft, clamp) = (judge(soft(space)), judge(clamp(space)));
    for (name, ([delta_e, hue], worst)) in [("soft", soft), ("clamp", clamp)] {
        let count = colours.len();
        println!(
            "{name:5} of {count} colours: mean ΔE00 {delta_e:.2}, mean hue error {hue:.2}°, worst {worst:.2}°"
        );
    }
    assert!(soft.1 < 0.5, "{}", soft.1);
    assert!(clamp.1 > 0.5, "a fault would pass");
}

#[test]
fn a_ramp_of_chroma_rises_without_a_jump() {
    let ramps = |gamut: &Gamut, space: RgbSpace| {
        let (mut jump, mut falls) = (0.0f64, 0.0f64);
        for hue in 0..36 {
            for lightness in [0.2, 0.45, 0.6, 0.8, 0.95, 0.999] {
                let (s, c) = (sin(f64::from(hue) * 0.1745), cos(f64::from(hue) * 0.1745));
                let colour = |i: u32| {
                    let chroma = f64::from(i) * 5e-4;
                    working([lightness, chroma * c, chroma * s])
                };
                let at = |colour| oklab(shown(gamut, space, colour));
                let mut last = at(colour(0));
                // No light makes a cone respond less than not at all.
                let seen = |colour: &[f64; 3]| apply(&CONES, *colour).iter().all(|v| *v > 1e-3);
                for colour in (1..800).map(colour).take_while(seen) {
                    let next = at(colour);
                    let step = (0..3)
                        .map(|k| (next[k] - last[k]).abs())
                        .fold(0.0, f64::max);
                    jump = jump.max(step);
                    falls = falls.max(chroma(last) - chroma(next));
                    last = next;
                }
            }
        }
        (jump, falls)
    };
    for space in [RgbSpace::Srgb, RgbSpace::DisplayP3] {
        let (jump, falls) = ramps(&soft(space), space);
        println!("greatest step {jump:.1e} for steps of 5e-4, greatest fall {falls:.1e}");
        assert!(jump < 1.5e-3 && falls < 2e-4, "{jump} {falls}");
    }
    let (jump, _) = ramps(&clamp(RgbSpace::Srgb), RgbSpace::Srgb);
    assert!(jump > 1.5e-3, "a fault would pass: {jump}");
}

#[test]
fn a_ramp_of_light_goes_to_white_without_a_jump() {
    let gamut = soft(RgbSpace::Srgb);
    for colour in [
        [0.8, 0.1, 0.05],
        [0.1, 0.2, 0.9],
        [0.9, 0.8, 0.02],
        [0.9, 0.88, 0.85],
    ] {
        let at = |i: u32| {
            let strength = f64::from(i) * 2e-3;
            oklab(shown(&gamut, RgbSpace::Srgb, colour.map(|v| v * strength)))
        };
        let mut last = at(100);
        for i in 101..4000 {
            let next = at(i);
            let step = (0..3)
                .map(|k| (next[k] - last[k]).abs())
                .fold(0.0, f64::max);
            assert!(step < 5e-3, "{colour:?} {i} {step}");
            assert!(next[0] > last[0] - 2e-5, "lightness falls: {colour:?} {i}");
            last = next;
        }
        let far = gamut.map(colour.map(|v| v as f32 * 1e4));
        assert!(far.iter().all(|v| *v > 0.75), "{far:?}");
    }
}

#[test]
fn greys_stay_and_nonsense_is_black() {
    for space in [RgbSpace::Srgb, RgbSpace::DisplayP3] {
        let gamut = soft(space);
        for i in 0..=1000u16 {
            let grey = f32::from(i) / 1000.0;
            let mapped = gamut.map([grey; 3]);
            assert!(
                mapped.iter().all(|v| (v - grey).abs() < 1e-4),
                "{grey} {mapped:?}"
            );
        }
        assert!(gamut.map([1.5; 3]).iter().all(|v| *v > 1.0 - 1e-4));
        for none in [[-0.1, -0.2, 0.0], [f32::NAN; 3], [f32::INFINITY, 0.0, 0.0]] {
            assert_eq!(gamut.map(none), [0.0; 3], "{none:?}");
        }
    }
}

#[test]
fn the_clamp_keeps_what_is_inside_and_leads_the_rest_to_the_edge() {
    assert_eq!(clamp_chromaticity([0.2, 0.5, 1.7]), [0.2, 0.5, 1.7]);
    assert_eq!(clamp_chromaticity([-0.2, 0.1, 0.05]), [0.0; 3]);
    let clamped = clamp_chromaticity([-0.1, 0.5, 0.3]);
    assert_eq!(clamped[0], 0.0);
    assert!((clamped.iter().sum::<f32>() - 0.7).abs() < 1e-6);
    assert!(
        clamped[1] > clamped[2],
        "the order of channels, and with it the hue, holds"
    );
}

proptest! {
    #[test]
    fn every_colour_comes_inside_and_keeps_its_hue(
        rgb in prop::array::uniform3(-0.3f64..2.0),
        wide in any::<bool>(),
    ) {
        let space = if wide { RgbSpace::DisplayP3 } else { RgbSpace::Srgb };
        let mapped = soft(space).map(rgb.map(|v| v as f32));
        prop_assert!(mapped.iter().all(|v| (0.0..=1.0).contains(v)), "{mapped:?}");
        let clamped = clamp(space).map(rgb.map(|v| v as f32));
        prop_assert!(clamped.iter().all(|v| (0.0..=1.0).contains(v)), "{clamped:?}");
        let (from, to) = (oklab(rgb), oklab(shown(&soft(space), space, rgb)));
        // Near grey rounding decides the hue; far outside of visible colours there is none.
        if chroma(to) > 0.02 && rgb.iter().all(|v| *v > -0.1) {
            prop_assert!(hue_error(from, to) < 0.5, "{from:?} {to:?}");
            prop_assert!(hue_error(from, [to[0], to[1] - 0.1 * to[2], to[2] + 0.1 * to[1]]) > 0.5);
        }
    }

    #[test]
    fn what_is_inside_the_knee_is_not_touched(
        lightness in 0.05f64..0.98,
        hue in 0.0f64..std::f64::consts::TAU,
        chroma in 0.0f64..0.3,
    ) {
        let away = (lightness - 0.5).abs();
        let e = 0.5 + away + f64::from(FOR_COLOUR) * chroma;
        let grey = 0.5 + 0.5 * (lightness - 0.5).signum() * (e - (e * e - 2.0 * away).sqrt());
        let at = |share: f64| {
            let c = chroma * share;
            working([grey + share * (lightness - grey), c * cos(hue), c * sin(hue)])
        };
        let farther = at(1.0 / 0.79);
        prop_assume!(farther.iter().all(|v| (1e-4..0.9999).contains(v)));
        let colour = at(1.0).map(|v| v as f32);
        prop_assert_eq!(soft(RgbSpace::Srgb).map(colour), colour);
    }
}
