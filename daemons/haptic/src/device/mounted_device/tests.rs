//! A device on the desk: turned, scaled, with a lever, and clutched.

use std::f64::consts::FRAC_PI_2;
use std::sync::{Arc, Mutex};

use glam::DQuat;
use maulstick_device::registration::{Similarity, canvas_m};
use maulstick_num::geometry::{Rigid, canonical, rotation};
use maulstick_rig::config::CanvasSection;
use maulstick_types::stylus::axes;
use proptest::prelude::*;

use super::*;

/// Actions of a test on the device, and orders to it.
#[derive(Debug)]
struct Bench {
    reading: Reading,
    written: Wrench,
    max_torque_nm: f64,
    workspace_m: [f64; 6],
}

/// A device that is where a test puts it.
#[derive(Clone)]
struct Put(Arc<Mutex<Bench>>);

impl Put {
    fn new() -> Self {
        Self(Arc::new(Mutex::new(Bench {
            reading: Reading {
                handle: HandleState {
                    position: DVec3::ZERO,
                    orientation: DQuat::IDENTITY,
                    velocity: DVec3::ZERO,
                },
                switches: 0,
                in_range: true,
                is_permitted: true,
                motor_temperature: 0.0,
            },
            written: Wrench::ZERO,
            max_torque_nm: 0.0,
            workspace_m: [-0.08, -0.06, -0.035, 0.08, 0.06, 0.035],
        })))
    }

    fn bench(&self) -> std::sync::MutexGuard<'_, Bench> {
        self.0.lock().expect("one thread")
    }

    fn put(&self, position: DVec3, switches: u32) {
        let reading = &mut self.bench().reading;
        (reading.handle.position, reading.switches) = (position, switches);
    }
}

impl Driver for Put {
    fn abilities(&self) -> Abilities {
        let bench = self.bench();
        Abilities {
            senses: axes::POSITION | axes::ORIENTATION | axes::SWITCHES,
            drives: axes::FORCE,
            max_force_n: 3.3,
            continuous_force_n: 0.88,
            max_torque_nm: bench.max_torque_nm,
            max_stiffness_n_m: 500.0,
            max_slew_n_s: f64::INFINITY,
            max_speed_m_s: f64::INFINITY,
            damping_n_s_m: 0.3,
            workspace_m: bench.workspace_m,
        }
    }

    fn read(&mut self, _: f64) -> Result<Option<Reading>, DeviceError> {
        Ok(Some(self.bench().reading))
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
        self.bench().written = wrench;
        Ok(())
    }
}

fn registration(rigid: Rigid, scale: f64, ferrule_m: DVec3) -> Registration {
    Registration {
        to_desk: Similarity { rigid, scale },
        ferrule_m,
        corners: None,
    }
}

fn read(placed: &mut MountedDevice) -> Reading {
    placed.read(1e-3).expect("there").expect("new")
}

/// The first switch is the clutch.
const CLUTCH: u32 = 1;

#[test]
fn the_working_area_turns_and_grows_with_the_device() {
    let to_desk = Rigid {
        rotation: rotation(DVec3::X, FRAC_PI_2),
        translation: DVec3::new(1.0, 0.0, 0.0),
    };
    let driver = Put::new();
    let [x0, y0, z0, x1, y1, z1] = driver.abilities().workspace_m;
    let placed = MountedDevice::new(Box::new(driver), registration(to_desk, 2.0, DVec3::ZERO), 0);
    // A quarter turn about x: y is minus what z was, z is what y was.
    let [x, y, z] = [[x0, x1], [-z1, -z0], [y0, y1]].map(|ends| ends.map(|end| 2.0 * end));
    let expected = [x[0] + 1.0, y[0], z[0], x[1] + 1.0, y[1], z[1]];
    let got = placed.abilities().workspace_m;
    let off = got.iter().zip(expected).map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-12, "{got:?} {expected:?}");
}

