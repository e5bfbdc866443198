//! Force Dimension's arms: the driver as it is, over a libdhd of our own.

use std::path::PathBuf;

use glam::DVec3;
use maulstick_haptic::device::driver::{Opened, Wrench};
use maulstick_haptic::drivers::force_dimension::library::{DHD, OpenError};
use maulstick_haptic::drivers::force_dimension::{library, open};
use maulstick_haptic::drivers::vendor_library::allow_library;
use maulstick_haptics::Switch;
use maulstick_libdhd::{Call, Control, Script};
use maulstick_num::geometry::rotation;
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_scripted::Script as _;
use maulstick_types::stylus::axes;

/// A library that lies in no folder of the system.
fn trusted(path: PathBuf) -> PathBuf {
    allow_library(&path);
    path
}

fn section(address: Option<&str>) -> DeviceSection {
    DeviceSection {
        library: Some(trusted(Script::path().expect("a path"))),
        address: address.map(str::to_owned),
        ..DeviceSection::new("arm", "forcedimension", "main")
    }
}

fn opened(script: &Script) -> (Control, Opened) {
    let control = Control::play(script).expect("the fake");
    let opened = open(&section(None)).expect("a device");
    (control, opened)
}

fn refusal(script: &Script, address: Option<&str>) -> UserError {
    let _control = Control::play(script).expect("the fake");
    open(&section(address)).err().expect("refused")
}

#[test]
fn a_handle_is_read_in_our_axes() {
    let script = Script {
        position: [0.01, 0.02, 0.03],
        velocity: [0.1, 0.2, 0.3],
        // A quarter turn about their upright axis, by rows.
        frame: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        buttons: 5,
        ..Script::default()
    };
    let (_control, mut opened) = opened(&script);
    assert_eq!(opened.what, "omega.6, libdhd 3.16.1.0");
    let reading = opened.driver.read(1e-3).expect("read").expect("new");
    assert_eq!(reading.handle.position, DVec3::new(0.02, 0.03, 0.01));
    assert_eq!(reading.handle.velocity, DVec3::new(0.2, 0.3, 0.1));
    let quarter = rotation(DVec3::Y, std::f64::consts::FRAC_PI_2);
    assert!(reading.handle.orientation.abs_diff_eq(quarter, 1e-12));
    assert_eq!(reading.switches, 5);
    let abilities = opened.driver.abilities();
    assert!(abilities.senses & axes::ORIENTATION != 0 && abilities.max_force_n == 12.0);
}

#[test]
fn force_goes_out_in_their_axes_and_ends_however_it_ends() {
    let (control, mut opened) = opened(&Script::default());
    let start = control.calls().expect("a log");
    let zero = Call::Force([0.0; 3]);
    assert_eq!(start, [Call::Open(0), zero.clone(), Call::Enable(true)]);
    let wrench = Wrench {
        force: DVec3::new(1.0, 2.0, 3.0),
        torque: DVec3::ONE,
    };
    opened.driver.write(wrench).expect("written");
    opened.driver.switch(Switch::Off);
    opened.driver.switch(Switch::Off);
    opened.driver.switch(Switch::On);
    drop(opened);
    let then = [
        Call::Force([3.0, 1.0, 2.0]),
        Call::Enable(false),
        Call::Enable(true),
        zero,
        Call::Enable(false),
        Call::Close(0),
    ];
    assert_eq!(control.calls().expect("a log"), then);
}

#[test]
fn motors_that_give_no_more_are_no_fault_and_a_device_that_is_gone_is() {
    let saturated = Script {
        force_code: 2,
        ..Script::default()
    };
    let (control, mut opened) = opened(&saturated);
    opened.driver.write(Wrench::ZERO).expect("saturated motors");
    let gone = Script {
        pose_code: -1,
        force_code: -1,
        ..Script::default()
    };
    control.change(&gone).expect("changed");
    assert_eq!(opened.driver.read(1e-3), Err(library::LOST));
    assert_eq!(opened.driver.write(Wrench::ZERO), Err(library::LOST));
}

#[test]
fn nothing_new_is_waited_for_and_not_for_ever() {
    let silent = Script {
        pose_code: 1,
        ..Script::default()
    };
    let (_control, mut opened) = opened(&silent);
    let mut readings = (0..1000).map(|_| opened.driver.read(1e-3));
    assert_eq!(readings.next(), Some(Ok(None)));
    assert!(readings.any(|reading| reading == Err(library::SILENT)));
}

#[test]
fn an_arm_without_a_wrist_senses_no_turn() {
    let script = Script {
        has_wrist: false,
        system_type: 33,
        ..Script::default()
    };
    let (_control, opened) = opened(&script);
    assert_eq!(opened.driver.abilities().senses & axes::ORIENTATION, 0);
}

#[test]
fn of_several_the_meant_one_is_opened_and_the_others_are_let_go() {
    let script = Script {
        serials: vec![3, 5],
        ..Script::default()
    };
    let control = Control::play(&script).expect("the fake");
    let arm = open(&section(Some("5"))).expect("the second");
    let calls = control.calls().expect("a log");
    assert_eq!(calls[..3], [Call::Open(0), Call::Close(0), Call::Open(1)]);
    drop((arm, control));
    let other = OpenError::Serial(9, vec![3, 5]);
    assert_eq!(refusal(&script, Some("9")), other.into());
    let word = OpenError::Address("x".to_owned());
    assert_eq!(refusal(&script, Some("x")), word.into());
    let none = Script {
        serials: Vec::new(),
        ..Script::default()
    };
    assert_eq!(refusal(&none, None), OpenError::Absent.into());
    let held = Script {
        is_held: true,
        ..Script::default()
    };
    let closed = OpenError::Closed("device is in use".to_owned());
    assert_eq!(refusal(&held, None), closed.into());
}

#[test]
fn another_library_is_told_apart() {
    let wrong = DeviceSection {
        library: Some(trusted(maulstick_libhd::control::path().expect("a path"))),
        ..section(None)
    };
    let fault = open(&wrong).err().expect("refused");
    assert_eq!(fault.help.as_deref(), Some(DHD.correct));
    let missing = DeviceSection {
        library: Some("/nowhere/libdhd.so".into()),
        ..section(None)
    };
    let fault = open(&missing).err().expect("refused");
    assert_eq!(fault.place.as_deref(), Some("/nowhere/libdhd.so"));
}
