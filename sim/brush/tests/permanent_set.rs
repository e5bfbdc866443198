//! The bend that stays in a brush: as long as it is not reshaped, however often it is solved, and never more than its
//! friction holds.

use glam::{DQuat, DVec2, DVec3, Vec2};
use maulstick_brush::file::library::LIBRARY;
use maulstick_brush::solver::{ContactConstraint, HalfSpace, Settings, Solver};
use maulstick_brush::{BrushFile, BrushModel, Spine, SpineShape};
use maulstick_types::brush::Solve;
use maulstick_types::scene::{BrushSet, Well, WellKind};
use maulstick_types::stylus::{StylusPose, StylusSample};
use maulstick_types::{Origin, Pose};

mod desk;

const DEVICE: Origin = Origin {
    source: 1,
    epoch: 1,
};
const MS: u64 = 1_000_000;
/// Depth to which the handle is pressed, m.
const PRESS_M: f64 = 10e-3;

/// A brush in a hand that holds it by its handle, leaning by half a radian.
struct Hand {
    model: BrushModel,
    file: BrushFile,
    now_ns: u64,
    /// Distance between two samples, m.
    stride_m: f64,
    at: [f64; 2],
}

impl Hand {
    fn new(kind: &str) -> Self {
        Self::of(BrushFile::library(kind).expect(kind))
    }

    fn of(file: BrushFile) -> Self {
        let mut model = BrushModel::new(file.clone(), 0.5);
        let mut scene = desk::scene();
        scene.surfaces[0].wells.push(Well {
            center_m: [0.25, 0.05],
            radius_m: 0.02,
            kind: WellKind::Cleaner,
        });
        model.set_scene(&scene);
        Self {
            model,
            file,
            now_ns: 1000 * MS,
            stride_m: 0.5e-3,
            at: [0.0; 2],
        }
    }

    /// Holds the tip of the unbent head at `x`, and this deep below the canvas, m.
    fn hold(&mut self, [x, depth]: [f64; 2]) -> Solve {
        let (sine, cosine) = maulstick_num::sin_cos(0.25);
        let length = self.file.length_m();
        let lean = DQuat::from_xyzw(0.0, sine, 0.0, cosine);
        let ferrule = lean * DVec3::Z * length + DVec3::new(x, -0.078, -depth);
        let sample = StylusSample {
            pose: StylusPose::Ferrule {
                pose: Pose {
                    position_m: ferrule.to_array(),
                    orientation: lean.to_array(),
                },
            },
            in_range: true,
            ..StylusSample::away()
        };
        self.now_ns += 8 * MS;
        self.at = [x, depth];
        let solves = self.model.follow(DEVICE, self.now_ns, &sample);
        solves.last().expect("a scene").clone()
    }

    /// Moves there in a straight line.
    fn go(&mut self, to: [f64; 2]) -> Solve {
        let from = self.at;
        let way = DVec2::from_array(from).distance(to.into());
        let steps = (way / self.stride_m).ceil().max(1.0) as u32;
        let step = |i: u32| f64::from(i) / f64::from(steps);
        let path = (1..=steps).map(|i| [0, 1].map(|k| from[k] + (to[k] - from[k]) * step(i)));
        path.map(|at| self.hold(at)).last().expect("a step")
    }

    /// A stroke from `x` on: pressed, dragged 30 mm, and lifted.
    fn stroke(&mut self, x: f64) -> Solve {
        let deep = PRESS_M.min(0.6 * self.file.length_m());
        for to in [[x, -5e-3], [x, deep], [x + 0.03, deep]] {
            self.go(to);
        }
        self.go([x + 0.03, -1.5 * self.file.length_m()])
    }

