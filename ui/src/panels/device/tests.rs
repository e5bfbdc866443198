use eframe::egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use maulstick_device::corner_calibration::Corner;
use maulstick_device_setup::add::NewDevice;
use maulstick_device_setup::attached::{Attached, Permission};
use maulstick_device_setup::change::DeviceChange;
use maulstick_device_setup::fit::{FitEvent, Gesture};
use maulstick_device_setup::listing::{DeviceListing, RigDevice};
use maulstick_num::sin;
use maulstick_rig::config::DeviceSection;
use maulstick_types::haptics::ForceOrder;
use maulstick_types::stylus::{StylusInfo, StylusPose, StylusSample, StylusStatus, axes};

use maulstick_client::request::Request;

use super::*;
use crate::rig::device_order::{DeviceOrder, FitProgress, SetupChange};
use crate::rig::device_setup::fit_event;
use crate::rig::state::RigState;
use crate::test_support::panel_bench::{Bench, harness, picture, rig};

fn info(device: &str, driver: &str, priority: i32, senses: u32, drives: u32) -> StylusInfo {
    StylusInfo {
        device: device.into(),
        driver: driver.into(),
        brush: "main".into(),
        priority,
        senses,
        drives,
        rate_hz: if drives == 0 { 60.0 } else { 1000.0 },
        max_force_n: 3.3,
        max_stiffness_n_m: 1000.0,
        workspace_m: [0.0; 6],
    }
}

/// A mouse, a pen that is not there and an arm that pushes.
pub(crate) fn devices() -> RigState {
    let mut rig = rig();
    rig.live.now_ns = 10_000_000_000;
    let pen = axes::POSITION | axes::PRESSURE | axes::TILT | axes::PROXIMITY;
    let arm = axes::POSITION | axes::ORIENTATION | axes::SWITCHES | axes::VELOCITY;
    for info in [
        info("mouse", "pointer", -100, axes::POSITION | axes::SWITCHES, 0),
        info("tablet", "pen", 5, pen, 0),
        info("phantom", "openhaptics", 10, arm, axes::FORCE),
    ] {
        rig.live.nodes.push(info.device.clone());
        let device = rig.live.devices.entry(info.device.clone()).or_default();
        device.info = Some(info);
    }
    let tablet = rig.live.devices.get_mut("tablet").expect("a tablet");
    tablet.status = Some(StylusStatus {
        trouble: "no pen (/dev/hidraw0)".into(),
        help: "plug it in".into(),
        ..StylusStatus::fresh(0)
    });
    let phantom = rig.live.devices.get_mut("phantom").expect("a phantom");
    phantom.status = Some(StylusStatus {
        samples: 123_456,
        lateness: vec![100_000, 20_000, 900, 30, 4, 0, 0, 0, 0, 0, 0, 0],
        execution: vec![120_000, 900, 34, 0, 0, 0, 0, 0, 0, 0, 0, 0],
        strength: 0.6,
        asked_n_m: 700.0,
        stiffness_n_m: 400.0,
        cap_n: 3.0,
        motor_temperature: 0.2,
        ..StylusStatus::fresh(12)
    });
    for ms in 5000..10_000u64 {
        let phase = ms as f64 * 2e-3;
        let push = (1.6 * sin(phase).max(0.0) + 0.1 * sin(40.0 * phase)).max(0.0);
        let sample = StylusSample {
            pose: StylusPose::Ferrule {
                pose: maulstick_types::Pose::IDENTITY,
            },
            force_n: [0.4 * push, 0.3 * push, push],
            in_range: true,
            ..StylusSample::away()
        };
        phantom.forces.add(ms * 1_000_000, &sample);
    }
    rig
}

fn status<'a>(harness: &'a mut Harness<'_, Bench<DevicePanel>>) -> &'a mut StylusStatus {
    let devices = &mut harness.state_mut().rig.live.devices;
    let phantom = devices.get_mut("phantom").expect("a phantom");
    phantom.status.as_mut().expect("a status")
}

fn asked(harness: &mut Harness<'_, Bench<DevicePanel>>) -> Vec<Request> {
    harness.state_mut().requests.take()
}

fn order(order: ForceOrder) -> Request {
    Request::Force {
        device: "phantom".into(),
        order,
    }
}

