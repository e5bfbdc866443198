//! Messages of the service, right and wrong, and the axes that they are in.

use glam::{DQuat, DVec3};
use maulstick_haptic::drivers::inverse3::axes::Basis;
use maulstick_haptic::drivers::inverse3::message::{Dialect, Hindrance, Update, request};
use maulstick_haptic::drivers::inverse3::state::{
    AWAY_NS, DeviceTracker, FARTHEST_M, FASTEST_M_S, LET_GO_NS, Pose, Seen,
};
use maulstick_num::geometry::rotation;
use proptest::prelude::*;
use serde_json::{Value, json};

use super::service::{inventory, old_inventory, state, update};

fn read(value: &Value) -> Update {
    Update::read(value.to_string().as_bytes()).expect("a message")
}

fn pose(seen: Seen) -> Pose {
    match seen {
        Seen::Pose(pose) => Some(pose),
        _ => None,
    }
    .expect("a pose")
}

#[test]
fn the_services_first_message_is_read_in_the_device_frame() {
    let message = read(&inventory());
    assert_eq!(message.dialect(), Dialect::Vector);
    let pose = pose(DeviceTracker::new("049D", None).take(&message, 0));
    // x right, y forward, z up to x right, y up, z toward the user.
    assert_eq!(pose.position, DVec3::new(0.01, 0.15, 0.12));
    assert_eq!(pose.velocity, Some(DVec3::new(0.1, 0.3, -0.2)));
    assert_eq!((pose.orientation, pose.switches), (DQuat::IDENTITY, 0b101));
}

#[test]
fn what_services_before_3_5_say_is_read_as_well() {
    let message = read(&old_inventory());
    assert_eq!(message.dialect(), Dialect::Values);
    let pose = pose(DeviceTracker::new("04BA", None).take(&message, 0));
    assert_eq!(
        pose.position,
        DVec3::new(0.07842738, 0.14297646, 0.14836666)
    );
    assert_eq!(pose.switches, 1);
    assert!((pose.orientation.length() - 1.0).abs() < 1e-12);
}

#[test]
fn what_we_ask_is_what_the_service_documents() {
    let force = DVec3::new(0.0, -1.5, 2.0);
    let asked = |dialect| request("049D", force, dialect).expect("a message");
    assert_eq!(
        asked(Dialect::Vector),
        r#"{"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":{"x":0.0,"y":-1.5,"z":2.0}}}}]}"#
    );
    assert_eq!(
        asked(Dialect::Values),
        r#"{"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"values":{"x":0.0,"y":-1.5,"z":2.0}}}}]}"#
    );
}

#[test]
fn what_a_state_leaves_out_is_as_it_was() {
    let mut tracker = DeviceTracker::new("049D", None);
    tracker.take(&read(&inventory()), 0);
    let partly = json!({ "inverse3": [{
        "device_id": "049D", "state": { "cursor_position": { "y": -0.2 } }
    }], "wireless_verse_grip": null });
    let pose = pose(tracker.take(&read(&partly), 0));
    assert_eq!(pose.position, DVec3::new(0.01, 0.15, 0.2));
    assert_eq!(
        (pose.velocity, pose.switches),
        (Some(DVec3::new(0.1, 0.3, -0.2)), 0b101)
    );
    // Where nothing was before, a part is no place.
    let seen = DeviceTracker::new("049D", None).take(&read(&partly), 0);
    assert_eq!(seen, Seen::Nothing);
    let silent = json!({ "inverse3": [{ "device_id": "049D" }], "session": {} });
    assert_eq!(tracker.take(&read(&silent), 0), Seen::Nothing);
    assert_eq!(tracker.take(&read(&json!({})), 0), Seen::Nothing);
}

#[test]
fn numbers_that_no_device_sends_make_no_pose() {
    for metres in [1.001, -30.0, 1e300] {
        let mut wrong = state();
        wrong["cursor_position"]["z"] = json!(metres);
        let mut tracker = DeviceTracker::new("049D", None);
        tracker.take(&read(&inventory()), 0);
        assert_eq!(
            tracker.take(&read(&update("049D", wrong)), 0),
            Seen::Nowhere
        );
    }
    let mut fast = state();
    fast["cursor_velocity"]["x"] = json!(1e9);
    let pose = pose(DeviceTracker::new("049D", None).take(&read(&update("049D", fast)), 0));
    assert_eq!(pose.velocity, None);
    let mut message = inventory();
    message["wireless_verse_grip"][0]["state"]["orientation"]["w"] = json!(1e200);
    let handle = self::pose(DeviceTracker::new("049D", None).take(&read(&message), 0));
    assert_eq!(handle.orientation, DQuat::IDENTITY);
    for text in [
        r#"{"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":1e999}}}]}"#,
        r#"{"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":NaN}}}]}"#,
        r#"{"inverse3":7}"#,
        "",
        "[",
        "null",
        "\u{0}",
    ] {
        assert!(Update::read(text.as_bytes()).is_err(), "{text}");
    }
}

