//! Properties of the operations over all motions.

mod hands;

use glam::{DMat3, DQuat, DVec3};
use hands::{HEAD_M, hatching, pen, six_dof};
use maulstick_brush::desk::pen_orientation;
use maulstick_motion::join::PAUSE_S;
use maulstick_motion::{
    Mirror, MotionError, Pace, Part, Placement, TakeSample, cut, joined, mirrored, retimed, strokes,
};
use maulstick_types::stylus::{StylusPose, StylusSample};
use proptest::collection::vec;
use proptest::prelude::*;

/// A pen, or a 6-DOF stylus, somewhere on or above the desk.
fn sample() -> impl Strategy<Value = StylusSample> {
    let place = (-0.3..0.3f64, -0.3..0.3f64);
    let tilt = (-1.0..1.0f64, -1.0..1.0f64, -3.0..3.0f64);
    let pens = (place.clone(), tilt, 0.0..1.0f64).prop_map(|((x, y), (a, b, turn), force)| {
        let mut sample = pen([x, y], (force - 0.3).max(0.0));
        if let StylusPose::Contact {
            tilt_rad,
            twist_rad,
            ..
        } = &mut sample.pose
        {
            (*tilt_rad, *twist_rad) = ([a, b], turn);
        }
        sample.velocity_m_s = [x, y, 0.1];
        sample
    });
    let quaternion = (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, 0.1..1.0f64);
    let others = (place, -0.02..0.02f64, quaternion).prop_map(|((x, y), z, (a, b, c, w))| {
        let mut sample = six_dof([x, y, z]);
        if let StylusPose::Ferrule { pose } = &mut sample.pose {
            pose.orientation = DQuat::from_xyzw(a, b, c, w).normalize().to_array();
        }
        sample.force_n = [x, y, z];
        sample
    });
    prop_oneof![pens, others]
}

/// Motions with pauses of up to half a second.
fn motion() -> impl Strategy<Value = Vec<TakeSample>> {
    vec((sample(), 1_000_000..500_000_000u64), 1..40).prop_map(|steps| {
        let mut time_ns = 123;
        let taken = |(sample, step_ns)| {
            time_ns += step_ns;
            TakeSample { time_ns, sample }
        };
        steps.into_iter().map(taken).collect()
    })
}

/// All numbers of a sample that an operation may change.
fn numbers(sample: &StylusSample) -> Vec<f64> {
    let mut all = [sample.velocity_m_s, sample.force_n].concat();
    match &sample.pose {
        StylusPose::Contact {
            point_m,
            tilt_rad,
            twist_rad,
            pressure,
        } => {
            all.extend(point_m);
            all.extend(tilt_rad);
            all.extend([twist_rad, pressure]);
        }
        StylusPose::Ferrule { pose } => {
            all.extend(pose.position_m);
            // q and −q are one turn.
            let turn = DQuat::from_array(pose.orientation);
            all.extend(DMat3::from_quat(turn).to_cols_array());
        }
    }
    all
}

/// Greatest difference of two motions, over all their numbers.
fn off(one: &[TakeSample], other: &[TakeSample]) -> f64 {
    assert_eq!(one.len(), other.len());
    let pairs = one.iter().zip(other);
    let all = pairs.flat_map(|(a, b)| {
        assert_eq!(a.time_ns, b.time_ns);
        let (a, b) = (numbers(&a.sample), numbers(&b.sample));
        a.into_iter()
            .zip(b)
            .map(|(a, b)| (a - b).abs())
            .collect::<Vec<_>>()
    });
    all.fold(0.0, f64::max)
}

fn rises(motion: &[TakeSample]) -> bool {
    motion
        .windows(2)
        .all(|pair| pair[0].time_ns < pair[1].time_ns)
}

/// Heights of the point, and pressures.
fn depths(motion: &[TakeSample]) -> Vec<[f64; 2]> {
    let depth = |taken: &TakeSample| [taken.point(HEAD_M)[2], taken.press(HEAD_M)];
    motion.iter().map(depth).collect()
}

