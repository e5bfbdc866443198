//! The event devices of this machine. What they are is in sysfs, where everybody may read it.

use std::collections::VecDeque;
use std::os::fd::AsFd as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use evdev::{AbsoluteAxisCode, Device, KeyCode};
use maulstick_rig::UserError;
use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};

use super::capabilities::{Axis, Capabilities};
use super::frame::{self, kind};
use super::pen::EvdevPen;
use crate::device_source::{Found, HidSource, Identity, Ports};
use crate::hidraw::closed;

/// What a pen is called among the collections of HID: digitizer, pen.
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
        // How far its axes go is told only to those who may open it.
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

/// The numbers of the bits that are set: hexadecimal words of 64 bits, the highest first.
fn bits(text: &str) -> Vec<u16> {
    let words = text.split_whitespace().rev().enumerate();
    let of = |(place, word): (usize, &str)| {
        let word = u64::from_str_radix(word, 16).unwrap_or(0);
        let set = (0..64_u16).filter(move |bit| word >> bit & 1 == 1);
        let first = u16::try_from(64 * place).unwrap_or(u16::MAX);
        set.map(move |bit| first.saturating_add(bit))
    };
    words.flat_map(of).collect()
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

    fn open(&mut self, found: &Found) -> Result<Box<dyn HidSource>, UserError> {
        let identity = &found.identity;
        let opened = Device::open(&identity.place).and_then(|mut device| {
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
    device: Device,
    capabilities: Vec<u8>,
    name: String,
    /// What has come and is not read, one time after the other, and what came of the newest.
    frames: VecDeque<Vec<u8>>,
    begun: Vec<u8>,
}

impl EventSource {
    /// The first frame is what the device holds now: a pen may be near already.
    fn new(device: Device, name: String) -> std::io::Result<Self> {
        let (axes, keys) = (device.get_abs_state()?, device.get_key_state()?);
        let supported = device.supported_absolute_axes();
        let codes = supported.into_iter().flat_map(|all| all.iter());
        let known = device.supported_keys();
        let mut capabilities = Capabilities {
            axes: Vec::new(),
            keys: known
                .into_iter()
                .flat_map(|all| all.iter())
                .map(|key| key.0)
                .collect(),
        };
        let mut now = Vec::new();
        for AbsoluteAxisCode(code) in codes {
            let Some(told) = axes.get(usize::from(code)) else {
                continue;
            };
            capabilities.axes.push(Axis {
                code,
                range: [told.minimum, told.maximum],
                resolution: told.resolution,
            });
            let (kind, value) = (kind::ABS, told.value);
            frame::push(&mut now, frame::Event { kind, code, value });
        }
        for KeyCode(code) in keys.iter() {
            let (kind, value) = (kind::KEY, 1);
            frame::push(&mut now, frame::Event { kind, code, value });
        }
        Ok(Self {
            capabilities: capabilities.to_bytes(),
            device,
            name,
            frames: VecDeque::from([now]),
            begun: Vec::new(),
        })
    }

    /// Takes in what has come; whether anything could.
    fn take_in(&mut self, limit: Duration) -> std::io::Result<()> {
        let timeout = PollTimeout::try_from(limit).unwrap_or(PollTimeout::MAX);
        let mut waiting = [PollFd::new(self.device.as_fd(), PollFlags::POLLIN)];
        match poll(&mut waiting, timeout) {
            Ok(0) | Err(Errno::EINTR) => return Ok(()),
            Ok(_) => {}
            Err(error) => return Err(error.into()),
        }
        for event in self.device.fetch_events()? {
            let (kind, code) = (event.event_type().0, event.code());
            if kind == kind::SYN {
                let whole = std::mem::take(&mut self.begun);
                if !whole.is_empty() {
                    self.frames.push_back(whole);
                }
                continue;
            }
            let value = event.value();
            frame::push(&mut self.begun, frame::Event { kind, code, value });
        }
        Ok(())
    }
}

impl HidSource for EventSource {
    fn descriptor(&self) -> &[u8] {
        &self.capabilities
    }

    fn read(&mut self, report: &mut [u8], limit: Duration) -> Result<usize, UserError> {
        if self.frames.is_empty() {
            self.take_in(limit).map_err(|error| {
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
