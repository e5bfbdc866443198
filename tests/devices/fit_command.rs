//! `maulstick device fit`: a simulated hand shows the corners of the canvas, and the device fits it then.

#[path = "../support/mod.rs"]
mod support;

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Stdio};

use glam::{DQuat, DVec3};
use maulstick_device::registration::{Registration, Similarity};
use maulstick_device::{Take, TakeSample};
use maulstick_num::geometry::{Rigid, canonical, rotation};
use maulstick_rig::RigConfig;
use maulstick_types::stylus::{StylusPose, StylusSample, axes};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

use crate::support::{PATIENCE, Place, fault, has, wait_for};

/// Corners of the canvas of the default settings, m.
const CORNERS: [[f64; 2]; 3] = [[-0.128, -0.128], [0.128, -0.128], [-0.128, 0.128]];

/// Where the device of the tests stands: turned, moved, half as large as the desk.
fn stand() -> Similarity {
    Similarity {
        rigid: Rigid {
            rotation: canonical(rotation(DVec3::new(0.6, 0.0, 0.8), 1.0)),
            translation: DVec3::new(0.05, -0.02, 0.03),
        },
        scale: 2.0,
    }
}

/// A take in which a hand goes to places of the desk and stays at each for five seconds, of which one without a
/// stall is enough.
fn showing(places: &[[f64; 2]]) -> Take {
    let mut samples = Vec::new();
    let mut sample = |place: DVec3| {
        let pose = Rigid {
            rotation: DQuat::IDENTITY,
            translation: place,
        };
        samples.push(TakeSample {
            time_ns: samples.len() as u64 * 4_000_000,
            sample: StylusSample {
                senses: axes::POSITION | axes::ORIENTATION,
                pose: StylusPose::Ferrule {
                    pose: pose.to_pose(),
                },
                in_range: true,
                ..StylusSample::away()
            },
        });
    };
    let mut at = DVec3::Z * 0.1;
    for place in places {
        let to = DVec3::new(place[0], place[1], 0.0);
        (0..150).for_each(|i| sample(at.lerp(to, f64::from(i) / 150.0)));
        (0..1250).for_each(|_| sample(to));
        at = to;
    }
    Take {
        setup: None,
        device: "hand".into(),
        samples,
    }
}

/// Settings with a simulated hand that shows places.
fn settings(place: &Place, places: &[[f64; 2]]) -> String {
    showing(places)
        .write(&place.path("corners.mcap"))
        .expect("written");
    let text = place.done(&["up", "--print-config"]).stdout;
    let text = String::from_utf8(text).expect("UTF-8");
    let stand = stand();
    let at = stand.rigid.translation;
    let turn = stand.rigid.rotation;
    let text = text
        .replace(
            "position_m = [0, 0, 0] ",
            &format!("position_m = [{}, {}, {}] # by a ruler", at.x, at.y, at.z),
        )
        .replace(
            "orientation = [0, 0, 0, 1]",
            &format!(
                "orientation = [{}, {}, {}, {}]\nscale = 2.0\nferrule_m = [0, 0, -0.02]\nhand = \"corners.mcap\"",
                turn.x, turn.y, turn.z, turn.w
            ),
        );
    std::fs::write(place.path("rig.toml"), &text).expect("written");
    text
}

const FIT: [&str; 5] = ["device", "fit", "phantom", "--rig", "rig.toml"];

#[test]
fn a_hand_that_shows_three_corners_fits_its_device_to_the_canvas() {
    let place = Place::new();
    let before = settings(&place, &CORNERS);
    let said = String::from_utf8(place.done(&FIT).stdout).expect("UTF-8");
    has(
        &said,
        &[
            "touch the lower left corner",
            "lower left: ",
            "touch the upper left corner",
            "the ratio of width to height is",
            "written into rig.toml",
        ],
    );
    let after = String::from_utf8(place.bytes("rig.toml")).expect("UTF-8");
    let changed: Vec<&str> = after
        .lines()
        .filter(|line| !before.lines().any(|other| other == *line))
        .collect();
    assert!(
        changed.len() == 1 && changed[0].starts_with("corners_m = "),
        "{changed:?}"
    );
    assert_eq!(after.lines().count(), before.lines().count() + 1);
    let config = RigConfig::read(&place.path("rig.toml")).expect("valid");
    let registration = Registration::of(&config.device[0], &config.canvas).expect("fits");
    assert_eq!(registration.warning(), None);
    // Friction and the steps of the encoders hold a hand .3 mm from where it wants to be.
    for corner in CORNERS {
        let on_desk = DVec3::new(corner[0], corner[1], 0.0);
        let off = registration.to_desk.point(stand().point_back(on_desk)) - on_desk;
        assert!(off.length() < 2e-3, "{off}: {after}");
    }
    assert!(
        (registration.to_desk.scale - 2.0).abs() < 0.02,
        "{registration:?}"
    );
}

#[test]
fn places_that_are_no_corners_of_the_canvas_are_refused() {
    let place = Place::new();
    let before = settings(&place, &[CORNERS[0], [0.128, -0.128], [-0.128, 0.05]]);
    let said = fault(&place, &FIT, 1);
    has(&said, &["no corners of the canvas", "help: "]);
    assert_eq!(place.bytes("rig.toml"), before.into_bytes());
}

/// Waits for a process that is to end.
fn end(child: &mut Child) -> Option<i32> {
    let ended = wait_for(PATIENCE, || child.try_wait().expect("watched"));
    if ended.is_none() {
        child.kill().ok();
    }
    ended?.code()
}

#[test]
fn ctrl_c_leaves_the_settings_as_they_are() {
    let place = Place::new();
    // It shows one corner and goes.
    let before = settings(&place, &CORNERS[..1]);
    let mut command = place.maulstick(&FIT);
    let mut child = command.stdout(Stdio::piped()).spawn().expect("started");
    let out = BufReader::new(child.stdout.take().expect("piped"));
    let asked = out.lines().map_while(Result::ok);
    let second = asked.into_iter().find(|line| line.contains("lower right"));
    assert!(second.is_some());
    kill(Pid::from_raw(child.id() as i32), Signal::SIGINT).expect("sent");
    assert_eq!(end(&mut child), Some(130));
    assert_eq!(place.bytes("rig.toml"), before.into_bytes());
}

#[test]
fn what_cannot_be_fitted_says_what_to_do() {
    let place = Place::new();
    let text = settings(&place, &CORNERS);
    has(
        &fault(&place, &["device", "fit", "phantom"], 2),
        &["'phantom'", "maulstick device add"],
    );
    has(
        &fault(&place, &["device", "fit", "phantm", "--rig", "rig.toml"], 2),
        &["no [[device]] called 'phantm'", "rig.toml", "'phantom'"],
    );
    let mouse = text.replace("driver = \"simulated\"", "driver = \"spacemouse\"");
    let mouse = mouse.replace("hand = \"corners.mcap\"", "");
    std::fs::write(place.path("mouse.toml"), mouse).expect("written");
    has(
        &fault(
            &place,
            &["device", "fit", "phantom", "--rig", "mouse.toml"],
            2,
        ),
        &["'phantom' moves the canvas itself"],
    );
}