proptest! {
    /// Of a wall on the desk, −K·x − B·ẋ, the hand gets −K·y − B·ẏ of its own lengths, whatever the
    /// scale and however the device stands.
    #[test]
    fn stiffness_and_damping_are_the_same_in_the_hand(
        scale in 0.05..20.0f64,
        angle in -3.0..3.0f64,
        y in -0.1..0.1f64,
        speed in -1.0..1.0f64,
    ) {
        let rigid = Rigid {
            rotation: canonical(rotation(DVec3::new(0.6, 0.0, 0.8), angle)),
            translation: DVec3::new(0.3, -0.1, 0.2),
        };
        let put = Put::new();
        let along = DVec3::new(0.0, 0.6, 0.8);
        put.put(along * y, 0);
        put.bench().reading.handle.velocity = along * speed;
        let mut placed = MountedDevice::new(Box::new(put.clone()), registration(rigid, scale, DVec3::ZERO), 0);
        let handle = read(&mut placed).handle;
        let (k, b) = (400.0, 3.0);
        let force = (handle.position - rigid.translation) * -k - handle.velocity * b;
        placed.write(force, DVec3::ZERO).expect("there");
        let written = put.bench().written.force;
        let expected = along * (-k * y - b * speed);
        prop_assert!((written - expected).length() < 1e-9, "{written} {expected}");
        // The hand's force in the axes of the desk is as large.
        prop_assert!((placed.on_hand(force).length() - written.length()).abs() < 1e-9);
    }

    /// However a hand goes and whatever it presses, the desk's place never jumps by more than the hand
    /// goes, and stands still under the clutch.
    #[test]
    fn a_clutched_hand_never_jumps(
        scale in 0.5..4.0f64,
        moves in prop::collection::vec((prop::array::uniform3(-0.02..0.02f64), 0u32..2), 1..100),
    ) {
        let put = Put::new();
        let to_desk = registration(Rigid::IDENTITY, scale, DVec3::ZERO);
        let mut placed = MountedDevice::new(Box::new(put.clone()), to_desk, CLUTCH);
        let mut device = DVec3::ZERO;
        let mut last = read(&mut placed);
        for (by, switches) in moves {
            device += DVec3::from_array(by);
            put.put(device, switches);
            let reading = read(&mut placed);
            let went = (reading.handle.position - last.handle.position).length();
            let most = scale * DVec3::from_array(by).length();
            let released = last.switches & CLUTCH != 0;
            if reading.switches & CLUTCH != 0 {
                prop_assert!(!reading.in_range && !reading.is_permitted);
                prop_assert_eq!(reading.handle.velocity, DVec3::ZERO);
                prop_assert!(!released || went == 0.0, "{} while held", went);
            } else {
                prop_assert!(reading.in_range && reading.is_permitted);
            }
            prop_assert!(went <= if released { 1e-12 } else { most + 1e-12 }, "{} of {}", went, most);
            last = reading;
        }
    }
}

#[test]
fn the_brush_turns_with_the_hand_while_the_clutch_holds_its_place() {
    let put = Put::new();
    let lever = DVec3::new(0.0, 0.0, -0.05);
    let to_desk = registration(Rigid::IDENTITY, 1.0, lever);
    let mut placed = MountedDevice::new(Box::new(put.clone()), to_desk, CLUTCH);
    put.put(DVec3::new(0.01, 0.02, 0.08), 0);
    let before = read(&mut placed).handle;
    put.put(DVec3::new(0.05, 0.0, 0.03), CLUTCH);
    // The tick in which it is pressed is already of the clutch.
    let turned = rotation(DVec3::X, 0.5);
    put.bench().reading.handle.orientation = turned;
    let handle = read(&mut placed).handle;
    assert!(handle.orientation.angle_between(turned) < 1e-9);
    let aside = handle.position;
    put.put(DVec3::new(-0.05, 0.04, 0.01), CLUTCH);
    assert_eq!(read(&mut placed).handle.position, aside);
    put.put(DVec3::new(-0.05, 0.04, 0.01), 0);
    assert!((read(&mut placed).handle.position - aside).length() < 1e-15);
    put.put(DVec3::new(-0.05, 0.05, 0.01), 0);
    let after = read(&mut placed).handle.position;
    assert!(
        (after - aside - DVec3::Y * 0.01).length() < 1e-15,
        "{after} {before:?}"
    );
}

/// A hand with the working area of an Omni, which wants to have its ferrule at a place of the desk: it
/// clutches back to the middle where it can go no farther. How often it did, and how near it came, m.
fn reach(placed: &mut MountedDevice, put: &Put, goal: DVec3, clutch: u32) -> (u32, f64) {
    let most = DVec3::new(0.08, 0.06, 0.035);
    let mut clutched = 0;
    let mut device = put.bench().reading.handle.position;
    for _ in 0..10_000 {
        let here = read(placed).handle.position;
        let left = goal - here;
        if left.length() < 1e-4 {
            return (clutched, left.length());
        }
        let next = (device + left.clamp_length_max(5e-4)).clamp(-most, most);
        if next.distance(device) < 1e-6 {
            clutched += 1;
            put.put(device, clutch);
            read(placed);
            device = DVec3::ZERO;
            put.put(device, clutch);
            read(placed);
            put.put(device, 0);
            continue;
        }
        device = next;
        put.put(device, 0);
    }
    (clutched, (goal - read(placed).handle.position).length())
}