    /// Mean bend of the joints of a solve beyond that at rest, degrees.
    fn bend(&self, solve: &Solve) -> f64 {
        assert!(solve.contacts.is_empty(), "it is lifted");
        let rest = Self::of(self.file.clone()).hold([0.0, -0.1]);
        let joints = self.file.spines.all_joints();
        let pairs = solve.angles_rad.iter().zip(&rest.angles_rad).take(joints);
        let bends = pairs.map(|(a, b)| f64::from(Vec2::from_array(*a).distance((*b).into())));
        (bends.sum::<f64>() / joints as f64).to_degrees()
    }
}

/// Brushes whose files say that they keep a bend.
fn plastic() -> impl Iterator<Item = &'static str> {
    let kinds = LIBRARY.iter().map(|(kind, _)| *kind);
    kinds.filter(|kind| BrushFile::library(kind).expect("built in").spines.damping > 0.0)
}

#[test]
fn a_bend_outlasts_solves_and_hours_in_the_air() {
    for kind in plastic() {
        let mut hand = Hand::new(kind);
        let lifted = hand.stroke(0.0);
        let at_lift = hand.bend(&lifted);
        let solves = (0..1000).map(|_| hand.hold(hand.at)).last().expect("some");
        let after_solves = hand.bend(&solves);
        hand.now_ns += 3_600_000 * MS;
        let rested = hand.hold(hand.at);
        let after_an_hour = hand.bend(&rested);
        println!("{kind:8} {at_lift:.3}, {after_solves:.3}, {after_an_hour:.3} degrees");
        assert!((0.1..1.2).contains(&at_lift), "{kind}: {at_lift}");
        for later in [after_solves, after_an_hour] {
            assert!((later / at_lift - 1.0).abs() < 0.01, "{kind}: {later}");
        }
    }
    let mut knife = Hand::new("knife");
    let lifted = knife.stroke(0.0);
    assert!(knife.bend(&lifted) < 1e-3, "steel springs back");
}

/// The mean bend of a spine that a wall pushed aside and let go, after more solves of the same pose. With `forgets` its
/// joints lose their anchors at each solve, as those of a viscous damper do.
fn left_after(more: u32, forgets: bool) -> f64 {
    let spine = Spine::uniform(0.03, 3, 1e-4).damped(0.02);
    let mut shape = SpineShape::straight(DVec3::ZERO, DQuat::IDENTITY, 3);
    let settings = Settings::for_length(0.03).with_friction(0.0);
    let mut wall = [ContactConstraint::new(
        2,
        HalfSpace {
            normal: DVec3::X,
            offset_m: 0.0,
        },
    )];
    let pushes = (0..=40).chain((0..40).rev()).map(f64::from);
    let still = (0..more).map(|_| -10.0);
    for push in pushes.chain(still) {
        wall[0].half_space.offset_m = 0.3e-3 * push;
        if forgets {
            shape.anchors.clone_from(&shape.directions);
        }
        Solver::default().solve(&spine, &mut shape, &mut wall, &[], &settings);
    }
    let ends = shape.directions.iter().map(|d| d.x.abs());
    ends.sum::<f64>()
}

#[test]
fn a_bend_does_not_depend_on_the_number_of_solves() {
    let (few, many) = (left_after(1, false), left_after(400, false));
    assert!(
        few > 0.01 && (many / few - 1.0).abs() < 1e-6,
        "{few} {many}"
    );
    assert!(
        left_after(400, true) < 0.5 * few,
        "a viscous damper creeps back"
    );
    let bend = |stride_m: f64| {
        let mut hand = Hand::new("flat");
        hand.stride_m = stride_m;
        let lifted = hand.stroke(0.0);
        hand.bend(&lifted)
    };
    let (coarse, fine) = (bend(1e-3), bend(0.2e-3));
    assert!((coarse / fine - 1.0).abs() < 0.02, "{coarse} {fine}");
}

