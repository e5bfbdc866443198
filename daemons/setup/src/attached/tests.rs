//! Devices in a folder that looks like sysfs.

use std::cell::Cell;
use std::fs::{create_dir_all, write};
use std::os::unix::fs::symlink;

use maulstick_haptic::drivers::openhaptics::library::HD;

use super::vendors::{library, listens};
use super::*;

/// A pen's descriptor, a keyboard's, a 6-DOF mouse's: each the collection alone.
const PEN: [u8; 7] = [0x05, 0x0d, 0x09, 0x02, 0xa1, 0x01, 0xc0];
const KEYBOARD: [u8; 7] = [0x05, 0x01, 0x09, 0x06, 0xa1, 0x01, 0xc0];
const SIX_AXES: [u8; 7] = [0x05, 0x01, 0x09, 0x08, 0xa1, 0x01, 0xc0];

/// A machine in a folder.
struct Machine {
    folder: tempfile::TempDir,
    allowed: Cell<Permission>,
}

impl Machine {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        create_dir_all(folder.path().join("dev")).expect("made");
        Self {
            folder,
            allowed: Cell::new(Permission::Granted),
        }
    }

    fn hid(&self, number: usize, id: &str, name: &str, descriptor: &[u8]) {
        let root = self.folder.path();
        // As the kernel has it: the class holds links to the devices' own folders.
        let device = root.join(format!("devices/usb/{number}/0003.{number}"));
        create_dir_all(device.join(format!("hidraw/hidraw{number}"))).expect("made");
        let uevent = format!("DRIVER=hid-generic\nHID_ID=0003:{id}\nHID_NAME={name}\nHID_UNIQ=\n");
        write(device.join("uevent"), uevent).expect("written");
        write(device.join("report_descriptor"), descriptor).expect("written");
        let node = device.join(format!("hidraw/hidraw{number}"));
        symlink(&device, node.join("device")).expect("linked");
        let class = root.join("class/hidraw");
        create_dir_all(&class).expect("made");
        symlink(&node, class.join(format!("hidraw{number}"))).expect("linked");
    }

    fn event(&self, number: usize, id: (&str, &str), name: &str, keys: &str) {
        let device = self
            .folder
            .path()
            .join(format!("class/input/event{number}/device"));
        for (file, text) in [
            ("name", name),
            ("id/bustype", "0003"),
            ("id/vendor", id.0),
            ("id/product", id.1),
            ("capabilities/key", keys),
            ("capabilities/abs", "1000003"),
        ] {
            let path = device.join(file);
            create_dir_all(path.parent().expect("a folder")).expect("made");
            write(path, format!("{text}\n")).expect("written");
        }
    }

    fn serial(&self, node: &str, usb: Option<(&str, &str, &str)>) {
        let root = self.folder.path();
        let device = root.join(format!("devices/{node}-usb"));
        let interface = device.join("1-2:1.0");
        create_dir_all(interface.join("tty").join(node)).expect("made");
        if let Some((vendor, product, name)) = usb {
            for (file, text) in [
                ("idVendor", vendor),
                ("idProduct", product),
                ("product", name),
            ] {
                write(device.join(file), format!("{text}\n")).expect("written");
            }
        }
        let entry = interface.join("tty").join(node);
        symlink(&interface, entry.join("device")).expect("linked");
        let class = root.join("class/tty");
        create_dir_all(&class).expect("made");
        symlink(&entry, class.join(node)).expect("linked");
    }

    /// Name, id, node and driver of each that is found.
    fn found(&self, look: fn(&Places<'_>) -> Vec<Attached>) -> Vec<Attached> {
        let root = self.folder.path();
        look(&Places {
            sys: root,
            dev: &root.join("dev"),
            permission: &|_| self.allowed.get(),
        })
    }
}

/// Bit 0x140, a pen, is in the sixth word.
const PEN_KEYS: &str = "1 0 0 0 0 0";

#[test]
fn a_tablet_is_listed_by_its_events_where_its_reports_say_no_pen() {
    let machine = Machine::new();
    machine.hid(1, "0000056A:00000374", "Wacom Intuos S", &PEN);
    machine.hid(2, "00005543:00000081", "UC-Logic", &KEYBOARD);
    machine.event(5, ("056a", "0374"), "Wacom Intuos S Pen", PEN_KEYS);
    machine.event(6, ("5543", "0081"), "UC-Logic Tablet", PEN_KEYS);
    machine.event(7, ("046d", "c31c"), "Keyboard", "fffe");
    machine.allowed.set(Permission::Denied);
    let found = machine.found(|places| events::devices(places, &hid::devices(places)));
    let brief: Vec<_> = found.iter().map(brief).collect();
    assert_eq!(brief, [("UC-Logic Tablet", "5543:0081", Some("evdev"))]);
    assert_eq!(found[0].missing, Permission::Denied.missing());
}

fn brief(device: &Attached) -> (&str, &str, Option<&str>) {
    (&device.name, &device.id, device.driver)
}

#[test]
fn a_machine_without_devices_has_none() {
    let machine = Machine::new();
    assert!(machine.found(hid::devices).is_empty());
    assert!(machine.found(serial::ports).is_empty());
}

