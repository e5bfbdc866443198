//! The event devices of this machine. What they are is in sysfs, where everybody may read it.

use std::collections::VecDeque;
use std::os::fd::AsFd as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use evdev::raw_stream::RawDevice;
use evdev::{AbsoluteAxisCode, KeyCode};
use maulstick_rig::UserError;
use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};

use super::capabilities::{Axis, Capabilities, bits};
use super::frame::{self, kind};
use super::pen::EvdevPen;
use crate::device_source::{Found, HidSource, Identity, Ports};
use crate::hidraw::closed;

/// Events of the type SYN: the end of a frame, and the loss of events.
const SYN_REPORT: u16 = 0;
const SYN_DROPPED: u16 = 3;
/// Usage of a pen among the collections of HID: digitizer, pen.
const PEN: (u16, u16) = (0x0D, 0x02);

/// Event devices below what stands for /sys and /dev.
#[derive(Clone, Debug)]
pub struct EventDevices {
    /// `/sys`.
    pub sys: PathBuf,
    /// `/dev`.
    pub dev: PathBuf,
}

impl EventDevices {
    /// Those of this machine.
    #[must_use]
    pub fn here() -> Self {
        Self {
            sys: "/sys".into(),
            dev: "/dev".into(),
        }
    }

    /// The device of an entry of `class/input`, unless the entry is something else.
    fn found(&self, entry: &Path) -> Option<Found> {
        let node = entry.file_name()?.to_str()?;
        if !node.starts_with("event") {
            return None;
        }
        let device = entry.join("device");
        let text = |file: &str| {
            let bytes = std::fs::read(device.join(file)).ok()?;
            Some(String::from_utf8_lossy(&bytes).trim().to_owned())
        };
        let number = |file: &str| u16::from_str_radix(&text(file)?, 16).ok();
        let keys = bits(&text("capabilities/key").unwrap_or_default());
        let axes = bits(&text("capabilities/abs").unwrap_or_default());
        // The ranges of its axes are known only to those who may open it.
        let seems = Capabilities {
            axes: axes.into_iter().map(movable).collect(),
            keys,
        };
        Some(Found {
            identity: Identity {
                bus: number("id/bustype").unwrap_or_default(),
                vendor: number("id/vendor")?,
                product: number("id/product")?,
                name: text("name").unwrap_or_default(),
                place: self.dev.join("input").join(node).display().to_string(),
            },
            usages: EvdevPen::of(&seems).map(|_| PEN).into_iter().collect(),
        })
    }
}

/// An axis of which nothing but its code is known.
fn movable(code: u16) -> Axis {
    Axis {
        code,
        range: [0, 1],
        resolution: 0,
    }
}

impl Ports for EventDevices {
    fn list(&mut self) -> Result<Vec<Found>, UserError> {
        let entries = std::fs::read_dir(self.sys.join("class/input"));
        let entries = entries.into_iter().flatten().flatten();
        let mut found: Vec<Found> = entries
            .filter_map(|entry| self.found(&entry.path()))
            .collect();
        // event9 before event10.
        found.sort_by(|a, b| {
            let [a, b] = [a, b].map(|found| &found.identity.place);
            (a.len(), a).cmp(&(b.len(), b))
        });
        Ok(found)
    }

    fn dev(&self) -> Option<&Path> {
        Some(&self.dev)
    }

    fn open(&mut self, found: &Found) -> Result<Box<dyn HidSource>, UserError> {
        let identity = &found.identity;
        let opened = RawDevice::open(&identity.place).and_then(|mut device| {
            // Of a device that another program has grabbed nothing would ever come.
            device.grab()?;
            EventSource::new(device, identity.to_string())
        });
        match opened {
            Ok(source) => Ok(Box::new(source)),
            Err(error) => Err(closed(identity, &error)),
        }
    }
}

/// An open event device that nobody else hears.
struct EventSource {
    device: RawDevice,
    capabilities: Vec<u8>,
    name: String,
    /// Frames that have come and are not read, in order of time, and the events of the newest.
    frames: VecDeque<Vec<u8>>,
    begun: Vec<u8>,
    /// Events were lost: what comes until the next end of a frame is of no use.
    is_behind: bool,
}

