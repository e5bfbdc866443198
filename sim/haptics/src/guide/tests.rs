//! The force of a guide against its potential.

use proptest::prelude::*;

use super::*;

pub(crate) fn model(points_m: &[[f64; 3]]) -> GuideModel {
    GuideModel {
        device: 0,
        device_epoch: 0,
        points_m: points_m.to_vec(),
        normal: [0.0, 0.0, 1.0],
        head_length_m: 0.025,
        stiffness_n_m: 80.0,
        damping_n_s_m: 0.0,
        max_force_n: 0.6,
        time_to_live_ns: 50_000_000,
    }
}

/// A hand whose tip is at a place, with a tilted brush.
pub(crate) fn at(tip: DVec3, velocity: DVec3) -> HandleState {
    let orientation = maulstick_num::geometry::rotation(DVec3::new(0.6, 0.8, 0.0), 0.4);
    HandleState {
        position: tip + orientation * DVec3::Z * 0.025,
        orientation,
        velocity,
    }
}

const BOUNDS: GuideBounds = GuideBounds {
    stiffness_n_m: 100.0,
    damping_n_s_m: 0.8,
    force_n: 0.6,
    reach_m: 0.03,
};

/// A path with an obtuse bend, an end, and a change of height, which vanishes within the canvas.
const BENT: [[f64; 3]; 4] = [
    [-0.2, 0.0, 0.0],
    [0.0, 0.0, -0.01],
    [0.1, 0.05, 0.02],
    [0.2, 0.05, 0.0],
];

fn pull(guide: &Guide, tip: DVec3) -> DVec3 {
    let handle = at(tip, DVec3::ZERO);
    guide
        .pull(guide.first(&handle), &handle, &BOUNDS)
        .conservative
}

/// Distance from the path, by its points.
fn distance(tip: DVec3) -> f64 {
    let mut least = f64::MAX;
    for pair in BENT.windows(2) {
        for i in 0..=20_000 {
            let t = f64::from(i) / 20_000.0;
            let at = |axis: usize| pair[0][axis] + t * (pair[1][axis] - pair[0][axis]);
            let (x, y) = (tip.x - at(0), tip.y - at(1));
            least = least.min(x * x + y * y);
        }
    }
    least.sqrt()
}

/// Force at a distance, N, by the module's documentation.
fn force(distance_m: f64) -> f64 {
    let spring = if distance_m > 0.0075 {
        0.6
    } else {
        80.0 * distance_m
    };
    match distance_m {
        d if d <= 0.03 => spring,
        d if d >= 0.06 => 0.0,
        d => spring * (0.06 - d) / 0.03,
    }
}

/// Integral of the force, J.
fn potential(distance_m: f64) -> f64 {
    let steps = 2000;
    let step = distance_m / f64::from(steps);
    let middle = |i: i32| force((f64::from(i) + 0.5) * step) * step;
    (0..steps).map(middle).sum()
}

#[test]
fn the_force_is_the_gradient_of_its_potential() {
    let guide = Guide::new(&model(&BENT)).expect("a guide");
    for (x, y) in [
        (-0.1, 0.003),
        (-0.05, -0.012),
        (0.0, -0.005),
        (0.002, -0.02),
        (0.06, 0.035),
        (0.1, 0.058),
        (0.15, 0.09),
        (0.12, 0.1),
    ] {
        let tip = DVec3::new(x, y, 0.004);
        let step = 1e-5;
        let slope = |way: DVec3| {
            (potential(distance(tip - way)) - potential(distance(tip + way))) / (2.0 * step)
        };
        let expected = DVec3::new(slope(DVec3::X * step), slope(DVec3::Y * step), 0.0);
        let found = pull(&guide, tip);
        println!("{tip}: {found}, expected {expected}");
        assert!((found - expected).length() < 2e-4, "{tip}");
        // The seeded fault: a force toward an earlier nearest point is no gradient.
        let handle = at(tip, DVec3::ZERO);
        let mut behind = guide.first(&handle);
        behind.along -= 0.1;
        let wrong = guide.pull(behind, &handle, &BOUNDS).conservative;
        assert!((wrong - expected).length() > 2e-3, "{tip}");
    }
}

