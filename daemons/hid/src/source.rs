//! Where reports come from: a device that is plugged in. Above this decoding begins, below it hidapi ends,
//! so tests stand a device of their own here.

use std::fmt;
use std::time::Duration;

use maulstick_rig::Fault;

/// What a HID device says that it is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Identity {
    /// 3 USB, 5 Bluetooth, as in Linux's `input.h`.
    pub bus: u16,
    /// Of its maker.
    pub vendor: u16,
    /// Of its kind.
    pub product: u16,
    /// In words.
    pub name: String,
    /// Its path below /dev, or where a recorded one was plugged in.
    pub place: String,
}

impl fmt::Display for Identity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04x}:{:04x}", self.vendor, self.product)?;
        match self.name.is_empty() {
            true => Ok(()),
            false => write!(f, " {}", self.name),
        }
    }
}

/// A device that is open.
pub trait HidSource: Send {
    /// Its report descriptor.
    fn descriptor(&self) -> &[u8];
    /// Waits at most `limit` for a report; how many bytes of `report` it has, 0 where none came.
    ///
    /// # Errors
    /// A [`Fault`] where the device is gone.
    fn read(&mut self, report: &mut [u8], limit: Duration) -> Result<usize, Fault>;
    /// Sends a report to the device, its number first.
    ///
    /// # Errors
    /// A [`Fault`] where it does not take it.
    fn write(&mut self, report: &[u8]) -> Result<(), Fault>;
}

/// A device that is plugged in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// What it is.
    pub identity: Identity,
    /// Pages and numbers of the usages of its collections, which anyone may read.
    pub usages: Vec<(u16, u16)>,
}

/// Where devices are plugged in.
pub trait Ports: Send {
    /// What is there now.
    ///
    /// # Errors
    /// A [`Fault`] where the system does not say.
    fn list(&mut self) -> Result<Vec<Found>, Fault>;
    /// Opens a device.
    ///
    /// # Errors
    /// A [`Fault`] that says why it cannot be opened, and what to do.
    fn open(&mut self, found: &Found) -> Result<Box<dyn HidSource>, Fault>;
}
