//! The relief against its oracles: splines by recursion, work along closed paths, stiffness by differences.

use maulstick_num::{cos, sin};
use maulstick_types::haptics::{ContactModel, ForceLaw, height_bytes};
use proptest::prelude::*;

use super::*;
use crate::contact::tests::{linear, model};
use crate::contact::{Contact, ContactForce, HandleState};
use crate::friction::Stiction;

const HEAD_M: f64 = 0.025;
const CELL_M: f64 = 1e-3;

/// A patch of 16 mm around the origin, of heights in µm by column and row.
pub(crate) fn patch(height_um: impl Fn(usize, usize) -> i16) -> HeightPatch {
    let cells = (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (i, j)));
    HeightPatch {
        corner_m: [-8e-3, -8e-3, 0.0],
        along: [1.0, 0.0, 0.0],
        cell_m: CELL_M,
        heights_um: height_bytes(cells.map(|(i, j)| height_um(i, j))),
    }
}

/// Random heights of up to `most_um` µm to either side.
pub(crate) fn rough(most_um: i16, seed: u64) -> HeightPatch {
    let of = |i: usize, j: usize| {
        let mut state = seed.wrapping_add((i * SIDE + j) as u64 * 77);
        for _ in 0..3 {
            crate::closed_loop_tests::random(&mut state);
        }
        ((crate::closed_loop_tests::random(&mut state) * 2.0 - 1.0) * f64::from(most_um)) as i16
    };
    patch(of)
}

/// A ridge along y over the origin, `high_um` µm high.
pub(crate) fn ridge(high_um: i16) -> HeightPatch {
    patch(|i, _| match i {
        7 | 8 => high_um,
        6 | 9 => high_um / 2,
        _ => 0,
    })
}

/// An edge along y through the origin, `by_um` µm high.
pub(crate) fn edge(by_um: i16) -> HeightPatch {
    patch(|i, _| if i < SIDE / 2 { 0 } else { by_um })
}

fn relief(patch: &HeightPatch) -> Relief {
    let read = Relief::new(patch, DVec3::Z, 1.0).expect("a relief");
    read.expect("not flat")
}

fn over(relief: HeightPatch, law: ForceLaw) -> ContactModel {
    ContactModel {
        relief,
        friction_static: 0.0,
        friction_kinetic: 0.0,
        ..model(law)
    }
}

/// The handle whose undeformed point is at a place.
fn at(tip: DVec3) -> HandleState {
    HandleState::upright(tip + DVec3::Z * HEAD_M)
}

/// Uniform B-spline of a degree that begins at 0, by the recursion of Cox and de Boor.
fn basis(degree: u32, x: f64) -> f64 {
    if degree == 0 {
        return f64::from(u8::from((0.0..1.0).contains(&x)));
    }
    let d = f64::from(degree);
    x / d * basis(degree - 1, x) + (d + 1.0 - x) / d * basis(degree - 1, x - 1.0)
}

/// Height at a place by a sum over all cells, and some beyond the edge, of splines of a degree.
fn height_by_recursion(relief: &Relief, degree: u32, place: [f64; 2]) -> f64 {
    let around = -6..SIDE as i64 + 6;
    let weight = |k: i64, at: f64| {
        let middle = (k as f64 + 0.5) * CELL_M - 8e-3;
        basis(degree, (at - middle) / CELL_M + 0.5 * f64::from(degree + 1))
    };
    let cell = |k: i64| k.clamp(0, SIDE as i64 - 1) as usize;
    let mut sum = 0.0;
    for j in around.clone() {
        for i in around.clone() {
            let weight = weight(i, place[0]) * weight(j, place[1]);
            sum += weight * relief.heights[cell(j)][cell(i)];
        }
    }
    sum
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn height_and_slope_are_those_of_a_cubic_spline(
        x in -11e-3..11e-3f64, y in -11e-3..11e-3f64, seed in 0u64..1000,
    ) {
        let relief = relief(&rough(300, seed));
        let got = relief.at(DVec3::new(x, y, 0.01), 1e9);
        let by_recursion = |x: f64, y: f64| height_by_recursion(&relief, 3, [x, y]);
        prop_assert!((got.height_m - by_recursion(x, y)).abs() < 1e-15);
        let e = 1e-7;
        let slope = DVec3::new(
            by_recursion(x + e, y) - by_recursion(x - e, y),
            by_recursion(x, y + e) - by_recursion(x, y - e),
            0.0,
        ) / (2.0 * e);
        prop_assert!((got.slope - slope).length() < 1e-6, "{} {}", got.slope, slope);
    }

    /// Nothing exceeds the device's stiffness, whatever the heights, the law and the device.
    #[test]
    fn stiffness_stays_within_that_of_the_device(
        most_um in 0i16..=5000,
        seed in 0u64..1000,
        bears in 100.0..1000.0f64,
        place in prop::array::uniform2(-9e-3..9e-3f64),
        depth in -3e-3..6e-3f64,
        turn in prop::array::uniform3(-1.0..1.0f64),
        soft in 0.0..1.0f64,
    ) {
        let law = ForceLaw::Rigid { stiffness_n_m: 2.0 * soft * bears };
        let rough = ContactModel { friction_static: 0.3, ..over(rough(most_um, seed), law) };
        let contact = Contact::new(&rough).expect("a model");
        let tip = DVec3::new(place[0], place[1], -depth);
        let direction = DVec3::from_array(turn).normalize_or(DVec3::Z);
        let stiffness = stiffness_along(&contact, tip, direction, bears);
        prop_assert!(stiffness <= bears * (1.0 + 1e-4), "{} of {}", stiffness, bears);
    }
}