proptest! {
    #[test]
    fn scaling_and_turning_can_be_undone_and_leave_the_contact(
        motion in motion(), scale in 0.1..5.0f64, turn in -3.0..3.0f64, x in -0.1..0.1f64, y in -0.1..0.1f64
    ) {
        let there = Placement { from_m: [x, y], to_m: [y, x], scale, turn_rad: turn };
        let back = Placement { from_m: [y, x], to_m: [x, y], scale: 1.0 / scale, turn_rad: -turn };
        let placed = there.motion(&motion, HEAD_M).expect("on the desk");
        prop_assert!(off(&back.motion(&placed, HEAD_M).expect("back"), &motion) < 1e-9);
        for (a, b) in depths(&motion).iter().zip(depths(&placed)) {
            prop_assert!((a[0] - b[0]).abs() < 1e-12 && (a[1] - b[1]).abs() < 1e-9);
        }
        for (a, b) in motion.iter().zip(&placed) {
            let [ax, ay, _] = a.point(HEAD_M);
            let [bx, by, _] = b.point(HEAD_M);
            let [wx, wy] = there.point([ax, ay]);
            prop_assert!((bx - wx).abs() < 1e-12 && (by - wy).abs() < 1e-12);
        }
    }

    #[test]
    fn a_mirror_in_a_mirror_shows_the_motion_itself(motion in motion(), at in -0.1..0.1f64) {
        for mirror in [Mirror::X, Mirror::Y] {
            let once = mirrored(&motion, mirror, [at, -at]).expect("on the desk");
            prop_assert!(off(&mirrored(&once, mirror, [at, -at]).expect("twice"), &motion) < 1e-12);
            for (a, b) in depths(&motion).iter().zip(depths(&once)) {
                prop_assert!((a[0] - b[0]).abs() < 1e-12 && (a[1] - b[1]).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_handle_is_turned_and_mirrored_as_its_matrix_is(sample in sample(), turn in -3.0..3.0f64) {
        let matrix = |sample: &StylusSample| DMat3::from_quat(match &sample.pose {
            StylusPose::Contact { tilt_rad, twist_rad, .. } => pen_orientation(*tilt_rad, *twist_rad),
            StylusPose::Ferrule { pose } => DQuat::from_array(pose.orientation),
        });
        let same = |a: DMat3, b: DMat3| a.abs_diff_eq(b, 1e-9);
        let turned = Placement::turned([0.0; 2], turn).sample(&sample, HEAD_M);
        prop_assert!(same(matrix(&turned), DMat3::from_rotation_z(turn) * matrix(&sample)));
        // The mirror of the world, and of the brush in its broad side.
        let own = DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
        for (mirror, signs) in [(Mirror::X, [-1.0, 1.0, 1.0]), (Mirror::Y, [1.0, -1.0, 1.0])] {
            let world = DMat3::from_diagonal(DVec3::from_array(signs));
            let shown = matrix(&mirror.sample(&sample, [0.0; 2]));
            prop_assert!(same(shown, world * matrix(&sample) * own));
            prop_assert!(!same(shown, world * matrix(&sample) * world * DMat3::from_rotation_z(0.1)));
        }
    }

    #[test]
    fn parts_of_strokes_share_nothing_and_are_the_whole(motion in motion(), at in 0.0..1.0f64) {
        let count = strokes(&motion, HEAD_M).len();
        if count >= 2 {
            let last = 1 + (at * (count - 1) as f64) as usize;
            let part = |numbers| cut(&motion, &Part::Strokes(numbers), HEAD_M).expect("there");
            let (one, two) = (part(1..=last), part(last + 1..=count));
            let whole: Vec<_> = one.iter().chain(&two).map(|taken| &taken.sample).collect();
            let own: Vec<_> = motion.iter().map(|taken| &taken.sample).collect();
            prop_assert_eq!(whole, own);
            prop_assert_eq!(strokes(&one, HEAD_M).len(), last);
            prop_assert_eq!(strokes(&two, HEAD_M).len(), count - last);
        }
    }

    #[test]
    fn what_is_joined_can_be_cut_out_again(one in motion(), two in motion()) {
        let whole = joined(&[&one, &two], PAUSE_S).expect("joined");
        prop_assert!(rises(&whole));
        let start = |motion: &[TakeSample]| motion[0].time_ns;
        let from_start = |motion: &[TakeSample]| -> Vec<TakeSample> {
            let start = start(motion);
            let own = motion.iter().cloned();
            own.map(|taken| TakeSample { time_ns: taken.time_ns - start, ..taken }).collect()
        };
        let end = one[one.len() - 1].time_ns - start(&one);
        let length = whole[whole.len() - 1].time_ns;
        let behind = length - (two[two.len() - 1].time_ns - start(&two));
        let times = |times| cut(&whole, &Part::Times(times), HEAD_M).expect("there");
        prop_assert_eq!(times([0, end]), from_start(&one));
        prop_assert_eq!(times([behind, length]), from_start(&two));
        let way = times([end + 1, behind - 1]);
        prop_assert!(way.iter().all(|taken| taken.sample.in_air()), "it paints on its way");
        let each = strokes(&one, HEAD_M).len() + strokes(&two, HEAD_M).len();
        prop_assert_eq!(strokes(&whole, HEAD_M).len(), each);
    }

    #[test]
    fn a_pace_can_be_undone_and_velocities_follow(motion in motion(), rate in 0.5..20.0f64) {
        let fast = retimed(&motion, Pace::Rate(rate));
        // A slower one may tear a stroke, which is said.
        if let Ok(fast) = fast {
            prop_assert!(rises(&fast));
            for (a, b) in motion.iter().zip(&fast) {
                let passed = (a.time_ns - motion[0].time_ns) as f64 / rate;
                prop_assert!(((b.time_ns - motion[0].time_ns) as f64 - passed).abs() <= 0.5);
                for (a, b) in a.sample.velocity_m_s.iter().zip(b.sample.velocity_m_s) {
                    prop_assert!((a * rate - b).abs() < 1e-12);
                }
            }
        } else {
            prop_assert!(rate < 1.0);
        }
    }
}

#[test]
fn a_motion_takes_as_long_as_it_is_asked_to() {
    let motion = hatching(3, 0.05, 0.004, 0.0);
    let longer = retimed(&motion, Pace::Length(4.0)).expect("slower");
    let length = longer[longer.len() - 1].time_ns - longer[0].time_ns;
    assert!(length.abs_diff(4_000_000_000) <= 1, "{length}");
}

#[test]
fn what_cannot_be_is_refused_with_its_bounds() {
    let motion = hatching(3, 0.05, 0.004, 0.0);
    for scale in [0.0, -1.0, 1e3, f64::NAN, f64::INFINITY] {
        let fault = Placement::scaled([0.0; 2], scale).motion(&motion, HEAD_M);
        assert!(
            matches!(fault, Err(MotionError::OutOfRange { .. })),
            "{scale}: {fault:?}"
        );
    }
    for pace in [
        Pace::Rate(0.0),
        Pace::Rate(-2.0),
        Pace::Rate(f64::NAN),
        Pace::Length(0.0),
        Pace::Length(-1.0),
        Pace::Length(f64::INFINITY),
    ] {
        let fault = retimed(&motion, pace);
        assert!(
            matches!(fault, Err(MotionError::OutOfRange { .. })),
            "{pace:?}: {fault:?}"
        );
    }
    let torn = retimed(&motion, Pace::Rate(0.01)).expect_err("8 ms become 800");
    assert!(matches!(torn, MotionError::Torn { .. }), "{torn:?}");
    let far = Placement::moved([9.99, 0.0])
        .motion(&motion, HEAD_M)
        .expect_err("too far");
    assert!(matches!(far, MotionError::Sample { .. }), "{far:?}");
    let nan = Placement::moved([f64::NAN, 0.0]).motion(&motion, HEAD_M);
    assert!(
        matches!(nan, Err(MotionError::OutOfRange { .. })),
        "{nan:?}"
    );
    let fault = |part| cut(&motion, &part, HEAD_M).expect_err("refused");
    let none = MotionError::NoStroke { asked: 4, count: 3 };
    assert_eq!(fault(Part::Strokes(2..=4)), none);
    assert_eq!(
        fault(Part::Strokes(0..=1)),
        MotionError::NoStroke { asked: 0, count: 3 }
    );
    assert!(matches!(
        fault(Part::Times([u64::MAX - 1, u64::MAX])),
        MotionError::NothingLeft { .. }
    ));
    assert_eq!(joined(&[], PAUSE_S), Err(MotionError::NoMotion));
    assert!(joined(&[&motion], 0.1).is_err(), "the strokes would be one");
}
