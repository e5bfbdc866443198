//! A headset's controller: the driver as it is, over an OpenXR loader and runtime of our own.

use std::path::PathBuf;

use glam::{DQuat, DVec3};
use maulstick_haptic::device::driver::{DeviceError, Driver, Opened, Reading, Wrench};
use maulstick_haptic::drivers::openxr::{open, runtime};
use maulstick_haptic::drivers::vendor_library::allow_library;
use maulstick_libopenxr::{Call, Control, Script};
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_scripted::Script as _;

/// The middle of the canvas, from the headset, m.
const CANVAS: DVec3 = DVec3::new(0.0, -0.25, -0.45);
const RIGHT: &str = "/user/hand/right";

/// A library that lies in no folder of the system.
fn trusted(path: PathBuf) -> PathBuf {
    allow_library(&path);
    path
}

fn section(address: Option<&str>) -> DeviceSection {
    DeviceSection {
        library: Some(trusted(Script::path().expect("a path"))),
        address: address.map(str::to_owned),
        ..DeviceSection::new("hand", "openxr", "main")
    }
}

fn opened(script: &Script) -> (Control, Opened) {
    let control = Control::play(script).expect("the fake");
    let opened = open(&section(None)).expect("a controller");
    (control, opened)
}

fn refusal(script: &Script) -> UserError {
    let _control = Control::play(script).expect("the fake");
    open(&section(None)).err().expect("refused")
}

/// A reading a few ticks later, when what is pressed has been looked at again.
fn later(driver: &mut dyn Driver) -> Reading {
    let mut read = || driver.read(1e-3).expect("read").expect("new");
    for _ in 0..7 {
        read();
    }
    read()
}

/// A controller of the right hand with a part pulled or pressed.
fn with(part: &str, how_far: f32) -> Script {
    let mut script = Script {
        position: [0.1, -0.2, -0.5],
        // A quarter turn about y: it points to the left.
        orientation: [
            0.0,
            std::f32::consts::FRAC_1_SQRT_2,
            0.0,
            std::f32::consts::FRAC_1_SQRT_2,
        ],
        ..Script::default()
    };
    script.inputs.insert(format!("{RIGHT}/{part}"), how_far);
    script
}

#[test]
fn a_controller_is_where_it_is_before_the_canvas_and_points_where_it_points() {
    let (_control, mut opened) = opened(&with("input/trigger/value", 0.0));
    assert_eq!(opened.what, "the right controller of Scripted");
    let reading = later(&mut *opened.driver);
    let place = DVec3::new(0.1, -0.2, -0.5) - CANVAS;
    assert!(
        reading.handle.position.abs_diff_eq(place, 1e-6),
        "{:?}",
        reading.handle
    );
    let forward = reading.handle.orientation * -DVec3::Z;
    assert!(forward.abs_diff_eq(-DVec3::X, 1e-6), "{forward}");
    assert!(reading.in_range && reading.is_permitted && reading.switches == 0);
}

#[test]
fn the_trigger_pushes_the_brush_along_its_bristles() {
    let (control, mut opened) = opened(&with("input/trigger/value", 0.0));
    let free = later(&mut *opened.driver).handle.position;
    for (pulled, millimetres) in [
        (0.5, 10.0),
        (1.0, 20.0),
        (7.0, 20.0),
        (-3.0, 0.0),
        (f32::NAN, 0.0),
    ] {
        control.change(&with("input/trigger/value", pulled)).ok();
        let pushed = later(&mut *opened.driver).handle.position - free;
        // JSON has no such number: that script is not taken, and the one before goes on.
        let expected = if pulled.is_nan() { 0.0 } else { millimetres };
        assert!(
            pushed.abs_diff_eq(DVec3::NEG_X * expected * 1e-3, 1e-6),
            "{pulled}: {pushed}"
        );
    }
}

#[test]
fn squeezing_is_the_first_switch_and_the_first_button_the_second() {
    for (part, bit) in [
        ("input/squeeze/value", 1),
        ("input/a/click", 2),
        ("input/b/click", 0),
    ] {
        let (_control, mut opened) = opened(&with(part, 1.0));
        assert_eq!(later(&mut *opened.driver).switches, bit, "{part}");
    }
    let simple = Script {
        profile: "/interaction_profiles/khr/simple_controller".into(),
        ..with("input/menu/click", 1.0)
    };
    let (_control, mut opened) = opened(&simple);
    assert_eq!(later(&mut *opened.driver).switches, 1);
}