/// Stiffness in a direction, N/m, with bristles sticking beside the tip.
fn stiffness_along(contact: &Contact, tip: DVec3, direction: DVec3, bears: f64) -> f64 {
    let mut stiction = Stiction::default();
    let grip = contact.evaluate(&at(tip), bears).grip;
    stiction.follow(at(tip).position, Some(&grip), 1e-3);
    let e = 1e-8;
    let force = |by: f64| {
        let handle = at(tip + direction * by);
        contact.evaluate_stuck(&handle, &stiction, bears).force
    };
    (force(-e) - force(e)).dot(direction) / (2.0 * e)
}

/// The seeded fault: with unsmoothed heights and an unsoftened law, a wall would be stiffer than its device.
#[test]
fn heights_that_are_taken_as_they_are_would_be_too_stiff() {
    let stiffest = |relief: Relief| {
        let mut contact = Contact::new(&over(patch(|_, _| 1), rigid(400.0))).expect("a model");
        contact.set_relief(relief);
        let along = |i: u32| {
            let place = DVec3::new(f64::from(i) * 8e-6 - 8e-3, 1e-4, 0.0);
            let height = relief.at(place, 400.0);
            let ways = [DVec3::X, DVec3::Z, (DVec3::Z - height.slope).normalize()];
            let depths = [1e-4, 1e-3, 3e-3].map(|d| place + DVec3::Z * (height.height_m - d));
            let each = depths
                .into_iter()
                .flat_map(move |tip| ways.map(|way| (tip, way)));
            each.map(|(tip, way)| stiffness_along(&contact, tip, way, 400.0))
                .fold(0.0, f64::max)
        };
        (0..2000).map(along).fold(0.0, f64::max)
    };
    let smooth = relief(&edge(4000));
    let mut raw = smooth;
    (raw.slope, raw.curvature) = (0.0, 0.0);
    for row in &mut raw.heights {
        *row = std::array::from_fn(|i| if i < SIDE / 2 { 0.0 } else { 4e-3 });
    }
    let mut unsoftened = smooth;
    (unsoftened.slope, unsoftened.curvature) = (0.0, 0.0);
    let [good, steep, stiff] = [smooth, raw, unsoftened].map(stiffest);
    println!("{good:.0} N/m; as it is {steep:.0}, with a law as stiff as the device {stiff:.0}");
    assert!(good <= 400.0 * (1.0 + 1e-4) && steep > 1000.0 && stiff > 410.0);
}

fn rigid(stiffness_n_m: f64) -> ForceLaw {
    ForceLaw::Rigid { stiffness_n_m }
}

/// Work of a force on a hand along a closed path through relief, J, and the sum of its absolute values.
fn round(contact: &Contact, felt: impl Fn(ContactForce) -> DVec3) -> [f64; 2] {
    const STEPS: usize = 40_000;
    let place = |i: usize| {
        let turn = 2.0 * std::f64::consts::PI * i as f64 / STEPS as f64;
        let (x, y) = (5e-3 * cos(turn), 4e-3 * sin(turn) + 1e-3 * sin(3.0 * turn));
        DVec3::new(x, y, -1.5e-3 + 1.2e-3 * sin(2.0 * turn + 0.4))
    };
    let (mut given, mut gone) = (0.0, 0.0);
    for i in 0..STEPS {
        let (from, to) = (place(i), place(i + 1));
        let force = felt(contact.evaluate(&at((from + to) * 0.5), 400.0));
        let work = force.dot(to - from);
        (given, gone) = (given + work, gone + work.abs());
    }
    [given, gone]
}