#[test]
fn hid_devices_are_known_by_what_they_say_that_they_are() {
    let machine = Machine::new();
    machine.hid(10, "0000056A:00000374", "Wacom Intuos S", &PEN);
    machine.hid(2, "0000046D:0000C31C", "Logitech Keyboard", &KEYBOARD);
    machine.hid(
        3,
        "0000256F:0000C635",
        "SpaceMouse \u{1b}[2JCompact",
        &SIX_AXES,
    );
    // Six axes of a vendor whose reports nobody knows, and a descriptor that breaks off.
    machine.hid(4, "00001234:00000001", "Something", &SIX_AXES);
    machine.hid(5, "00001234:00000002", "Broken", &PEN[..5]);
    let found = machine.found(hid::devices);
    let brief: Vec<_> = found.iter().map(brief).collect();
    assert_eq!(
        brief,
        [
            ("Logitech Keyboard", "046d:c31c", None),
            ("SpaceMouse ?[2JCompact", "256f:c635", Some("spacemouse")),
            ("Something", "1234:0001", None),
            ("Broken", "1234:0002", None),
            ("Wacom Intuos S", "056a:0374", Some("pen")),
        ]
    );
    assert!(found.iter().all(|device| device.missing.is_none()));
    assert_eq!(found[4].path, machine.folder.path().join("dev/hidraw10"));
}

#[test]
fn a_device_that_may_not_be_read_is_listed_with_what_to_do() {
    let machine = Machine::new();
    machine.hid(0, "0000056A:00000374", "Wacom Intuos S", &PEN);
    machine.hid(1, "0000046D:0000C31C", "Logitech Keyboard", &KEYBOARD);
    machine.serial("ttyACM0", Some(("16c0", "0483", "USB Serial")));
    machine.serial("ttyACM1", Some(("2341", "003d", "Due")));
    machine.allowed.set(Permission::Denied);
    let found = machine.found(hid::devices);
    let denied = Permission::Denied.missing();
    assert!(denied.is_some() && found[0].missing == denied);
    assert_eq!(found[1].missing, None, "nobody asks for a keyboard");
    let found = machine.found(serial::ports);
    let missing = found[0].missing.as_deref().expect("something is missing");
    assert!(missing.contains("dialout"), "{missing}");
    assert_eq!((found[1].driver, &found[1].missing), (None, &None));
    machine.allowed.set(Permission::Absent);
    let absent = Permission::Absent.missing();
    assert!(absent.is_some() && absent != denied);
    assert_eq!(machine.found(hid::devices)[0].missing, absent);
}

#[test]
fn serial_ports_of_usb_devices_are_known_by_their_vendor() {
    let machine = Machine::new();
    machine.serial("ttyACM0", Some(("16c0", "0483", "Teensyduino")));
    machine.serial("ttyACM1", Some(("16c0", "05dc", "USBasp")));
    machine.serial("ttyACM2", Some(("2988", "0302", "Touch")));
    machine.serial("ttyS0", None);
    machine.serial("ttyUSB0", Some(("nonsense", "0001", "?")));
    let found = machine.found(serial::ports);
    let brief: Vec<_> = found.iter().map(brief).collect();
    assert_eq!(
        brief,
        [
            ("Teensyduino", "16c0:0483", Some("polhem")),
            ("USBasp", "16c0:05dc", None),
            ("Touch", "2988:0302", Some("openhaptics")),
        ]
    );
}

#[test]
fn the_rule_has_every_vendor_that_a_driver_fits() {
    for id in [
        "056a:0374",
        "256c:006d",
        "28bd:0935",
        "256f:c635",
        "046d:c626",
    ] {
        assert!(is_ruled(id), "{id}");
    }
    // A Logitech that is no 6-DOF mouse.
    assert!(!is_ruled("1234:0001") && !is_ruled("046d:c31c"));
    let machine = Machine::new();
    machine.hid(0, "0000056A:00000374", "Wacom Intuos S", &PEN);
    machine.hid(1, "00001A2B:00000001", "A pen of another vendor", &PEN);
    machine.hid(2, "00001A2C:00000001", "A keyboard", &KEYBOARD);
    let rules = rules(&machine.found(hid::devices));
    assert!(rules.starts_with(UDEV_RULES));
    let added = &rules[UDEV_RULES.len()..];
    let lines: Vec<&str> = added
        .lines()
        .filter(|line| line.starts_with("SUB"))
        .collect();
    assert_eq!(
        lines,
        ["SUBSYSTEM==\"hidraw\", KERNELS==\"*:1A2B:0001.*\", TAG+=\"uaccess\""]
    );
}

#[test]
fn the_vendors_library_and_service_are_found_where_they_are() {
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(library(&HD, &[folder.path()]), None);
    let own = folder.path().join("libHD.so.3.4");
    write(&own, "").expect("written");
    let folders = [Path::new("/nowhere"), folder.path()];
    assert_eq!(library(&HD, &folders), Some(own));
    let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address").to_string();
    assert!(listens(&address));
    drop(listener);
    assert!(!listens(&address) && !listens("nonsense"));
}

#[test]
fn a_node_that_is_there_may_be_used_and_one_that_is_not_is_absent() {
    let folder = tempfile::tempdir().expect("a folder");
    let node = folder.path().join("hidraw0");
    assert_eq!(permission(&node), Permission::Absent);
    write(&node, "").expect("written");
    assert_eq!(permission(&node), Permission::Granted);
}
