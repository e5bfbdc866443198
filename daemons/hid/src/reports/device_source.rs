//! Interface to plugged-in devices, above hidapi and below decoding; tests put a fake device here.

use std::fmt;
use std::path::Path;
use std::time::Duration;

use maulstick_rig::UserError;

/// Identity of a HID device.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Identity {
    /// 3 USB, 5 Bluetooth, as in Linux's `input.h`.
    pub bus: u16,
    /// USB number of the maker.
    pub vendor: u16,
    /// USB number of the product.
    pub product: u16,
    /// Product name.
    pub name: String,
    /// Path below /dev, or the port of a recorded device.
    pub place: String,
}

impl fmt::Display for Identity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04x}:{:04x}", self.vendor, self.product)?;
        if self.name.is_empty() {
            Ok(())
        } else {
            write!(f, " {}", self.name)
        }
    }
}

/// An open device.
pub trait HidSource: Send {
    /// Report descriptor.
    fn descriptor(&self) -> &[u8];
    /// Waits at most `limit` for a report; returns its length in `report`, bytes, or 0 if none came.
    ///
    /// # Errors
    /// [`UserError`] if the device is gone.
    fn read(&mut self, report: &mut [u8], limit: Duration) -> Result<usize, UserError>;
    /// Sends a report to the device, its number first.
    ///
    /// # Errors
    /// [`UserError`] if the device refuses it.
    fn write(&mut self, report: &[u8]) -> Result<(), UserError>;
    /// Takes the device out of the system's hands while it is open: no pointer follows it.
    ///
    /// # Errors
    /// [`UserError`] if that is not allowed; the device can be read all the same.
    fn grab(&mut self) -> Result<(), UserError> {
        Ok(())
    }
}

/// A device that is plugged in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// Identity of the device.
    pub identity: Identity,
    /// Usage pages and usages of its collections, which need no permission to read.
    pub usages: Vec<(u16, u16)>,
}

/// The ports of the machine.
pub trait Ports: Send {
    /// Lists the devices that are plugged in.
    ///
    /// # Errors
    /// [`UserError`] if the system cannot list them.
    fn list(&mut self) -> Result<Vec<Found>, UserError>;
    /// The folder that stands for /dev, in which a node appears where a device is plugged in; absent if none does.
    fn dev(&self) -> Option<&Path> {
        None
    }
    /// Opens a device.
    ///
    /// # Errors
    /// [`UserError`] with the reason and the remedy.
    fn open(&mut self, found: &Found) -> Result<Box<dyn HidSource>, UserError>;
}