#[test]
fn what_hinders_a_device_is_told_most_important_first() {
    for (key, hindrance) in [
        ("power_supply", Hindrance::NoPower),
        ("calibrated", Hindrance::NotCalibrated),
        ("ready", Hindrance::NotReady),
    ] {
        let mut message = inventory();
        message["inverse3"][0]["status"][key] = json!(false);
        let mut tracker = DeviceTracker::new("049D", None);
        assert_eq!(tracker.take(&read(&message), 0), Seen::Hindered(hindrance));
        message["inverse3"][0]["status"] = json!(null);
        assert!(matches!(tracker.take(&read(&message), 0), Seen::Pose(_)));
    }
    let mut message = inventory();
    message["inverse3"][0]["status"] = json!({ "calibrated": false, "power_supply": false });
    let seen = DeviceTracker::new("049D", None).take(&read(&message), 0);
    assert_eq!(seen, Seen::Hindered(Hindrance::NoPower));
}

#[test]
fn a_grip_is_followed_by_its_id() {
    let mut message = inventory();
    message["verse_grip"] = json!([{
        "device_id": "12", "state": { "button": true, "orientation": { "x": 1.0, "y": 0, "z": 0, "w": 0 } }
    }]);
    let switches = |grip| pose(DeviceTracker::new("049D", grip).take(&read(&message), 0)).switches;
    assert_eq!(
        (
            switches(None),
            switches(Some("61548")),
            switches(Some("12"))
        ),
        (0b101, 0b101, 0b1)
    );
    assert_eq!(switches(Some("13")), 0);
}

#[test]
fn a_hand_does_not_change_its_grip_where_the_list_does() {
    let grip = |id: &str, pressed: bool| json!({ "device_id": id, "state": { "button": pressed } });
    let (mut message, mut tracker) = (inventory(), DeviceTracker::new("049D", None));
    message["wireless_verse_grip"] = json!(null);
    for grips in [
        [grip("11", true), grip("12", false)],
        [grip("12", false), grip("11", true)],
    ] {
        message["verse_grip"] = json!(grips);
        assert_eq!(pose(tracker.take(&read(&message), 0)).switches, 1);
    }
}

#[test]
fn a_grip_that_goes_away_lets_its_buttons_go_and_then_is_out_of_range() {
    let mut tracker = DeviceTracker::new("049D", None);
    let mut silent = inventory();
    silent["wireless_verse_grip"] = json!([]);
    let mut after = |message: &Value, ns| {
        let pose = pose(tracker.take(&read(message), ns));
        (pose.switches, pose.in_range)
    };
    assert_eq!(after(&inventory(), 0), (0b101, true));
    assert_eq!(after(&silent, LET_GO_NS - 1), (0b101, true));
    assert_eq!(after(&silent, LET_GO_NS), (0, true));
    assert_eq!(after(&silent, AWAY_NS), (0, false));
    assert_eq!(after(&inventory(), AWAY_NS), (0b101, true));
    // A device that never had one is there all the same.
    let alone = DeviceTracker::new("049D", None).take(&read(&silent), u64::MAX);
    assert!(pose(alone).in_range);
}

#[test]
fn axes_that_cannot_be_read_are_not_taken_for_others() {
    let mut message = inventory();
    message["inverse3"][0]["config"]["basis"]["permutation"] = json!("XQZ");
    let seen = DeviceTracker::new("049D", None).take(&read(&message), 0);
    assert_eq!(seen, Seen::Hindered(Hindrance::UnknownAxes));
}

#[test]
fn a_grip_that_points_forward_holds_the_bristles_away_from_the_user() {
    // A grip points along its own +y, forward in Haply's frame: away from the user.
    let basis = Basis::HAPLY;
    let ahead = basis.orientation(DQuat::IDENTITY) * DVec3::NEG_Z;
    assert_eq!(ahead, basis.to_device(DVec3::Y));
    // Turned about z, which is up, by a quarter it points left.
    let left = basis.orientation(rotation(DVec3::Z, std::f64::consts::FRAC_PI_2));
    assert!((left * DVec3::NEG_Z - DVec3::NEG_X).length() < 1e-12);
}

const PERMUTATIONS: [&str; 6] = ["XYZ", "XZY", "X-YZ", "ZXY", "-X+Z-Y", "yzx"];

