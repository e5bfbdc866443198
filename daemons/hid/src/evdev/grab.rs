//! Takes the event devices of a tablet away from the system while its reports are read at /dev/hidraw*: one pen must not
//! paint and move the pointer too.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use evdev::Device;
use maulstick_rig::UserError;

/// Event devices that nobody else hears, until this is dropped.
#[derive(Debug, Default)]
pub struct Grab {
    _held: Vec<Device>,
}

impl Grab {
    /// Grabs devices. What another program has grabbed is out of the pointer's hands already.
    ///
    /// # Errors
    /// A [`UserError`] that names the first that may not be opened.
    pub fn all(nodes: &[PathBuf]) -> Result<Self, UserError> {
        let mut held = Vec::new();
        for node in nodes {
            let grabbed = Device::open(node).and_then(|mut device| {
                device.grab()?;
                Ok(device)
            });
            match grabbed {
                Ok(device) => held.push(device),
                Err(error) if error.kind() == ErrorKind::ResourceBusy => {}
                Err(error) => {
                    let what = format!("the pen moves the system's pointer too: {error}");
                    return Err(UserError::failure(what)
                        .at(node.display().to_string())
                        .help("`maulstick device list --udev` prints the rule to install"));
                }
            }
        }
        Ok(Self { _held: held })
    }
}

/// Event devices of the HID device at a node such as /dev/hidraw3, by what stands for /sys and /dev.
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
    let events = inputs.iter().flat_map(|input| names(input, "event"));
    events
        .filter_map(|event| Some(dev.join("input").join(event.file_name()?)))
        .collect()
}