#[test]
fn force_is_felt_as_a_vibration_that_ends_with_it_and_with_the_session() {
    let (control, mut opened) = opened(&Script::default());
    later(&mut *opened.driver);
    let press = |driver: &mut dyn Driver, newtons: f64| {
        let force = DVec3::Z * newtons;
        for _ in 0..64 {
            driver.read(1e-3).expect("read");
            driver
                .write(Wrench {
                    force,
                    torque: DVec3::ZERO,
                })
                .expect("written");
        }
    };
    press(&mut *opened.driver, 1.0);
    let felt = control.calls().expect("a log");
    let motor = format!("{RIGHT}/output/haptic");
    assert_eq!(felt.first(), Some(&Call::Begin));
    assert_eq!(felt.len(), 5, "once in 16 ms: {felt:?}");
    let Call::Vibrate(path, amplitude, ns) = &felt[1] else {
        unreachable!("{felt:?}");
    };
    assert!(
        *path == motor && *amplitude > 0.3 && *ns >= 16_000_000,
        "{felt:?}"
    );
    press(&mut *opened.driver, 0.0);
    assert_eq!(control.calls().expect("a log"), [Call::Stop(motor.clone())]);
    press(&mut *opened.driver, 9.0);
    control.calls().expect("a log");
    drop(opened);
    let end = [
        Call::Stop(motor),
        Call::DestroySession,
        Call::DestroyInstance,
    ];
    assert_eq!(control.calls().expect("a log"), end);
}

#[test]
fn one_that_is_lost_from_sight_or_switched_off_is_out_of_range_and_gives_no_force() {
    let seen = later(&mut *opened(&Script::default()).1.driver);
    assert!(seen.in_range);
    for away in [
        // Valid, but no longer tracked; nothing known; not a rotation; not a number would be refused by JSON.
        Script {
            known: 0b0011,
            ..Script::default()
        },
        Script {
            known: 0,
            ..Script::default()
        },
        Script {
            orientation: [0.0; 4],
            ..Script::default()
        },
        Script {
            profile: "/interaction_profiles/valve/index_controller".into(),
            ..Script::default()
        },
        // It is shown, but another program has the hands; it has not begun.
        Script {
            states: vec![1],
            ..Script::default()
        },
    ] {
        let (_control, mut opened) = opened(&away);
        let reading = later(&mut *opened.driver);
        assert!(!reading.in_range && !reading.is_permitted, "{away:?}");
        assert_eq!(reading.handle.orientation, DQuat::IDENTITY);
    }
}

#[test]
fn a_session_that_ends_is_a_lost_device_and_one_that_stops_may_begin_again() {
    let (control, mut opened) = opened(&Script::default());
    later(&mut *opened.driver);
    let goes = |states: &[i32]| Script {
        states: states.to_vec(),
        ..Script::default()
    };
    control.change(&goes(&[6])).expect("changed");
    assert!(!later(&mut *opened.driver).in_range, "stopping");
    control.change(&goes(&[1, 2, 5])).expect("changed");
    assert!(later(&mut *opened.driver).in_range, "ready again");
    control.change(&goes(&[8])).expect("changed");
    let mut readings = (0..8).map(|_| opened.driver.read(1e-3));
    assert!(
        readings.any(|reading| reading == Err(runtime::LOST)),
        "exiting"
    );
    drop((opened, control));

    let (control, mut opened) = self::opened(&Script::default());
    later(&mut *opened.driver);
    control
        .change(&Script {
            place_code: -17,
            states: Vec::new(),
            ..Script::default()
        })
        .expect("changed");
    let error = opened.driver.read(1e-3).expect_err("a lost session");
    assert_eq!((error.what, error.code), (runtime::LOST.what, 17));
    let odd = Script {
        place_code: -1,
        states: Vec::new(),
        ..Script::default()
    };
    control.change(&odd).expect("changed");
    let error = opened.driver.read(1e-3).expect_err("a refused call");
    assert_eq!(
        error,
        DeviceError {
            code: 1,
            ..runtime::REFUSED
        }
    );
}

#[test]
fn refuses_a_runtime_without_what_it_needs() {
    let needed = ["XR_MND_headless", "XR_KHR_convert_timespec_time"];
    for (place, lacking) in needed.into_iter().enumerate() {
        let script = Script {
            extensions: vec![needed[1 - place].into()],
            ..Script::default()
        };
        assert!(refusal(&script).what.contains(lacking), "{lacking}");
    }
    for (code, script) in [
        (
            -51,
            Script {
                instance_code: -51,
                ..Script::default()
            },
        ),
        (
            -35,
            Script {
                system_code: -35,
                ..Script::default()
            },
        ),
        (
            -10,
            Script {
                session_code: -10,
                ..Script::default()
            },
        ),
        (
            -1,
            Script {
                session_code: -1,
                ..Script::default()
            },
        ),
    ] {
        let code = openxr::sys::Result::from_raw(code);
        assert_eq!(refusal(&script), runtime::refused(code), "{code}");
    }
}

#[test]
fn refuses_other_hands_and_libraries() {
    let other = open(&section(Some("both"))).err().expect("refused");
    assert!(other.what.contains("'both'"), "{other}");
    let wrong = DeviceSection {
        library: Some(trusted(maulstick_libhd::control::path().expect("a path"))),
        ..section(None)
    };
    let fault = open(&wrong).err().expect("refused");
    assert_eq!(fault.help.as_deref(), Some(runtime::LOADER.correct));
}