#[test]
fn a_nearest_point_is_followed_along_the_path_and_changes_where_the_distance_falls() {
    // A hairpin 8 mm wide, whose legs are 50 mm long.
    let hairpin = [
        [0.0, 0.0, 0.0],
        [0.05, 0.0, 0.0],
        [0.05, 0.008, 0.0],
        [0.0, 0.008, 0.0],
    ];
    let guide = Guide::new(&model(&hairpin)).expect("a guide");
    let tip = |x: f64, y: f64| at(DVec3::new(x, y, 0.0), DVec3::ZERO);
    let mut foot = guide.first(&tip(0.01, 0.001));
    assert_eq!(foot.piece, 0);
    // The hand crosses to the other leg and is held by the first one.
    for step in 0..100 {
        foot = guide.follow(foot, &tip(0.01, 0.001 + 7e-5 * f64::from(step)));
    }
    assert_eq!(foot.piece, 0);
    // Along the path the point passes the bend.
    for step in 0..100 {
        foot = guide.follow(foot, &tip(0.01 + 4.5e-4 * f64::from(step), 0.001));
    }
    for step in 0..100 {
        foot = guide.follow(foot, &tip(0.055, 0.001 + 1e-4 * f64::from(step)));
    }
    for step in 0..100 {
        foot = guide.follow(foot, &tip(0.055 - 4.5e-4 * f64::from(step), 0.011));
    }
    assert_eq!(foot.piece, 2);
}

#[test]
fn bad_guides_are_refused() {
    let refused = |change: fn(&mut GuideModel)| {
        let mut model = model(&BENT);
        change(&mut model);
        Guide::new(&model).is_err()
    };
    assert!(!refused(|_| {}));
    assert!(refused(|m| m.points_m[1][2] = f64::NAN));
    assert!(refused(|m| m.points_m[1][0] = f64::INFINITY));
    assert!(refused(|m| m.points_m[1][0] = 1e300));
    assert!(refused(|m| m.points_m.truncate(1)));
    assert!(refused(|m| m.points_m = vec![[0.0; 3]; 17]));
    assert!(refused(|m| m.points_m = vec![[0.0; 3]; 16]));
    assert!(refused(|m| m.points_m = vec![[0.0; 3], [0.0, 0.0, 0.1]]));
    assert!(refused(|m| m.normal = [0.0, 0.0, 1.1]));
    assert!(refused(|m| m.normal = [f64::NAN, 0.0, 1.0]));
    assert!(refused(|m| m.head_length_m = -0.01));
    assert!(refused(|m| m.stiffness_n_m = f64::NAN));
    assert!(refused(|m| m.stiffness_n_m = -1.0));
    assert!(refused(|m| m.damping_n_s_m = f64::INFINITY));
    assert!(refused(|m| m.max_force_n = f64::NAN));
    assert!(refused(|m| m.time_to_live_ns = 1_000_000_001));
    // What is large is bounded.
    assert!(!refused(|m| m.stiffness_n_m = 1e300));
}

proptest! {
    #[test]
    fn the_force_is_toward_the_path_across_it_and_no_larger_than_it_may_be(
        x in -0.5..0.5f64, y in -0.2..0.2f64, z in -0.1..0.1f64,
        asked in 0.0..1e6f64, most in 0.0..100.0f64, turn in -3.0..3.0f64,
        velocity in -2.0..2.0f64,
    ) {
        let way = DVec3::new(maulstick_num::cos(turn), maulstick_num::sin(turn), 0.0);
        let points = [(way * -0.05).to_array(), (way * 0.05).to_array()];
        let guide = Guide::new(&GuideModel {
            stiffness_n_m: asked,
            max_force_n: most,
            damping_n_s_m: asked,
            ..model(&points)
        })
        .expect("a guide");
        let handle = at(DVec3::new(x, y, z), DVec3::new(velocity, 0.1, 0.2));
        let pull = guide.pull(guide.first(&handle), &handle, &BOUNDS);
        let aside = DVec3::new(x, y, 0.0) - way * DVec3::new(x, y, 0.0).dot(way);
        let force = pull.conservative;
        prop_assert!(force.dot(aside) <= 0.0 && force.dot(way).abs() < 1e-9 && force.z == 0.0);
        prop_assert!(force.length() <= (100.0 * aside.length()).min(0.6).min(most) + 1e-9);
        prop_assert!(aside.length() < 0.06 || force.length() < 1e-9);
        prop_assert!(pull.damping.dot(handle.velocity) <= 0.0);
        prop_assert!(pull.damping.dot(way).abs() < 1e-9 && pull.damping.length() <= 0.6 + 1e-9);
    }
}

#[test]
fn a_hand_of_another_orientation_is_held_by_its_tip() {
    let guide = Guide::new(&model(&[[0.0; 3], [0.1, 0.0, 0.0]])).expect("a guide");
    let tip = DVec3::new(0.03, 0.005, -0.002);
    let upright = HandleState::upright(tip + DVec3::Z * 0.025);
    let felt = guide.pull(guide.first(&upright), &upright, &BOUNDS);
    assert!((felt.conservative - DVec3::Y * -0.4).length() < 1e-12);
    assert!((felt.left_m - 0.005).abs() < 1e-12);
    assert!((pull(&guide, tip) - felt.conservative).length() < 1e-12);
}
