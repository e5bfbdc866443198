//! Takes the event devices of a tablet away from the system while its reports are read at /dev/hidraw*: one pen must not
//! paint and move the pointer too.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use evdev::raw_stream::RawDevice;
use maulstick_rig::UserError;

use super::capabilities::bits;

/// Keys of a device that moves the pointer: the tools of a pen, and a mouse's first button.
const POINTERS: [u16; 6] = [0x110, 0x140, 0x141, 0x142, 0x143, 0x144];

/// Event devices that nobody else hears, until this is dropped.
#[derive(Debug, Default)]
pub struct Grab {
    _held: Vec<RawDevice>,
}

impl Grab {
    /// Grabs devices, and reports the first that may not be opened. What another program has grabbed no longer moves the
    /// pointer.
    #[must_use]
    pub fn all(nodes: &[PathBuf]) -> (Self, Option<UserError>) {
        let (mut held, mut fault) = (Vec::new(), None);
        for node in nodes {
            let grabbed = RawDevice::open(node).and_then(|mut device| {
                device.grab()?;
                Ok(device)
            });
            match grabbed {
                Ok(device) => held.push(device),
                Err(error) if error.kind() == ErrorKind::ResourceBusy => {}
                Err(error) => fault = fault.or_else(|| Some(refused(node, &error))),
            }
        }
        (Self { _held: held }, fault)
    }
}

fn refused(node: &Path, error: &std::io::Error) -> UserError {
    let help = match error.kind() {
        ErrorKind::PermissionDenied => "`maulstick device allow` installs the rule that permits it",
        _ => "plug the tablet in again",
    };
    UserError::failure(format!("the pen moves the system's pointer too: {error}"))
        .at(node.display().to_string())
        .help(help)
}

/// Event devices that move the pointer, of the HID device at a node such as /dev/hidraw3, by what stands for /sys and /dev:
/// not the keys of a tablet's pad, nor a touch screen.
#[must_use]
pub fn event_nodes(sys: &Path, dev: &Path, hidraw: &Path) -> Vec<PathBuf> {
    let names = |folder: &Path, beginning: &str| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut found: Vec<PathBuf> = entries
            .filter(|entry| {
                let name = entry.file_name();
                name.to_str()
                    .is_some_and(|name| name.starts_with(beginning))
            })
            .map(|entry| entry.path())
            .collect();
        found.sort();
        found
    };
    let Some(node) = hidraw.file_name() else {
        return Vec::new();
    };
    let inputs = sys.join("class/hidraw").join(node).join("device/input");
    let inputs = names(&inputs, "input");
    let moves_pointer = |input: &&PathBuf| {
        let keys = std::fs::read_to_string(input.join("capabilities/key")).unwrap_or_default();
        bits(&keys).iter().any(|key| POINTERS.contains(key))
    };
    let events = inputs.iter().filter(moves_pointer);
    events
        .flat_map(|input| names(input, "event"))
        .filter_map(|event| Some(dev.join("input").join(event.file_name()?)))
        .collect()
}