/// Least work that a wall has done on a spine so far, while it pushes the tip to and fro, J, with this factor on the
/// friction in the joints.
fn least_work(factor: f64) -> f64 {
    let spine = Spine::uniform(1.0, 4, 1.0).damped(0.05);
    let mut shape = SpineShape::straight(DVec3::ZERO, DQuat::IDENTITY, 4);
    let settings = Settings {
        damping: factor,
        ..Settings::for_length(1.0).with_friction(0.0)
    };
    let mut wall = [ContactConstraint::new(
        3,
        HalfSpace {
            normal: DVec3::X,
            offset_m: 0.0,
        },
    )];
    let (mut work, mut least) = (0.0, 0.0f64);
    let (mut force_n, mut offset_m) = (0.0, 0.0);
    for step in 0..1500 {
        let (a, b) = (0.021 * f64::from(step), 0.0137 * f64::from(step));
        let way = maulstick_num::sin(a) + maulstick_num::sin(b);
        wall[0].half_space.offset_m = 0.15 * way;
        Solver::default().solve(&spine, &mut shape, &mut wall, &[], &settings);
        work += 0.5 * (force_n + wall[0].force_n) * (0.15 * way - offset_m);
        (force_n, offset_m) = (wall[0].force_n, 0.15 * way);
        least = least.min(work);
    }
    least
}

#[test]
fn a_joint_never_gives_back_more_than_was_put_in() {
    let (passive, active) = (least_work(1.0), least_work(-1.0));
    println!("{passive:.2e}, active {active:.2e} J");
    assert!(passive > -1e-6, "{passive}");
    assert!(active < -5e-4, "an active joint would pass: {active}");
}

#[test]
fn bends_do_not_add_up_from_stroke_to_stroke() {
    for kind in plastic() {
        let mut hand = Hand::new(kind);
        let strokes = (0..6).map(|_| {
            let lifted = hand.stroke(0.0);
            hand.bend(&lifted)
        });
        let bends: Vec<f64> = strokes.collect();
        assert!((bends[5] / bends[1] - 1.0).abs() < 0.1, "{kind}: {bends:?}");
    }
}

#[test]
fn a_soaked_head_keeps_more_of_a_bend() {
    let bend = |wetness: f64| {
        let mut hand = Hand::new("flat");
        hand.model.soak(wetness);
        let lifted = hand.stroke(0.0);
        hand.bend(&lifted)
    };
    let (dry, soaked) = (bend(0.0), bend(1.0));
    assert!(soaked > 1.5 * dry, "{dry} {soaked}");
}

#[test]
fn a_bend_goes_in_the_cleaner_by_order_and_with_another_brush() {
    let mut hand = Hand::new("mop");
    let lifted = hand.stroke(0.0);
    let bent = hand.bend(&lifted);
    let order = |given: u32, angles_rad: &[[f32; 2]]| BrushSet {
        brush: "main".to_owned(),
        given,
        angles_rad: angles_rad.to_vec(),
    };
    hand.model.take_set(None);
    hand.model.take_set(Some(&order(0, &[])));
    let same = hand.hold(hand.at);
    assert_eq!(hand.bend(&same), bent, "it was given none");
    hand.model.take_set(Some(&order(1, &[])));
    let unbent = hand.hold(hand.at);
    assert!(hand.bend(&unbent) < 1e-3);
    hand.model.take_set(Some(&order(2, &lifted.angles_rad)));
    let again = hand.hold(hand.at);
    assert!(
        (hand.bend(&again) - bent).abs() < 1e-3,
        "the bend of an undone stroke"
    );
    // From the canvas into the jar.
    hand.go([0.03, 4e-3]);
    hand.go([0.11, -0.06]);
    hand.go([0.122, -0.06]);
    hand.go([0.122, 4e-3]);
    let clean = hand.go([0.122, -0.06]);
    assert!(hand.bend(&clean) < 1e-3, "{}", hand.bend(&clean));
    let lifted = hand.stroke(0.0);
    assert!(hand.bend(&lifted) > 0.5 * bent);
    hand.model.take_up(hand.file.clone());
    let other = hand.hold(hand.at);
    assert!(hand.bend(&other) < 1e-3);
}