#[test]
fn who_paints_and_what_is_wrong_stand_in_words() {
    let mut harness = harness::<DevicePanel>(devices());
    harness.get_by_label("phantom paints");
    harness.get_by_label("no pen (/dev/hidraw0)");
    harness.get_by_label("Plug it in");
    harness.get_by_label("Senses position, pressure, tilt, nearness");
    harness.get_by_label("400 of 700 N/m");
    harness.get_by_label_contains("Force on the hand: ");
    harness.state_mut().rig.live.now_ns += 60_000_000_000;
    harness.run();
    harness.get_by_label("No pen in range. You are painting with the mouse.");
    harness.get_by_label("silent");
}

fn attached(name: &str, id: &str, permission: Permission) -> Attached {
    Attached {
        name: name.into(),
        id: id.into(),
        path: "/dev/hidraw0".into(),
        driver: Some("pen"),
        missing: (permission == Permission::Denied).then(|| "no permission".to_owned()),
        permission,
    }
}

/// Attached devices, and a rig with a tablet of the user's and a studio's phantom.
fn listing(tablet: &str) -> DeviceListing {
    let tablet = DeviceSection {
        priority: 5,
        address: Some("1:2".into()),
        ..DeviceSection::new(tablet, "pen", "main")
    };
    let phantom = DeviceSection {
        priority: 10,
        ..DeviceSection::new("phantom", "openhaptics", "main")
    };
    let rig = [(tablet, true), (phantom, false)].map(|(section, is_own)| RigDevice {
        section,
        is_in_rig: true,
        is_own,
        is_there: true,
        trouble: String::new(),
    });
    DeviceListing {
        hid: vec![
            attached("Wacom Intuos S", "056a:0374", Permission::Granted),
            attached("Deco L", "28bd:0935", Permission::Denied),
        ],
        rig: Some(rig.to_vec()),
        ..DeviceListing::default()
    }
}

/// The same with what is attached.
fn listed() -> RigState {
    let mut rig = devices();
    rig.setup.listing = Some(listing("tablet"));
    rig
}

fn orders(harness: &mut Harness<'_, Bench<DevicePanel>>) -> Vec<DeviceOrder> {
    harness.state_mut().requests.take_device_orders()
}

/// A change of a device, with its priority or above all others.
fn uses(device: &str, priority: Option<i32>, change: DeviceChange) -> DeviceOrder {
    DeviceOrder::Change(SetupChange::Use(DeviceChange {
        device: device.to_owned(),
        priority,
        ..change
    }))
}

#[test]
fn what_is_attached_is_added_with_a_click_or_first_allowed() {
    let mut harness = harness::<DevicePanel>(listed());
    for (button, command) in [
        (
            "Add Wacom Intuos S",
            SetupChange::Add(NewDevice {
                address: Some("056a:0374".into()),
                ..NewDevice::default()
            }),
        ),
        ("Allow…", SetupChange::Allow),
    ] {
        harness.get_by_label(button).click();
        harness.run();
        assert_eq!(orders(&mut harness), [DeviceOrder::Change(command)]);
    }
    assert!(
        harness.query_by_label("Add Deco L").is_none(),
        "it may not be used"
    );
    harness.state_mut().rig.setup.listing = Some(DeviceListing::default());
    harness.run();
    harness.get_by_label_contains("No other tablet");
}

#[test]
fn a_device_is_preferred_fitted_and_removed() {
    let mut harness = harness::<DevicePanel>(listed());
    // Those of the phantom, which paints already and is a studio's, come first.
    for (button, place, command) in [
        (
            "Paint with it",
            1,
            uses("tablet", None, DeviceChange::default()),
        ),
        (
            "Fit to the canvas…",
            0,
            DeviceOrder::Fit("tablet".to_owned()),
        ),
        (
            "Remove",
            1,
            DeviceOrder::Change(SetupChange::Remove("tablet".to_owned())),
        ),
    ] {
        harness
            .get_all_by_label(button)
            .nth(place)
            .expect(button)
            .click();
        harness.run();
        assert_eq!(orders(&mut harness), [command]);
    }
    let touch = FitEvent::Touch {
        corner: Corner::LowerLeft,
        gesture: Gesture::Pen,
    };
    harness.state_mut().rig.setup.fit = Some(FitProgress {
        device: "tablet".into(),
        events: vec![touch.clone()],
    });
    harness.run();
    harness.get_by_label(&fit_event(&touch));
    harness.get_by_label("Stop fitting").click();
    harness.run();
    assert_eq!(orders(&mut harness), [DeviceOrder::StopFit]);
}

