//! Opening: names, what a device can do, libraries that are none.

use maulstick_haptic::drivers::openhaptics::already_open;
use maulstick_haptic::drivers::openhaptics::library::HD;
use maulstick_haptics::Limits;
use maulstick_libhd::{Call, Script};
use maulstick_types::stylus::axes;

use crate::bench::{calls, open, play, refusal, section, serve, tick, trusted};

/// The names under which a device was tried.
fn tried(calls: &[Call]) -> Vec<&str> {
    calls
        .iter()
        .filter_map(|call| match call {
            Call::Init(name) => Some(name.as_str()),
            _ => None,
        })
        .collect()
}

#[test]
fn a_device_without_an_address_is_the_default_one_by_any_of_its_names() {
    for (known, expected) in [
        ("", vec![""]),
        ("Default Device", vec!["", "Default Device"]),
        (
            "Default PHANToM",
            vec!["", "Default Device", "Default PHANToM"],
        ),
    ] {
        let control = play(&Script {
            names: vec![known.into()],
            ..Script::default()
        });
        let opened = open(&section()).expect("opened");
        assert_eq!(tried(&calls(&control)), expected);
        let by = opened.what.split(", by ").next();
        assert_eq!(by, Some("Touch, serial number 00000815, driver 4.3"));
    }
}

#[test]
fn an_address_is_the_only_name_that_is_tried() {
    let mut named = section();
    named.address = Some("left".into());
    let control = play(&Script {
        names: vec!["left".into()],
        ..Script::default()
    });
    drop(open(&named).expect("opened"));
    assert_eq!(tried(&calls(&control)), ["left"]);
    drop(control);
    let control = play(&Script::default());
    let fault = refusal(&named);
    assert_eq!(tried(&calls(&control)), ["left"]);
    assert_eq!(fault.place.as_deref(), Some("'left'"));
    assert!(fault.help.is_some_and(|help| help.contains("`address`")));
    named.address = Some("le\0ft".into());
    assert!(refusal(&named).what.contains("zero"));
}

#[test]
fn a_device_does_what_it_says_within_what_its_model_bears() {
    // Model, stiffness and torque that the library says; N/m, N·m that are taken.
    for (model, degrees, stiffness, torque, expected) in [
        ("Touch", 3, 0.5, 0.0, (3.3, 400.0, 0.0)),
        ("PHANTOM Omni", 3, 0.5, 0.0, (3.3, 500.0, 0.0)),
        ("Touch X", 3, 2.35, 0.0, (7.9, 1000.0, 0.0)),
        (
            "PHANTOM Premium 1.5 6DOF",
            6,
            3.5,
            170.0,
            (8.5, 800.0, 0.17),
        ),
        (
            "PHANTOM Premium 1.5 6DOF",
            6,
            3.5,
            500.0,
            (8.5, 800.0, 0.188),
        ),
        ("PHANTOM Premium 1.5", 3, 3.5, 170.0, (8.5, 800.0, 0.0)),
        ("Something", 3, 0.9, 0.0, (3.3, 400.0, 0.0)),
    ] {
        let _control = play(&Script {
            model: model.into(),
            output_dof: degrees,
            max_force: 37.0,
            continuous_force: 0.7,
            stiffness,
            max_torque: torque,
            workspace: [-100.0, -50.0, -40.0, 120.0, 60.0, 30.0],
            ..Script::default()
        });
        let can = open(&section()).expect("opened").driver.abilities();
        let got = (can.max_force_n, can.max_stiffness_n_m, can.max_torque_nm);
        assert_eq!(got, expected, "{model}");
        assert_eq!(can.continuous_force_n, 0.7);
        assert_eq!(can.drives & axes::TORQUE != 0, expected.2 > 0.0);
        let workspace = [-0.1, -0.05, -0.04, 0.12, 0.06, 0.03];
        let off = can.workspace_m.iter().zip(workspace);
        assert!(off.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) < 1e-12);
    }
}