impl EventSource {
    /// The first frame is what the device holds now: a pen may be near already.
    fn new(device: RawDevice, name: String) -> std::io::Result<Self> {
        let values = device.get_abs_state()?;
        let axes = axis_codes(&device).filter_map(|code| {
            let axis = values.get(usize::from(code))?;
            Some(Axis {
                code,
                range: [axis.minimum, axis.maximum],
                resolution: axis.resolution,
            })
        });
        let capabilities = Capabilities {
            axes: axes.collect(),
            keys: key_codes(&device).collect(),
        };
        Ok(Self {
            capabilities: capabilities.to_bytes(),
            frames: VecDeque::from([snapshot(&device)?]),
            device,
            name,
            begun: Vec::new(),
            is_behind: false,
        })
    }

    /// Reads pending events into frames.
    fn read_events(&mut self, limit: Duration) -> std::io::Result<()> {
        let timeout = PollTimeout::try_from(limit).unwrap_or(PollTimeout::MAX);
        let mut waiting = [PollFd::new(self.device.as_fd(), PollFlags::POLLIN)];
        match poll(&mut waiting, timeout) {
            Ok(0) | Err(Errno::EINTR) => return Ok(()),
            Ok(_) => {}
            Err(error) => return Err(error.into()),
        }
        let events: Vec<_> = self.device.fetch_events()?.collect();
        for event in events {
            let (kind, code, value) = (event.event_type().0, event.code(), event.value());
            match (kind, code) {
                (kind::SYN, SYN_DROPPED) => self.is_behind = true,
                (kind::SYN, SYN_REPORT) => {
                    let mut whole = std::mem::take(&mut self.begun);
                    if std::mem::take(&mut self.is_behind) {
                        whole = snapshot(&self.device)?;
                    }
                    if !whole.is_empty() {
                        self.frames.push_back(whole);
                    }
                }
                (kind::SYN, _) => {}
                _ => frame::push(&mut self.begun, frame::Event { kind, code, value }),
            }
        }
        Ok(())
    }
}

fn axis_codes(device: &RawDevice) -> impl Iterator<Item = u16> {
    let axes = device.supported_absolute_axes().into_iter();
    axes.flat_map(|all| all.iter())
        .map(|AbsoluteAxisCode(code)| code)
}

fn key_codes(device: &RawDevice) -> impl Iterator<Item = u16> {
    let keys = device.supported_keys().into_iter();
    keys.flat_map(|all| all.iter()).map(|KeyCode(code)| code)
}

/// A frame of all that a device holds: its axes, and its keys, down or up.
fn snapshot(device: &RawDevice) -> std::io::Result<Vec<u8>> {
    let (axes, keys) = (device.get_abs_state()?, device.get_key_state()?);
    let mut frame = Vec::new();
    for code in axis_codes(device) {
        if let Some(axis) = axes.get(usize::from(code)) {
            let (kind, value) = (kind::ABS, axis.value);
            frame::push(&mut frame, frame::Event { kind, code, value });
        }
    }
    for code in key_codes(device) {
        let (kind, value) = (kind::KEY, i32::from(keys.contains(KeyCode(code))));
        frame::push(&mut frame, frame::Event { kind, code, value });
    }
    Ok(frame)
}

impl HidSource for EventSource {
    fn descriptor(&self) -> &[u8] {
        &self.capabilities
    }

    fn read(&mut self, report: &mut [u8], limit: Duration) -> Result<usize, UserError> {
        if self.frames.is_empty() {
            self.read_events(limit).map_err(|error| {
                let name = &self.name;
                let what = format!("{name} was unplugged, or does not answer: {error}");
                UserError::failure(what).help("plug it in again")
            })?;
        }
        let Some(frame) = self.frames.pop_front() else {
            return Ok(0);
        };
        let length = frame.len().min(report.len());
        report[..length].copy_from_slice(&frame[..length]);
        Ok(length)
    }

    fn write(&mut self, _report: &[u8]) -> Result<(), UserError> {
        Err(UserError::usage(format!("{} takes no orders", self.name)))
    }
}