/// Along a closed path relief gains nothing; the seeded faults, a force that is not tilted by the slope and one tilted
/// along a renormalised normal, do.
#[test]
fn round_a_closed_way_relief_gives_nothing() {
    for (name, relief) in [
        ("rough", rough(400, 3)),
        ("ridge", ridge(800)),
        ("edge", edge(-3000)),
    ] {
        for law in [linear(), rigid(400.0)] {
            let contact = Contact::new(&over(relief.clone(), law.clone())).expect("a model");
            let [given, gone] = round(&contact, |felt| felt.force);
            let [upright, _] = round(&contact, |felt| DVec3::Z * felt.force.z);
            println!(
                "{name} {law:?}: {:.2e} of {gone:.2e} J; untilted {:.2e}",
                given.abs(),
                upright.abs()
            );
            assert!(given.abs() < 1e-6 * gone, "{name}: {given} of {gone} J");
            assert!(upright.abs() > 1e-4 * gone, "{name}: {upright} of {gone} J");
        }
    }
}

/// Across cells the force is continuous without a kink; the seeded fault, bilinear heights, has them.
#[test]
fn no_force_jumps_or_bends_sharply_between_cells() {
    let relief = relief(&rough(500, 5));
    let sharpest = |slope: &dyn Fn(f64) -> f64| {
        let places = (0..16_000).map(|i| f64::from(i) * 1e-6 - 8e-3);
        places.fold(0.0, |most: f64, x| {
            most.max((slope(x + 1e-6) - slope(x)).abs() / 1e-6)
        })
    };
    let cubic = sharpest(&|x| relief.at(DVec3::new(x, 3e-4, 0.0), 1e9).slope.x);
    let kinked = sharpest(&|x| {
        let of = |x: f64| height_by_recursion(&relief, 1, [x, 3e-4]);
        (of(x + 5e-10) - of(x - 5e-10)) / 1e-9
    });
    println!(
        "curvature {cubic:.0} /m, bound {:.0}, kinks {kinked:.0}",
        relief.curvature
    );
    assert!(cubic <= relief.curvature * (1.0 + 1e-6) && relief.curvature <= 200.0 + 1e-9);
    assert!(kinked > 10.0 * relief.curvature);
}

#[test]
fn whatever_the_heights_slope_and_curvature_are_bounded() {
    for patch in [
        rough(5000, 1),
        edge(5000),
        edge(-5000),
        ridge(5000),
        patch(|i, j| if (i + j) % 2 == 0 { 5000 } else { -5000 }),
        patch(|i, j| if (i, j) == (0, 15) { 5000 } else { 0 }),
    ] {
        let relief = relief(&patch);
        assert!(
            relief.slope <= 0.5f64.sqrt() + 1e-9 && relief.curvature <= 200.0 + 1e-9,
            "{relief:?}"
        );
    }
    // A tall edge becomes a ramp and does not vanish.
    let edge = relief(&edge(3000));
    let rise = edge.at(DVec3::X * 7e-3, 1e9).height_m - edge.at(DVec3::X * -7e-3, 1e9).height_m;
    assert!(rise > 2e-3, "{rise} m");
}

/// Known answer: on a slope of 1 : 10, 1 mm deep, by hand.
#[test]
fn a_slope_pushes_the_hand_down_it() {
    let slope = patch(|i, _| (i as i16 * 2 - 15) * 50);
    let contact = Contact::new(&over(slope, linear())).expect("a model");
    let felt = contact.evaluate(&at(DVec3::new(0.0, 0.0, -1e-3)), 400.0);
    // .8 N by 25 mm, and 1 − e^(−.032) of it on the slope.
    let expected = DVec3::new(-0.1 * 0.031_493_418, 0.0, 0.032);
    assert!(
        (felt.force - expected).length() < 1e-8,
        "{} {expected}",
        felt.force
    );
    assert!((felt.depth_m - 1e-3).abs() < 1e-9);
    // A millimetre up the slope the tip is a tenth of that deeper.
    let up = contact.evaluate(&at(DVec3::new(1e-3, 0.0, -1e-3)), 400.0);
    assert!((up.depth_m - 1.1e-3).abs() < 1e-9, "{}", up.depth_m);
}

