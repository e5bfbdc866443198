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
        slope,
        seen: 1.0,
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
        let slope = spot.slope.map(|rise| -rise);
        lit(&Spot { slope, ..*spot }, lamp)
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
    let half = lamp.half[0] / -lamp.half[2];
    let (at, shine) = best(1.0, &lamp);
    // The angle of incidence draws the maximum a little toward the lamp.
    assert!((at - half).abs() < 0.03, "{at} for {half}");
    assert!(shine > 0.2 && shine < 1.0, "{shine}");
    assert_eq!(lit(&spot([0.0; 3], 0.0, [at, -at]), &lamp), [SURFACE; 3]);
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
fn a_lower_lamp_shines_more_on_what_faces_it() {
    // Fresnel: at the half vector of a lamp 6° high light falls at 42°; straight above, at 0°.
    let low = from([-1.0, 0.0, 0.1]);
    let above = from([0.0, 0.0, 1.0]);
    let k1 = SurfaceCorrection::default().k1;
    assert!((f64::from(above.peak[0]) - 9.0 * k1).abs() < 1e-7);
    assert!(low.peak[0] > 1.1 * above.peak[0], "{:?}", low.peak);
}

#[test]
fn paint_is_dull_when_it_is_dry_and_level_when_it_is_thin() {
    assert_eq!([gloss(0.0, 1.0), gloss(0.0, 0.0)], [0.75, 0.3]);
    assert_eq!([gloss(1.0, 1.0), gloss(1.0, 0.0)], [1.0, 1.0]);
    assert!(gloss(0.5, 0.5) > gloss(0.2, 0.5) && gloss(0.2, 0.6) > gloss(0.2, 0.5));
    assert_eq!(gloss(-1.0, 2.0), 0.75);
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
    assert_eq!((low.toward[2], low.intensity), (LOWEST as f32, 0.0));
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
    let slope = [0.1, -0.2];
    let twice = lit(&spot(GREY, 1.0, slope.map(|v| 2.0 * v)), &one);
    let got = lit(&spot(GREY, 1.0, slope), &other);
    assert_eq!(got, twice.map(|v| 2.0 * v));
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
    ) {
        let whole = spot(GREY, 0.6, slope);
        let [part, all] = [Spot { seen, ..whole }, whole].map(|spot| lit(&spot, &upper_left())[0]);
        prop_assert!(part <= all && part >= AMBIENT * GREY[0] * 0.999);
    }
}
