//! The table and the JSON of the findings.

use std::path::PathBuf;

use maulstick_device_setup::attached::Permission;
use maulstick_device_setup::attached::vendors::INVERSE_SERVICE;
use maulstick_device_setup::listing::{InverseService, VendorSoftware};
use maulstick_rig::config::DeviceSection;

use super::*;

fn attached(name: &str, id: &str, node: &str, driver: Option<&'static str>) -> Attached {
    Attached {
        name: name.into(),
        id: id.into(),
        path: PathBuf::from("/dev").join(node),
        driver,
        permission: Permission::Granted,
        missing: None,
    }
}

fn findings(hid: Vec<Attached>, serial: Vec<Attached>) -> DeviceListing {
    DeviceListing {
        hid,
        serial,
        openhaptics: VendorSoftware {
            path: None,
            looked_in: vec!["/usr/lib".into()],
        },
        inverse_service: InverseService {
            address: INVERSE_SERVICE,
            listens: false,
        },
        ..DeviceListing::default()
    }
}

#[test]
fn nothing_attached_is_said_and_what_would_be_seen() {
    let keyboard = attached("A keyboard", "046d:c31c", "hidraw0", None);
    for found in [findings(vec![], vec![]), findings(vec![keyboard], vec![])] {
        let text = in_words(&found);
        for word in [
            "Nothing attached",
            "/usr/lib.",
            "localhost:10001",
            "does not run",
        ] {
            assert!(text.contains(word), "'{word}' is missing in: {text}");
        }
    }
    let pen = attached("A pen", "056a:0374", "hidraw0", Some("pen"));
    assert!(!in_words(&findings(vec![pen], vec![])).contains("Nothing"));
}

#[test]
fn what_a_driver_fits_comes_first_in_columns_and_how_it_is_used_below() {
    let mut denied = attached("Intuos S", "056a:0374", "hidraw3", Some("pen"));
    denied.permission = Permission::Denied;
    denied.missing = Some("no permission".into());
    let mut found = findings(
        vec![attached("A keyboard", "046d:c31c", "hidraw0", None), denied],
        vec![attached(
            "Teensyduino",
            "16c0:0483",
            "ttyACM0",
            Some("polhem"),
        )],
    );
    found.openhaptics.path = Some("/usr/lib/libHD.so".into());
    found.inverse_service.listens = true;
    let text = in_words(&found);
    let expected = "\
device                 id         at                 driver
Intuos S               056a:0374  /dev/hidraw3       pen          no permission
Teensyduino            16c0:0483  /dev/ttyACM0       polhem       ready
A keyboard             046d:c31c  /dev/hidraw0       -
OpenHaptics            -          /usr/lib/libHD.so  openhaptics  found
Haply Inverse Service  -          localhost:10001    inverse3     found
";
    assert!(text.starts_with(expected), "{text}");
    // The one that is ready, by its port.
    assert!(text[expected.len()..].contains("/dev/ttyACM0"), "{text}");
}

#[test]
fn the_devices_of_a_rig_are_listed_with_their_trouble() {
    let used = |name: &str, trouble: &str| RigDevice {
        section: DeviceSection::new(name, "pen", "main"),
        is_in_rig: true,
        is_own: true,
        is_there: true,
        trouble: trouble.into(),
    };
    let never = RigDevice {
        is_there: false,
        ..used("arm", "there is no libHD.so")
    };
    let ended = RigDevice {
        is_there: false,
        ..used("cup", "")
    };
    let text = in_rig(Some(&[
        used("left", ""),
        used("right", "it is unplugged"),
        never,
        ended,
    ]));
    let rows: Vec<&str> = text.trim().lines().collect();
    assert_eq!(
        rows,
        [
            "in the rig  driver  brush  priority",
            "left        pen     main   0         in use",
            "right       pen     main   0         it is unplugged",
            "arm         pen     main   0         there is no libHD.so",
            "cup         pen     main   0         does not run: see its messages in the rig's terminal",
        ]
    );
    assert_eq!(in_rig(Some(&[])).lines().count(), 1);
}

#[test]
fn what_the_rig_has_in_use_comes_first_and_is_not_called_nothing() {
    let mut found = findings(vec![], vec![]);
    let pen = RigDevice {
        section: DeviceSection::new("pen", "window", "main"),
        is_in_rig: false,
        is_own: false,
        is_there: true,
        trouble: String::new(),
    };
    found.rig = Some(vec![pen.clone()]);
    let text = in_words(&found);
    let (devices, below) = text.split_once("\n\n").expect("two parts");
    assert!(devices.lines().any(|row| row.starts_with("pen ")), "{text}");
    assert!(below.starts_with(NOTHING_ELSE), "{text}");
    // One that has not shown itself paints nothing.
    found.rig = Some(vec![RigDevice {
        is_there: false,
        ..pen
    }]);
    assert!(in_words(&found).starts_with(NOTHING));
}