/// A hand that presses hard feels the plane, whatever its relief.
#[test]
fn relief_acts_on_the_first_newton() {
    let contact = Contact::new(&over(ridge(500), rigid(400.0))).expect("a model");
    let sideways = |depth: f64| {
        let felt = contact.evaluate(&at(DVec3::new(1.5e-3, 0.0, -depth)), 400.0);
        (felt.force.x, felt.force.z)
    };
    let (light, hard) = (sideways(5e-4), sideways(2e-2));
    assert!(light.0 > 0.0 && light.0 < hard.0 && hard.0 < 0.5 * LIGHT_N);
    assert!(hard.1 > 4.0);
}

#[test]
fn a_patch_of_no_height_is_none_and_a_share_makes_it_lower() {
    for law in [linear(), rigid(900.0)] {
        let flat = Contact::new(&over(HeightPatch::flat(), law.clone())).expect("a model");
        let even = Contact::new(&over(patch(|_, _| 0), law.clone())).expect("a model");
        let none = Contact::with_relief(&over(ridge(500), law), 0.0).expect("a model");
        for depth in [-1e-3, 1e-4, 3e-3, 3e-2] {
            let tip = at(DVec3::new(1.5e-3, 0.0, -depth));
            let [flat, even, none] = [&flat, &even, &none].map(|c| c.evaluate(&tip, 400.0));
            assert!((flat.force - even.force).length() < 1e-12);
            assert_eq!(even.force, none.force);
            assert!((flat.stiffness_n_m - even.stiffness_n_m).abs() < 1e-9);
        }
    }
    let height = |share: f64| {
        let half = Relief::new(&ridge(400), DVec3::Z, share).expect("a relief");
        half.expect("not flat").at(DVec3::ZERO, 1e9).height_m
    };
    assert!((height(0.5) / height(1.0) - 0.5).abs() < 1e-9);
}

#[test]
fn a_height_that_changes_a_little_changes_the_relief_a_little() {
    for seed in 0..20 {
        let base = rough(1500, seed);
        let mut other = base.clone();
        let changed = &mut other.heights_um[2 * 100..][..2];
        let um = i16::from_le_bytes([changed[0], changed[1]]) + 1;
        changed.copy_from_slice(&um.to_le_bytes());
        let [a, b] = [relief(&base), relief(&other)];
        let cells = a.heights.iter().flatten().zip(b.heights.iter().flatten());
        let most = cells.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(most < 3e-6, "{most} m by 1 µm");
    }
}

#[test]
fn bad_patches_are_refused_and_said_why() {
    let refused = |change: fn(&mut HeightPatch)| {
        let mut bad = ridge(500);
        change(&mut bad);
        Contact::new(&over(bad, linear())).err()
    };
    assert_eq!(refused(|_| {}), None);
    let number = Some("a number of the relief is not finite");
    assert_eq!(refused(|p| p.corner_m[1] = f64::NAN), number);
    assert_eq!(refused(|p| p.along[0] = f64::INFINITY), number);
    let axis = Some("the relief's axis is not a unit vector in the plane");
    assert_eq!(refused(|p| p.along = [0.0, 0.0, 1.0]), axis);
    assert_eq!(refused(|p| p.along = [2.0, 0.0, 0.0]), axis);
    let cell = Some("a cell of the relief is not of .25 to 25 mm");
    let sides: [fn(&mut HeightPatch); 3] = [
        |p| p.cell_m = 0.0,
        |p| p.cell_m = -1e-3,
        |p| p.cell_m = f64::NAN,
    ];
    for wrong in sides {
        assert_eq!(refused(wrong), cell);
    }
    let count = Some("the relief has not got 256 heights");
    assert_eq!(refused(|p| p.heights_um.truncate(511)), count);
    assert_eq!(refused(|p| p.heights_um.extend([0; 2])), count);
    let tall = Some("a height of the relief is more than 5 mm");
    assert_eq!(
        refused(|p| p.heights_um = patch(|_, _| 10_000).heights_um),
        tall
    );
    assert_eq!(
        refused(|p| p.heights_um = patch(|_, _| i16::MIN).heights_um),
        tall
    );
    assert_eq!(
        refused(|p| p.heights_um = patch(|_, _| -5000).heights_um),
        None
    );
}
