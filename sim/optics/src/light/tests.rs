use proptest::prelude::*;

use super::*;

const GREY: [f32; 3] = [0.2, 0.2, 0.2];

fn from(toward: [f64; 3]) -> Lamp {
    Lamp::new(&LampSetup {
        toward,
        ..Default::default()
    })
}

/// From the upper left, as on most desks.
fn upper_left() -> Lamp {
    from([-0.5, 0.5, 0.5f64.sqrt()])
}

fn spot(unlit: [f32; 3], gloss: f32, slope: [f32; 2]) -> Spot {
    Spot {
        unlit,
        gloss,
        facet: Facet {
            slope,
            ..Facet::LEVEL
        },
    }
}

/// Light on the two flanks of a ridge that runs up, left flank first.
fn ridge(light: impl Fn(&Spot, &Lamp) -> [f32; 3]) -> [f32; 2] {
    let heights: Vec<f32> = (0..9)
        .map(|x: i32| 1e-4 * (4 - (x - 4).abs()) as f32)
        .collect();
    let field = HeightField {
        heights: &heights,
        cells: [9, 1],
        cell_m: 2.5e-4,
    };
    [2, 6].map(|x| light(&spot(GREY, 1.0, field.slope(x, 0)), &upper_left())[0])
}

fn is_lit_from_the_left([left, right]: [f32; 2]) -> bool {
    left > 1.1 * GREY[0] && right < 0.9 * GREY[0]
}

#[test]
fn a_ridge_is_brighter_on_the_lamps_side_and_darker_on_the_other() {
    assert!(is_lit_from_the_left(ridge(lit)), "{:?}", ridge(lit));
    let turned = |spot: &Spot, lamp: &Lamp| {
        let mut turned = *spot;
        turned.facet.slope = turned.facet.slope.map(|rise| -rise);
        lit(&turned, lamp)
    };
    assert!(!is_lit_from_the_left(ridge(turned)), "a fault would pass");
}

/// The slope toward the upper left at which a black film of this gloss shines most, and how much.
fn best(gloss: f32, lamp: &Lamp) -> (f32, f32) {
    let shine = |slope: f32| lit(&spot([0.0; 3], gloss, [slope, -slope]), lamp)[0];
    let steps = (0..2000).map(|i| i as f32 * 1e-3 - 1.0);
    let best = steps
        .max_by(|a, b| shine(*a).total_cmp(&shine(*b)))
        .expect("one");
    (best, shine(best))
}

#[test]
fn gloss_shines_most_where_the_normal_halves_the_angle_to_the_lamp() {
    let lamp = upper_left();
    let (at, shine) = best(1.0, &lamp);
    assert!(
        (at - lamp.mirror[0]).abs() < 0.01,
        "{at} for {:?}",
        lamp.mirror
    );
    assert!(shine > 0.2 && shine < 1.0, "{shine}");
    let half = -lamp.toward[0] / (1.0 + lamp.toward[2]);
    assert!((lamp.mirror[0] - half).abs() < 1e-6 && lamp.mirror[0] == -lamp.mirror[1]);
    // An absorbent ground has next to none.
    let matte = lit(&spot([0.0; 3], 0.0, [at, -at]), &lamp)[0];
    assert!(matte < 0.06, "{matte}");
}

#[test]
fn a_dull_film_shines_less_and_more_broadly() {
    let lamp = upper_left();
    let width = |gloss: f32| {
        let (_, most) = best(gloss, &lamp);
        let half = (0..4000).filter(|i| {
            let slope = *i as f32 * 1e-3 - 2.0;
            lit(&spot([0.0; 3], gloss, [slope, -slope]), &lamp)[0] > 0.5 * most
        });
        (half.count(), most)
    };
    let films = [1.0, 0.75, 0.3, 0.1].map(width);
    println!("width and height of the highlight: {films:?}");
    assert!(films.is_sorted_by(|a, b| a.0 <= b.0 && a.1 > b.1));
}

#[test]
fn unresolved_bristle_marks_shine_broadly_too() {
    let lamp = upper_left();
    let shine = |spread: f32, slope: f32| {
        let mut spot = spot([0.0; 3], 0.75, [slope, -slope]);
        spot.facet.spread = [spread, 0.0, spread];
        lit(&spot, &lamp)[0]
    };
    let at = lamp.mirror[0];
    assert!(shine(0.05, at) < 0.5 * shine(0.0, at), "the glint is gone");
    assert!(
        shine(0.05, 0.1) > shine(0.0, 0.1),
        "and has gone into a sheen"
    );
}

