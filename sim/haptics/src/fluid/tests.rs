//! Acceptance of messages, drag at the hand's velocity, and the transition between forces.

use maulstick_types::Pose;
use proptest::prelude::*;

use super::*;

/// Drag of `c` N·s/m at a velocity, m/s.
pub(crate) fn drag(c: f64, velocity: DVec3) -> FluidForce {
    let mut jacobian = [[0.0; 6]; 6];
    for (i, row) in jacobian.iter_mut().enumerate().take(3) {
        row[i] = -c;
    }
    let six = |v: DVec3| [v.x, v.y, v.z, 0.0, 0.0, 0.0];
    FluidForce {
        device: 0,
        device_epoch: 0,
        pose: Pose::IDENTITY,
        velocity: six(velocity),
        wrench: six(velocity * -c),
        jacobian,
        time_to_live_ns: 100_000_000,
        recovery_ns: 20_000_000,
    }
}

const FADE_S: f64 = 0.075;

#[test]
fn drag_follows_the_hand_whatever_velocity_it_was_computed_for() {
    let mut stage = FluidStage::default();
    let fluid = Fluid::new(&drag(0.3, DVec3::new(0.2, 0.0, 0.0)), 1.0).expect("a drag");
    stage.receive(fluid, FADE_S);
    assert_eq!(stage.force(DVec3::X, FADE_S), DVec3::ZERO, "it comes up");
    stage.age(0.02);
    for velocity in [DVec3::X * 0.2, DVec3::ZERO, DVec3::Y * -0.1] {
        let force = stage.force(velocity, FADE_S);
        assert!(
            (force + velocity * 0.3).length() < 1e-12,
            "{velocity} {force}"
        );
    }
    stage.age(0.1 + 0.02 + FADE_S / 2.0 - 0.04);
    let half = stage.force(DVec3::X, FADE_S).x / -0.3;
    assert!((half - 0.5).abs() < 0.3 && half < 1.0, "late: {half}");
    stage.age(FADE_S);
    assert_eq!(stage.force(DVec3::X, FADE_S), DVec3::ZERO);
}

/// A message held past its period keeps its drag and loses its push.
#[test]
fn paint_that_is_not_heard_of_any_more_drags_and_no_longer_pushes() {
    let mut moving = drag(0.3, DVec3::X * 0.1);
    moving.wrench = [0.0; 6];
    let mut stage = FluidStage::default();
    stage.receive(Fluid::new(&moving, 1.0).expect("a force"), FADE_S);
    for (age_s, push_n) in [(0.02, 0.03), (0.03, 0.015), (0.04, 0.0), (0.09, 0.0)] {
        stage.age(age_s - stage.newest.map_or(0.0, |(_, age_s)| age_s));
        let [rest, fast] = [DVec3::ZERO, DVec3::X].map(|v| stage.force(v, FADE_S).x);
        assert!((rest - push_n).abs() < 1e-12, "{age_s} s: {rest} N");
        assert!((fast - rest + 0.3).abs() < 1e-12, "{age_s} s: {fast} N");
    }
}

#[test]
fn what_would_push_the_hand_or_is_no_number_is_refused() {
    let told = |change: fn(&mut FluidForce)| {
        let mut message = drag(0.3, DVec3::X * 0.1);
        change(&mut message);
        Fluid::new(&message, 1.0).err()
    };
    assert_eq!(told(|_| {}), None);
    // The seeded fault: with the printed, inward normal, drag pushes.
    let inward = told(|m| {
        m.wrench = m.wrench.map(|f| -f);
        m.jacobian = m.jacobian.map(|row| row.map(|part| -part));
    });
    assert!(inward.is_some_and(|told| told.contains("accelerate")));
    // An antisymmetric Jacobian neither brakes nor drives; a shear drives.
    assert_eq!(
        told(|m| (m.jacobian[0][1], m.jacobian[1][0]) = (0.9, -0.9)),
        None
    );
    assert!(told(|m| (m.jacobian[0][1], m.jacobian[1][0]) = (0.9, 0.9)).is_some());
    assert!(told(|m| m.jacobian[2][2] = 1e-3).is_some());
    assert!(told(|m| m.wrench[4] = f64::NAN).is_some());
    assert!(told(|m| m.jacobian[5][5] = f64::INFINITY).is_some());
    assert!(told(|m| m.pose.position_m[0] = f64::NAN).is_some());
    assert!(told(|m| m.time_to_live_ns = 1_000_000_001).is_some());
    assert!(told(|m| m.recovery_ns = u64::MAX).is_some());
    assert!(Fluid::new(&drag(0.3, DVec3::X), f64::NAN).is_err());
}

#[test]
fn the_painters_scale_counts_and_no_scale_is_more_than_a_device_bears() {
    let felt = |scale: f64| {
        let mut stage = FluidStage::default();
        let mut message = drag(0.05, DVec3::ZERO);
        message.recovery_ns = 0;
        stage.receive(Fluid::new(&message, scale).expect("a drag"), FADE_S);
        -stage.force(DVec3::X, FADE_S).x
    };
    assert_eq!([0.0, 1.0, 4.0].map(felt), [0.0, 0.05, 0.2]);
    assert!(felt(1000.0) <= MOST_DRAG);
}

#[test]
fn one_force_gives_way_to_the_next_without_a_step() {
    let mut stage = FluidStage::default();
    let mut last = DVec3::ZERO;
    let mut most: f64 = 0.0;
    for tick in 0..300 {
        if tick % 20 == 0 {
            let c = if tick % 40 == 0 { 0.4 } else { 0.1 };
            stage.receive(
                Fluid::new(&drag(c, DVec3::ZERO), 1.0).expect("a drag"),
                FADE_S,
            );
        }
        let force = stage.force(DVec3::X, FADE_S);
        most = most.max((force - last).length());
        last = force;
        stage.age(1e-3);
    }
    // The window's peak is twice its mean: .3 N over 20 ticks.
    println!("{most} N a tick");
    assert!(most < 2.1 * 0.4 / 20.0);
}

proptest! {
    #[test]
    fn a_mixture_of_forces_that_brake_brakes(
        c in proptest::array::uniform4(0.0..2.0f64), v in proptest::array::uniform3(-1.0..1.0f64),
        ages in proptest::array::uniform4(0.0..0.2f64),
    ) {
        let mut stage = FluidStage::default();
        for (c, age) in c.into_iter().zip(ages) {
            stage.receive(Fluid::new(&drag(c, DVec3::from_array(v) * c), 1.0).expect("a drag"), FADE_S);
            stage.age(age);
            let v = DVec3::from_array([v[1], v[2], v[0]]);
            prop_assert!(stage.force(v, FADE_S).dot(v) <= 1e-12);
        }
    }
}