#[test]
fn a_device_that_says_nothing_of_itself_is_taken_for_the_weakest() {
    let control = play(&Script {
        model: "Touch".into(),
        unknown: vec![
            0x2005, 0x2001, 0x2002, 0x2551, 0x2602, 0x2603, 0x2604, 0x2605, 0x2606, 0x2607, 0x2622,
            0x4001,
        ],
        inkwell: 1,
        temperatures: [1.0; 6],
        ..Script::default()
    });
    let can = open(&section()).expect("opened").driver.abilities();
    let limits = (
        can.max_force_n,
        can.continuous_force_n,
        can.max_stiffness_n_m,
    );
    assert_eq!(limits, (3.3, 0.88, 400.0));
    assert_eq!(can.workspace_m[3], 0.08);
    let usual = Limits::default();
    let limits = can.limits(1.0);
    let rates = (limits.slew_n_s, limits.max_speed_m_s);
    assert_eq!(rates, (usual.slew_n_s, usual.max_speed_m_s));
    // What it cannot answer it is asked once, and is taken for in range and cold.
    let mut servo = serve();
    let mut count = 0;
    let record = tick(&mut servo, |record| {
        count += u32::from(record.reading.in_range);
        count > 50
    });
    assert_eq!(record.reading.motor_temperature, 0.0);
    drop(servo);
    let log = calls(&control);
    let first = log.iter().rposition(|call| *call == Call::Start);
    let errors = log[first.expect("a start")..]
        .iter()
        .filter(|call| matches!(call, Call::Error(0x100)));
    assert_eq!(errors.count(), 2, "the inkwell, the temperature");
}

#[test]
fn a_device_that_does_not_initiate_says_why_and_leaves_nothing_behind() {
    for (code, internal, what) in [
        (0x301, 0, "in use by another program (0x301)"),
        (
            0x302,
            -28,
            "does not answer (0x302): the library says 'Communication error' (internal -28)",
        ),
        (
            0x303,
            5,
            "port of the haptic device cannot be set up (0x303)",
        ),
        (0x600, 0, "no valid licence (0x600)"),
        (0x7abc, 9, "not known (0x7abc)"),
    ] {
        for failed_handle in [u32::MAX, 7] {
            let control = play(&Script {
                init_error: Some((code, internal)),
                failed_handle,
                ..Script::default()
            });
            let fault = refusal(&section());
            assert!(fault.what.contains(what), "{fault}");
            assert!(fault.help.is_some(), "{fault}");
            let log = calls(&control);
            let tries = tried(&log).len();
            // Another name would not help where another program has the device.
            assert_eq!(tries, if code == 0x301 { 1 } else { 3 });
            let freed = log.iter().filter(|call| **call == Call::DisableDevice(7));
            assert_eq!(freed.count(), if failed_handle == 7 { tries } else { 0 });
            drop(control);
            let _control = play(&Script::default());
            assert!(open(&section()).is_ok(), "the next one opens");
        }
    }
}

#[test]
fn a_device_without_force_is_none() {
    let control = play(&Script {
        unknown: vec![0x4000],
        ..Script::default()
    });
    assert!(refusal(&section()).what.contains("0x100"));
    assert_eq!(calls(&control).last(), Some(&Call::DisableDevice(0)));
}

#[test]
fn a_process_has_one_device_at_a_time() {
    let _control = play(&Script::default());
    let opened = open(&section()).expect("opened");
    assert_eq!(refusal(&section()), already_open());
    drop(opened);
    assert!(open(&section()).is_ok());
}

#[test]
fn what_is_no_library_of_openhaptics_is_told_apart() {
    let _control = play(&Script::default());
    let folder = tempfile::tempdir().expect("a folder");
    let text = folder.path().join("libHD.so");
    std::fs::write(
        &text,
        "INPUT(libHD.so.3.4) and more than enough for a header of sixty-four bytes",
    )
    .expect("written");
    // The header of a library of 32 bits.
    let narrow = folder.path().join("narrow.so");
    let mut header = [0; 64];
    header[..7].copy_from_slice(b"\x7fELF\x01\x01\x01");
    (header[16], header[18], header[20]) = (3, 3, 1);
    std::fs::write(&narrow, header).expect("written");
    let missing = folder.path().join("missing.so");
    for (library, what, help) in [
        (missing, "there is no such library", "`library`"),
        (trusted(text), "no library for this machine", "64-bit"),
        (trusted(narrow), "no library for this machine (", "64-bit"),
        (
            "libc.so.6".into(),
            "it has no function hdInitDevice",
            "libHD.so",
        ),
        (
            "libHD.so.none".into(),
            "there is no such library",
            "install OpenHaptics",
        ),
    ] {
        let mut named = section();
        named.library = Some(library.clone());
        let fault = refusal(&named);
        assert!(fault.what.contains(what), "{fault}");
        assert_eq!(fault.place, Some(library.display().to_string()));
        assert!(fault.help.is_some_and(|told| told.contains(help)));
    }
    let mut anywhere = section();
    anywhere.library = None;
    let fault = refusal(&anywhere);
    assert_eq!(
        (fault.place, fault.help.as_deref()),
        (None, Some(HD.install))
    );
}