#[test]
fn a_phantom_reaches_every_place_of_a_canvas_that_is_larger_by_clutching() {
    let size = canvas_m(&CanvasSection::default());
    let to_desk = registration(Rigid::IDENTITY, 1.0, DVec3::ZERO);
    let (mut clutched, mut out_of_reach) = (0, 0);
    let put = Put::new();
    let mut placed = MountedDevice::new(Box::new(put.clone()), to_desk, CLUTCH);
    for i in 0..=4 {
        for j in 0..=4 {
            let goal = DVec3::new(
                size.x * (0.25 * f64::from(i) - 0.5),
                size.y * (0.25 * f64::from(j) - 0.5),
                0.025,
            );
            let (often, off_m) = reach(&mut placed, &put, goal, CLUTCH);
            assert!(off_m < 1e-4, "{goal}: {off_m} m");
            clutched += often;
            // The seeded fault: without the clutch it does not come to the edges.
            let put = Put::new();
            let mut bound = MountedDevice::new(Box::new(put.clone()), to_desk, 0);
            out_of_reach += u32::from(reach(&mut bound, &put, goal, CLUTCH).1 > 1e-3);
        }
    }
    assert!(
        clutched > 10 && out_of_reach == 22,
        "{clutched} {out_of_reach}"
    );
}

#[test]
fn the_ferrule_is_where_it_is_held_and_as_fast() {
    // A quarter turn about x takes −z to y; the point turns by 2 rad/s about x.
    let put = Put::new();
    let lever = DVec3::new(0.0, 0.0, -0.05);
    let to_desk = registration(Rigid::IDENTITY, 2.0, lever);
    let mut placed = MountedDevice::new(Box::new(put.clone()), to_desk, 0);
    let mut last = None;
    for tick in 0..200 {
        let angle = FRAC_PI_2 + 2.0 * 1e-3 * f64::from(tick - 199);
        put.bench().reading.handle.orientation = rotation(DVec3::X, angle);
        last = Some(read(&mut placed).handle);
    }
    let handle = last.expect("read");
    let expected = DVec3::new(0.0, 0.1, 0.0);
    assert!(
        (handle.position - expected).length() < 1e-12,
        "{}",
        handle.position
    );
    // ω × r = 2·x × .05·y = .1·z, twice as fast on the desk; a filter of 60 Hz lags by 2.7 ms.
    let expected = DVec3::new(0.0, 0.0, 0.2);
    assert!(
        (handle.velocity - expected).length() < 0.005,
        "{}",
        handle.velocity
    );
}

#[test]
fn a_force_at_the_ferrule_turns_the_hand_as_far_as_the_device_can() {
    let put = Put::new();
    put.bench().max_torque_nm = 0.1;
    let to_desk = registration(Rigid::IDENTITY, 2.0, DVec3::new(0.0, 0.0, -0.05));
    let mut placed = MountedDevice::new(Box::new(put.clone()), to_desk, 0);
    read(&mut placed);
    placed.write(DVec3::X * 2.0, DVec3::ZERO).expect("there");
    let written = put.bench().written;
    // r × F = −.05·z × 1·x = −.05·y.
    assert!((written.force - DVec3::X).length() < 1e-15);
    assert!((written.torque + DVec3::Y * 0.05).length() < 1e-15);
    // The brush's own is a quarter as large in the hand: force and lever are halves.
    placed
        .write(DVec3::X * 2.0, DVec3::new(0.1, 0.0, 0.04))
        .expect("there");
    let torque = put.bench().written.torque;
    let expected = DVec3::new(0.025, -0.05, 0.01);
    assert!((torque - expected).length() < 1e-15, "{torque}");
    placed.write(DVec3::X * 6.0, DVec3::ZERO).expect("there");
    let torque = put.bench().written.torque;
    assert!((torque + DVec3::Y * 0.1).length() < 1e-12, "{torque}");
    // One that drives none is asked for none, and so is one that says nonsense.
    for none in [0.0, -1.0, f64::NAN] {
        put.bench().max_torque_nm = none;
        let mut placed = MountedDevice::new(Box::new(put.clone()), to_desk, 0);
        read(&mut placed);
        placed.write(DVec3::X * 6.0, DVec3::Z).expect("there");
        assert_eq!(put.bench().written.torque, DVec3::ZERO);
    }
}
