//! Ports of this machine, and units of its devices.

use std::io::{Error, ErrorKind};

use maulstick_hid::device_source::{Found, Identity, Ports as _};
use maulstick_hid::hidraw::{Hidraw, closed};
use maulstick_hid::units::{metres, radians};

use crate::support::identity;

#[test]
fn what_keeps_a_device_closed_says_what_to_do() {
    let device = identity(0x056A, 0x0357, "Intuos");
    for (kind, what, help) in [
        (
            ErrorKind::PermissionDenied,
            "may not read 056a:0357 Intuos",
            "device allow",
        ),
        (ErrorKind::ResourceBusy, "in use", "end the program"),
        (ErrorKind::NotFound, "gone", "plug it in"),
        (ErrorKind::Other, "cannot be opened", "plug it in"),
    ] {
        let fault = closed(&device, &Error::from(kind));
        assert!(fault.what.contains(what), "{fault}");
        assert!(fault.help.is_some_and(|told| told.contains(help)));
        assert_eq!(fault.place.as_deref(), Some("/dev/hidraw3"));
    }
}

#[test]
fn a_path_where_nothing_is_and_a_file_that_is_no_device_do_not_open() {
    let file = tempfile::NamedTempFile::new().expect("a file");
    for (place, what) in [
        ("/dev/hidraw-none".to_owned(), "is gone"),
        (file.path().display().to_string(), "cannot be opened"),
    ] {
        let found = Found {
            identity: Identity {
                place,
                ..Identity::default()
            },
            usages: Vec::new(),
        };
        let fault = Hidraw.open(&found).err().expect("refused");
        assert!(fault.what.contains(what), "{fault}");
    }
}

#[test]
fn the_machine_says_what_is_plugged_in() {
    // Whatever there is, each device is listed once, by its path.
    let found = Hidraw.list().expect("listed").into_iter();
    let places: Vec<_> = found
        .map(|found| (found.identity.place.len(), found.identity.place))
        .collect();
    assert!(places.is_sorted_by(|a, b| a < b), "{places:?}");
}

#[test]
fn lengths_and_angles_in_either_system() {
    let near = |got: Option<f64>, wanted: f64| {
        assert!(
            got.is_some_and(|got| (got / wanted - 1.0).abs() < 1e-12),
            "{got:?} {wanted}"
        );
    };
    near(metres(0x11, -3), 1e-5);
    near(metres(0x11, 0x0D), 1e-5);
    near(metres(0x13, -3), 2.54e-5);
    near(radians(0x14, -2), 0.01_f64.to_radians());
    near(radians(0x12, 0), 1.0);
    // Seconds, square centimetres, no unit, an exponent beyond a nibble.
    for (unit, exponent) in [(0x1001, 0), (0x21, 0), (0, 0), (0x11, 40)] {
        assert_eq!(metres(unit, exponent), None, "{unit:#x}");
        assert_eq!(radians(unit, exponent), None, "{unit:#x}");
    }
}
