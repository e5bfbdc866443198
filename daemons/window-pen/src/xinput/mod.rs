//! Pens of X11: the valuators of XInput 2.
//!
//! A pen is a slave pointer with a valuator called *Abs Pressure*, as the drivers `wacom` and `libinput` name it. Its own
//! events come beside those of the pointer that it moves, each with the server's time.

mod device;

use std::collections::BTreeMap;
use std::os::fd::{AsFd, BorrowedFd};
use std::time::Duration;

use maulstick_rig::UserError;
use x11rb::connection::Connection as _;
use x11rb::errors::{ConnectionError, ReplyError};
use x11rb::protocol::xinput::{
    ChangeReason, ConnectionExt as _, DeviceType, EventMask, XIEventMask, XIGetPropertyItems,
};
use x11rb::protocol::xproto::{Atom, AtomEnum, ConnectionExt as _, Window};
use x11rb::protocol::{ErrorKind, Event};
use x11rb::rust_connection::RustConnection;

pub use self::device::{Labels, NearTool, XinputDevice};
use crate::reading::{PenReading, Tool};
use crate::source::{Source, gone, readable};

/// All devices, in a selection of events.
const ALL: u16 = 0;
/// The `wacom` driver's property of tools: five numbers, of which the fourth and the fifth are serial and kind of the tool
/// that is near, 0 for none.
const SERIALS: &str = "Wacom Serial IDs";

/// True if the X server that `DISPLAY` names reports pens.
///
/// # Errors
/// A [`UserError`] where the server is away.
pub fn tells_of_pens() -> Result<bool, UserError> {
    let away = |error: &dyn std::fmt::Display| {
        UserError::failure(format!("no X server answers: {error}"))
            .help("start it from a terminal of a graphical session")
    };
    let (connection, _) = x11rb::connect(None).map_err(|error| away(&error))?;
    has_pens(&connection).map_err(|error| away(&error))
}

/// True if a server has XInput 2.2; one without any refuses the question.
fn has_pens(connection: &RustConnection) -> Result<bool, ConnectionError> {
    let version = connection.xinput_xi_query_version(2, 2)?.reply();
    Ok(version.is_ok_and(|version| (version.major_version, version.minor_version) >= (2, 2)))
}

/// Pens of an X server over a window.
pub struct XinputPens {
    connection: RustConnection,
    window: Window,
    labels: Labels,
    serials: Atom,
    devices: BTreeMap<u16, XinputDevice>,
}

impl XinputPens {
    /// The pens over a window of the server that `DISPLAY` names.
    ///
    /// # Errors
    /// A [`UserError`] where the server is away or lacks XInput 2.2.
    pub fn new(window: Window) -> Result<Self, UserError> {
        let (connection, screen) = x11rb::connect(None).map_err(|error| gone(&error))?;
        if !has_pens(&connection).map_err(|error| gone(&error))? {
            return Err(
                UserError::failure("this X server does not report pens (XInput 2.2)").help(
                    "the pen paints as a mouse does; to use its pressure, add its tablet to the rig (`maulstick device list` says how)",
                ),
            );
        }
        let atom = |name: &str| -> Result<Atom, ReplyError> {
            Ok(connection
                .intern_atom(false, name.as_bytes())?
                .reply()?
                .atom)
        };
        let labels = Labels {
            pressure: atom("Abs Pressure").map_err(|error| gone(&error))?,
            tilt: [
                atom("Abs Tilt X").map_err(|error| gone(&error))?,
                atom("Abs Tilt Y").map_err(|error| gone(&error))?,
            ],
            wheel: atom("Abs Wheel").map_err(|error| gone(&error))?,
        };
        let serials = atom(SERIALS).map_err(|error| gone(&error))?;
        let root = connection.setup().roots[screen].root;
        let mut pens = Self {
            connection,
            window,
            labels,
            serials,
            devices: BTreeMap::new(),
        };
        pens.select(
            root,
            ALL,
            XIEventMask::HIERARCHY | XIEventMask::DEVICE_CHANGED,
        )
        .and_then(|()| pens.find(0, &mut Vec::new()))
        .map_err(|error| gone(&error))?;
        Ok(pens)
    }

    fn select(&self, window: Window, device: u16, mask: XIEventMask) -> Result<(), ReplyError> {
        let mask = EventMask {
            deviceid: device,
            mask: vec![mask],
        };
        let selected = self.connection.xinput_xi_select_events(window, &[mask])?;
        selected.check()
    }