#[test]
fn a_permutation_says_which_of_haplys_axes_each_of_ours_is() {
    let up = |permutation| {
        Basis::read(permutation)
            .expect("a basis")
            .to_device(DVec3::Y)
    };
    // Haply's z is up, its y forward: device y and −z.
    assert_eq!(up("XZY"), DVec3::Y);
    assert_eq!(up("XYZ"), DVec3::NEG_Z);
    assert_eq!(up("X-YZ"), DVec3::Z);
    for wrong in ["", "XY", "XXY", "XYW", "XYZZ", "X--YZ", "-"] {
        assert_eq!(Basis::read(wrong), None, "{wrong}");
    }
}

/// True if all numbers are in their ranges.
fn is_sound(pose: &Pose) -> bool {
    let within = |vector: DVec3, most: f64| vector.to_array().iter().all(|x| x.abs() <= most);
    within(pose.position, FARTHEST_M)
        && pose.velocity.is_none_or(|v| within(v, FASTEST_M_S))
        && (pose.orientation.length() - 1.0).abs() < 1e-9
}

fn is_safe(bytes: &[u8]) -> bool {
    let Ok(update) = Update::read(bytes) else {
        return true;
    };
    let mut tracker = DeviceTracker::new("A", None);
    match (tracker.take(&update, 0), tracker.take(&update, 0)) {
        (Seen::Pose(first), Seen::Pose(again)) => is_sound(&first) && is_sound(&again),
        _ => true,
    }
}

/// As short a message as has all that we read.
const MESSAGE: &[u8] = br#"{"inverse3":[{"device_id":"A","config":{"basis":{"permutation":"X-ZY"}},"state":{"cursor_position":{"x":0.1,"y":-0.2,"z":0.3},"cursor_velocity":{"x":1,"y":2,"z":3}},"status":{"ready":true}}],"verse_grip":[{"device_id":"B","state":{"button":true,"orientation":{"x":0.1,"y":0.7,"z":0.1,"w":0.7}}}]}"#;

fn byte() -> impl Strategy<Value = u8> {
    prop_oneof![
        6 => prop::sample::select(&b"0123456789.-+eE{}[]:,\"xyzw truefalsn"[..]),
        1 => any::<u8>(),
    ]
}

proptest! {
    #[test]
    fn no_bytes_make_an_inverse3_message_panic_or_leave_its_range(
        bytes in prop::collection::vec(byte(), 0..64),
    ) {
        prop_assert!(is_safe(&bytes));
    }

    #[test]
    fn no_mutation_of_an_inverse3_message_leaves_its_range(
        changes in prop::collection::vec((0..MESSAGE.len(), byte()), 0..3),
        cut in 0..2 * MESSAGE.len(),
    ) {
        let mut message = MESSAGE.to_vec();
        for (place, byte) in changes {
            message[place] = byte;
        }
        message.truncate(cut);
        prop_assert!(is_safe(&message));
    }

    #[test]
    fn no_bytes_make_an_inverse3_basis_that_is_none(
        text in "[-+XYZxyzW]{0,7}",
        v in (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64),
    ) {
        let v = DVec3::new(v.0, v.1, v.2);
        if let Some(basis) = Basis::read(&text) {
            prop_assert_eq!(basis.to_session(basis.to_device(v)), v);
            prop_assert_eq!(basis.to_device(v).abs().to_array().iter().sum::<f64>(),
                basis.to_device(v.abs()).abs().to_array().iter().sum::<f64>());
        }
    }

    /// Turned as the session says and then seen in the device frame is seen there and then turned.
    #[test]
    fn orientations_go_with_vectors_also_where_axes_are_left_handed(
        place in 0..PERMUTATIONS.len(),
        axis in (-1.0..1.0f64, -1.0..1.0f64, 0.1..1.0f64),
        angle in -3.0..3.0f64,
        v in (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64),
    ) {
        let basis = Basis::read(PERMUTATIONS[place]).expect("a basis");
        let v = DVec3::new(v.0, v.1, v.2);
        let turn = rotation(DVec3::new(axis.0, axis.1, axis.2).normalize(), angle);
        let expected = basis.to_device(turn * v);
        prop_assert!((basis.orientation(turn) * basis.to_device(v) - expected).length() < 1e-12);
    }
}

#[test]
fn the_message_that_is_mutated_has_a_pose() {
    let seen = DeviceTracker::new("A", None).take(&Update::read(MESSAGE).expect("a message"), 0);
    assert!(is_sound(&pose(seen)));
    let wrong = Pose {
        position: DVec3::X * 1.1,
        ..pose(seen)
    };
    assert!(!is_sound(&wrong));
}