#[test]
fn a_law_a_switch_and_a_curve_are_chosen_with_the_priority_as_it_is() {
    let mut harness = harness::<DevicePanel>(listed());
    harness
        .get_all_by_label("Settings")
        .next()
        .expect("the phantom's")
        .click();
    harness.run_steps(20);
    harness
        .get_by_role_and_label(Role::ComboBox, "Force")
        .click();
    harness.run();
    harness.get_by_label("rigid").click();
    harness.run();
    let rigid = DeviceChange {
        force: Some("rigid".into()),
        ..DeviceChange::default()
    };
    assert_eq!(orders(&mut harness), [uses("phantom", Some(10), rigid)]);
    harness
        .get_by_role_and_label(Role::ComboBox, "Switch 1")
        .click();
    harness.run();
    harness.get_by_label("palette").click();
    harness.run();
    let switches = DeviceChange {
        switches: Some(vec!["palette".into(), "undo".into()]),
        ..DeviceChange::default()
    };
    assert_eq!(orders(&mut harness), [uses("phantom", Some(10), switches)]);
    harness
        .get_all_by_label("Settings")
        .nth(1)
        .expect("the tablet's")
        .click();
    harness.run_steps(20);
    harness.get_by_label("Soft").click();
    harness.run();
    let soft = DeviceChange {
        pressure_curve: Some(vec![[0.0, 0.0], [0.3, 0.5], [0.6, 0.8], [1.0, 1.0]]),
        ..DeviceChange::default()
    };
    assert_eq!(orders(&mut harness), [uses("tablet", Some(5), soft)]);
}

/// Types at the end of the name in a device's settings.
fn type_name(harness: &mut Harness<'_, Bench<DevicePanel>>, text: &str) {
    let name = (Role::TextInput, "Name");
    harness.get_by_role_and_label(name.0, name.1).focus();
    harness.run_steps(4);
    let field = harness.get_by_role_and_label(name.0, name.1);
    field.type_text(text);
    harness.run_steps(4);
}

#[test]
fn a_typed_name_renames_a_device_of_ones_own_which_stays_unfolded_and_tested() {
    let mut harness = harness::<DevicePanel>(listed());
    harness
        .get_all_by_label("Settings")
        .next()
        .expect("the phantom's")
        .click();
    harness.run_steps(20);
    let field = harness.query_by_role_and_label(Role::TextInput, "Name");
    assert!(field.is_none(), "the phantom is the studio's");
    harness
        .get_all_by_label("Settings")
        .nth(1)
        .expect("the tablet's")
        .click();
    harness.run_steps(20);
    harness
        .get_all_by_label("Test…")
        .nth(1)
        .expect("the tablet's")
        .click();
    harness.run_steps(4);
    type_name(&mut harness, "-x");
    harness.key_press(eframe::egui::Key::Escape);
    harness.run_steps(4);
    assert!(orders(&mut harness).is_empty(), "left as it was");
    type_name(&mut harness, "-2");
    harness.key_press(eframe::egui::Key::Enter);
    harness.run_steps(4);
    let renamed = SetupChange::Rename {
        device: "tablet".into(),
        name: "tablet-2".into(),
    };
    assert_eq!(orders(&mut harness), [DeviceOrder::Change(renamed)]);
    assert!(harness.query_all_by_label("Test of tablet").count() > 0);
    // The rig has it under its new name.
    let rig = &mut harness.state_mut().rig;
    rig.setup.listing = Some(listing("tablet-2"));
    rig.live.nodes.retain(|node| node != "tablet");
    rig.live.nodes.push("tablet-2".into());
    let tablet = rig.live.devices.remove("tablet").expect("a tablet");
    rig.live.devices.insert("tablet-2".into(), tablet);
    harness.run_steps(20);
    assert!(harness.query_all_by_label("Test of tablet-2").count() > 0);
    let field = harness.get_by_role_and_label(Role::TextInput, "Name");
    assert_eq!(field.value().as_deref(), Some("tablet-2"));
}

#[test]
fn a_device_that_left_is_shown_no_more() {
    let mut harness = harness::<DevicePanel>(listed());
    harness
        .state_mut()
        .rig
        .live
        .nodes
        .retain(|node| node != "tablet");
    harness.run();
    assert!(harness.query_by_label("no pen (/dev/hidraw0)").is_none());
}

#[test]
fn force_goes_off_and_on() {
    let mut harness = harness::<DevicePanel>(devices());
    harness.get_by_label("Force off").click();
    harness.run();
    assert_eq!(asked(&mut harness), [order(ForceOrder::Off)]);
    status(&mut harness).is_on = false;
    harness.run();
    assert!(harness.query_by_label("Force off").is_none());
    harness.get_by_label("Force on").click();
    harness.run();
    assert_eq!(asked(&mut harness), [order(ForceOrder::On)]);
}