    /// Finds the pens that are attached, and asks for their events. Those that are known stay as they are; what has gone
    /// has left.
    fn find(&mut self, time_ms: u32, readings: &mut Vec<PenReading>) -> Result<(), ReplyError> {
        let found = self.connection.xinput_xi_query_device(ALL)?.reply()?.infos;
        let pens = found
            .iter()
            .filter(|info| info.type_ == DeviceType::SLAVE_POINTER);
        let mut before = std::mem::take(&mut self.devices);
        for info in pens {
            let Some(mut device) = XinputDevice::of(info, &self.labels) else {
                continue;
            };
            if let Some(known) = before.remove(&info.deviceid) {
                if known.is_same(&device) {
                    self.devices.insert(info.deviceid, known);
                    continue;
                }
                before.insert(info.deviceid, known);
            }
            let mask = XIEventMask::MOTION
                | XIEventMask::BUTTON_PRESS
                | XIEventMask::BUTTON_RELEASE
                | XIEventMask::PROPERTY;
            match self.select(self.window, info.deviceid, mask) {
                Ok(()) => {}
                // One that goes at this moment is reported again.
                Err(ReplyError::X11Error(error)) if error.error_kind == ErrorKind::XinputDevice => {
                    continue;
                }
                Err(error) => return Err(error),
            }
            device.set_near(self.near(info.deviceid)?);
            tracing::debug!("the pen '{}'", String::from_utf8_lossy(&info.name));
            self.devices.insert(info.deviceid, device);
        }
        for (_, mut gone) in before {
            gone.set_near(Some(NearTool::default()));
            readings.extend(gone.left(time_ms));
        }
        Ok(())
    }

    /// The tool that is near a device; `None` where its driver does not say.
    fn near(&self, device: u16) -> Result<Option<NearTool>, ReplyError> {
        let any = AtomEnum::ANY.into();
        let asked =
            self.connection
                .xinput_xi_get_property(device, false, self.serials, any, 0, 5)?;
        let items = match asked.reply() {
            Ok(reply) => reply.items,
            Err(ReplyError::X11Error(_)) => return Ok(None),
            Err(error) => return Err(error),
        };
        Ok(match items {
            XIGetPropertyItems::Data32(numbers) => match numbers[..] {
                [_, _, _, serial, kind, ..] => Some(NearTool { serial, kind }),
                _ => None,
            },
            _ => None,
        })
    }

    /// Takes in an event; readings are appended.
    fn take(&mut self, event: &Event, readings: &mut Vec<PenReading>) -> Result<(), ReplyError> {
        match event {
            Event::XinputMotion(event)
            | Event::XinputButtonPress(event)
            | Event::XinputButtonRelease(event) => {
                let device = self.devices.get_mut(&event.deviceid);
                readings.extend(device.and_then(|device| device.read(event)));
            }
            Event::XinputProperty(event) if event.property == self.serials => {
                let near = self.near(event.deviceid)?;
                if let Some(device) = self.devices.get_mut(&event.deviceid) {
                    device.set_near(near);
                    readings.extend(device.left(event.time));
                }
            }
            Event::XinputHierarchy(event) => self.find(event.time, readings)?,
            Event::XinputDeviceChanged(event) if event.reason == ChangeReason::DEVICE_CHANGE => {
                self.find(event.time, readings)?;
            }
            _ => {}
        }
        Ok(())
    }
}

impl Source for XinputPens {
    fn wait(
        &mut self,
        stop: BorrowedFd<'_>,
        timeout: Option<Duration>,
        readings: &mut Vec<PenReading>,
    ) -> Result<(), UserError> {
        let mut next = self.poll()?;
        if next.is_none() {
            readable(self.connection.stream().as_fd(), stop, timeout)?;
            next = self.poll()?;
        }
        while let Some(event) = next {
            self.take(&event, readings).map_err(|error| gone(&error))?;
            next = self.poll()?;
        }
        Ok(())
    }

    fn moves_pointer(&self) -> bool {
        true
    }
}

impl XinputPens {
    fn poll(&self) -> Result<Option<Event>, UserError> {
        let polled: Result<_, ConnectionError> = self.connection.poll_for_event();
        polled.map_err(|error| gone(&error))
    }
}

impl std::fmt::Debug for XinputPens {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("XinputPens")
            .field("devices", &self.devices)
            .finish_non_exhaustive()
    }
}

/// Identity of a device's tool among all those of the server.
fn tool(device: u16, serial: u32, eraser: bool) -> Tool {
    let number = match serial {
        0 => 1 << 40 | u64::from(device),
        serial => u64::from(serial),
    };
    Tool(number << 1 | u64::from(eraser))
}