#[test]
fn a_lower_lamp_shines_more_on_what_faces_it() {
    // Fresnel: at the half vector of a lamp 6° high light falls at 42°; straight above, at 0°.
    let low = from([-1.0, 0.0, 0.1]);
    let above = from([0.0, 0.0, 1.0]);
    let k1 = SurfaceCorrection::default().k1;
    let direct = f64::from(1.0 - AMBIENT);
    assert!((f64::from(above.peak) - direct * k1 / 4.0).abs() < 1e-8);
    // b_z² = (1 + l_z)/2.
    let bare = direct * k1 / (4.0 * 0.55 * 0.55 * 0.1);
    assert!(f64::from(low.peak) > 1.1 * bare, "{:?}", low.peak);
}

#[test]
fn a_hollow_is_lit_by_its_own_colour_and_no_shadow_is_black() {
    let deep = |unlit: [f32; 3]| {
        let mut spot = spot(unlit, 0.0, [0.0; 2]);
        (spot.facet.seen, spot.facet.open) = (0.0, 0.4);
        lit(&spot, &upper_left())
    };
    let [r, g, b] = deep([0.8, 0.2, 0.05]);
    println!("red hollow {r} {g} {b}");
    assert!(
        r / g > 1.3 * 0.8 / 0.2 && g > b,
        "more saturated than level paint"
    );
    let white = deep([0.9; 3])[0];
    assert!(white > 0.4 * 0.9, "{white}");
    // Under a light of another colour the albedo is the paint's.
    let warm = Lamp::new(&LampSetup {
        colour: [2.0, 1.0, 0.5],
        ..Default::default()
    });
    let mut spot = spot([1.0, 0.5, 0.25], 0.0, [0.0; 2]);
    spot.facet.open = 0.5;
    let [r, g, b] = lit(&spot, &warm);
    assert!((r - 2.0 * g).abs() < 1e-6 && (g - 2.0 * b).abs() < 1e-6);
}

#[test]
fn of_a_broad_lamp_the_upper_half_lights_what_turns_away() {
    // A facet whose plane goes through the middle of the lamp sees the half of its disc above: of the
    // half angle w, seen at the mean height 4w/(3π), so that its irradiance is ½·.42·w/l_z.
    let setup = LampSetup {
        toward: [-1.0, 0.0, 1.0],
        ..Default::default()
    };
    let broad = Lamp::new(&setup);
    let mut spot = spot([1.0; 3], 0.0, [-1.0, 0.0]);
    (spot.facet.seen, spot.facet.open) = (0.5, 1.0);
    let got = (lit(&spot, &broad)[0]
        - lit(
            &Spot {
                facet: Facet {
                    seen: 0.0,
                    ..spot.facet
                },
                ..spot
            },
            &broad,
        )[0])
        / (1.0 - AMBIENT);
    let expected = 0.5 * 0.3 * 4.0 / (3.0 * std::f32::consts::PI) / 0.5f32.sqrt();
    println!("{got:.3} expected {expected:.3}");
    assert!((got - expected).abs() < 0.02, "{got} {expected}");
}

#[test]
fn the_bare_ground_does_not_clip_at_the_start() {
    for (ground, intensity) in [
        ([0.9, 0.88, 0.8], 1.0),
        ([0.9, 0.95, 0.8], 3.0),
        ([1.2, 0.0, 0.0], 0.9),
    ] {
        let exposure = starting_exposure(ground, intensity);
        let brightest = ground.into_iter().fold(0.0, f64::max) * intensity * exposure;
        assert!(brightest <= BARE + 1e-12 && exposure <= 1.0);
        assert!(exposure == 1.0 || brightest > BARE - 1e-12, "the largest");
    }
    assert_eq!(starting_exposure([0.9; 3], 1.0), 1.0);
    assert_eq!(starting_exposure([0.0; 3], 1.0), 1.0);
    assert_eq!(starting_exposure([f64::NAN; 3], 1.0), 1.0);
}