#[test]
fn a_key_switches_off_the_force_of_those_that_give_one() {
    let mut harness = harness::<DevicePanel>(devices());
    let bench = harness.state_mut();
    force_off(&mut PanelContext {
        rig: &mut bench.rig,
        requests: &mut bench.requests,
        preferences: &mut bench.preferences,
        notifications: &mut bench.notifications,
    });
    assert_eq!(asked(&mut harness), [order(ForceOrder::Off)]);
}

#[test]
fn a_latched_fault_is_told_with_what_arms_it_again() {
    let mut harness = harness::<DevicePanel>(devices());
    assert!(harness.query_by_label("Re-arm").is_none(), "all is well");
    status(&mut harness).faults = vec!["the hand shakes".into()];
    harness.run();
    harness.get_by_label("the hand shakes");
    harness.get_by_label("Re-arm").click();
    harness.run();
    assert_eq!(asked(&mut harness), [order(ForceOrder::Rearm)]);
}

#[test]
fn a_new_strength_is_asked_for_and_shown_until_the_device_has_it() {
    let mut harness = harness::<DevicePanel>(devices());
    let value = |harness: &Harness<'_, Bench<DevicePanel>>| {
        let slider = harness.get_by_role_and_label(Role::Slider, "Strength");
        slider.accesskit_node().numeric_value()
    };
    assert_eq!(value(&harness), Some(60.0));
    let slider = harness.get_by_role_and_label(Role::Slider, "Strength");
    slider.focus();
    harness.run();
    harness.key_press(eframe::egui::Key::ArrowRight);
    harness.run();
    let requests = asked(&mut harness);
    let [
        Request::Force {
            order: ForceOrder::Strength { share },
            ..
        },
    ] = requests[..]
    else {
        panic!("{requests:?}");
    };
    assert!(share > 0.6 && share < 0.7, "{share}");
    assert_eq!(value(&harness), Some((100.0 * share).round()));
    // The device has something else in the end.
    status(&mut harness).strength = 0.3;
    harness.run_steps(20);
    assert_eq!(value(&harness), Some(30.0));
}

#[test]
fn guidance_is_offered_while_a_guide_is_alive() {
    let mut harness = harness::<DevicePanel>(devices());
    let slider = |harness: &Harness<'_, Bench<DevicePanel>>| {
        let found = harness.query_by_role_and_label(Role::Slider, "Guidance");
        found.and_then(|slider| slider.accesskit_node().numeric_value())
    };
    assert_eq!(slider(&harness), None);
    let told = status(&mut harness);
    (told.is_guided, told.guidance) = (true, 0.5);
    harness.run();
    assert_eq!(slider(&harness), Some(50.0));
    harness
        .get_by_role_and_label(Role::Slider, "Guidance")
        .focus();
    harness.run();
    harness.key_press(eframe::egui::Key::ArrowLeft);
    harness.run();
    let requests = asked(&mut harness);
    let [
        Request::Force {
            order: ForceOrder::Guidance { share },
            ..
        },
    ] = requests[..]
    else {
        panic!("{requests:?}");
    };
    assert!(share < 0.5 && share > 0.4, "{share}");
    assert_eq!(slider(&harness), Some((100.0 * share).round()));
}

#[test]
fn it_looks_like_its_picture() {
    let open = |harness: &mut Harness<'static, Bench<DevicePanel>>| {
        harness.get_by_label("Loop health").click();
        harness.run_steps(20);
    };
    let mut rig = devices();
    rig.live.devices.retain(|name, _| name == "phantom");
    picture::<DevicePanel>("device", &rig, open, |rig| {
        let phantom = rig.live.devices.get_mut("phantom").expect("a phantom");
        phantom.forces = maulstick_client::force_history::ForceHistory::default();
    });
}

#[test]
fn what_is_attached_and_a_pens_settings_look_like_their_picture() {
    let open = |harness: &mut Harness<'static, Bench<DevicePanel>>| {
        harness.get_by_label("Settings").click();
        harness.run_steps(20);
    };
    let mut rig = listed();
    rig.live.devices.retain(|name, _| name == "tablet");
    let tablet = rig.live.devices.get_mut("tablet").expect("a tablet");
    let mut pen = StylusSample::away();
    if let StylusPose::Contact { pressure, .. } = &mut pen.pose {
        *pressure = 0.4;
    }
    tablet.samples.add(10_000_000_000, 9_990_000_000, &pen);
    picture::<DevicePanel>("device_settings", &rig, open, |rig| {
        rig.live.devices.get_mut("tablet").expect("a tablet").status = None;
    });
}