#[test]
fn lamps_that_are_none_still_shine() {
    let above = from([0.0, 0.0, 1.0]);
    for toward in [[0.0; 3], [f64::NAN, 0.0, 1.0], [0.0, 0.0, -1.0]] {
        let none = LampSetup {
            toward,
            intensity: f64::NAN,
            exposure: f64::INFINITY,
            relief: f64::NAN,
            softness: f64::NAN,
            ..Default::default()
        };
        assert_eq!(Lamp::new(&none), above);
    }
    let low = Lamp::new(&LampSetup {
        toward: [1.0, 0.0, -1.0],
        intensity: -1.0,
        ..Default::default()
    });
    assert_eq!((low.toward[2], low.intensity), (LOWEST_LAMP as f32, 0.0));
    assert!((low.toward[0] * low.toward[0] + 0.01 - 1.0).abs() < 1e-6);
}

#[test]
fn exposure_and_relief_are_factors() {
    let one = upper_left();
    let other = Lamp::new(&LampSetup {
        toward: [-0.5, 0.5, 0.5f64.sqrt()],
        intensity: 0.5,
        exposure: 4.0,
        relief: 2.0,
        ..Default::default()
    });
    let steep = |factor: f32| {
        let heights: Vec<f32> = (0..9)
            .map(|i: i32| factor * 2e-5 * (i * i) as f32)
            .collect();
        let field = HeightField {
            heights: &heights,
            cells: [9, 1],
            cell_m: 2.5e-4,
        };
        let lamp = if factor == 1.0 { &other } else { &one };
        let mut facets = [Facet::LEVEL; 3];
        Surroundings::new(lamp, 2.5e-4).row(&field, [3, 0], &mut facets);
        facets.map(|facet| {
            lit(
                &Spot {
                    facet,
                    ..spot(GREY, 1.0, [0.0; 2])
                },
                lamp,
            )
        })
    };
    for (got, twice) in steep(1.0).iter().flatten().zip(steep(2.0).iter().flatten()) {
        assert!((got - 2.0 * twice).abs() < 1e-5, "{got} {twice}");
    }
}

proptest! {
    #[test]
    fn a_flat_surface_shows_its_colour_and_its_surface(
        unlit in prop::array::uniform3(-0.2f32..1.5),
        gloss in 0.0f32..=1.0,
        toward in prop::array::uniform3(-1.0..1.0f64),
    ) {
        let flat = unlit.map(|channel| channel + SURFACE);
            prop_assert_eq!(lit(&spot(unlit, gloss, [0.0; 2]), &from(toward)), flat);
        let above = from([0.0, 0.0, 1.0]);
        prop_assert!(lit(&spot(unlit, gloss, [0.1, 0.0]), &above) != flat);
    }

    #[test]
    fn mirrored_light_mirrors(
        slope in prop::array::uniform2(-3.0f32..3.0),
        toward in prop::array::uniform3(-1.0..1.0f64),
    ) {
        let [x, y, z] = toward;
        let one = lit(&spot(GREY, 0.6, slope), &from(toward));
        let other = lit(&spot(GREY, 0.6, [-slope[0], slope[1]]), &from([-x, y, z]));
        prop_assert_eq!(one, other);
    }

    #[test]
    fn no_slope_breaks_the_light(slope in prop::array::uniform2(-1e4f32..1e4)) {
        let out = lit(&spot(GREY, 1.0, slope), &upper_left());
        prop_assert!(out.iter().all(|v| v.is_finite() && *v >= AMBIENT * GREY[0] * 0.999));
    }

    #[test]
    fn what_sees_less_of_the_lamp_is_darker(
        slope in prop::array::uniform2(-1.0f32..1.0),
        seen in 0.0f32..0.9,
        open in 0.0f32..=1.0,
    ) {
        // Where the plane of the facet itself hides a part of the lamp, that part is not seen.
        let facing = normal(slope).iter().zip(&upper_left().toward).map(|(n, l)| n * l).sum::<f32>();
        prop_assume!(facing > 0.3);
        let mut spot = spot(GREY, 0.6, slope);
        spot.facet.open = open;
        let all = lit(&spot, &upper_left())[0];
        spot.facet.seen = seen;
        let part = lit(&spot, &upper_left())[0];
        prop_assert!(part <= all && part >= AMBIENT * open * GREY[0] * 0.999, "{} {}", part, all);
    }
}
