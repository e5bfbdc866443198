//! A serial port as a [`Wire`]: opened by the crate `serialport`, read and written without waiting and,
//! unlike there, without an allocation where nothing has come.

#![allow(
    unsafe_code,
    reason = "a call of the system that no crate wraps, and the descriptor that serialport owns"
)]

use std::os::fd::{AsRawFd, BorrowedFd};

use maulstick_rig::UserError;
use nix::errno::Errno;
use nix::fcntl::{FcntlArg, OFlag, fcntl};
use serialport::{ClearBuffer, ErrorKind, SerialPort, TTYPort};

use super::link::Wire;

/// Baud rate of the devices' own host; USB ignores it.
const BAUD: u32 = 115_200;

/// An open serial port that nobody else may open.
#[derive(Debug)]
pub struct Port {
    port: TTYPort,
}

impl Port {
    /// Opens a port by its path.
    ///
    /// # Errors
    /// A [`UserError`]: it is missing, it is another user's, it is in use, it is no serial port.
    pub fn open(path: &str) -> Result<Self, UserError> {
        let port = serialport::new(path, BAUD)
            .open_native()
            .map_err(|error| refused(path, &error))?;
        let port = Self { port };
        fcntl(port.descriptor(), FcntlArg::F_SETFL(OFlag::O_NONBLOCK)).map_err(|errno| {
            UserError::failure(format!("{path} cannot be read without waiting: {errno}"))
                .help("name a serial port as the device's `address`")
        })?;
        // Bytes for the port's former user; if they cannot be discarded, they are no answer of ours.
        port.port.clear(ClearBuffer::All).ok();
        port.lower_latency();
        port.close_at_once();
        Ok(port)
    }

    fn descriptor(&self) -> BorrowedFd<'_> {
        // SAFETY: the port owns the descriptor, and is borrowed for as long.
        unsafe { BorrowedFd::borrow_raw(self.port.as_raw_fd()) }
    }

    /// Has the driver hand on each byte as it comes, where there is a choice and it is ours: chips of
    /// FTDI's gather them for 16 ms otherwise.
    #[cfg(target_os = "linux")]
    fn lower_latency(&self) {
        self.set(|settings| settings.flags |= ASYNC_LOW_LATENCY);
    }

    /// Has the port not wait, half a minute by default, for what a device that hangs does not take. A
    /// setting of its own: most drivers permit it to root only, and refuse all that is set with it.
    #[cfg(target_os = "linux")]
    fn close_at_once(&self) {
        self.set(|settings| settings.closing_wait = ASYNC_CLOSING_WAIT_NONE);
    }

    #[cfg(target_os = "linux")]
    fn set(&self, change: impl FnOnce(&mut SerialSettings)) {
        let mut settings = SerialSettings::default();
        // SAFETY: the kernel fills the structure, which is laid out as its `serial_struct`.
        let got = unsafe {
            nix::libc::ioctl(
                self.port.as_raw_fd(),
                nix::libc::TIOCGSERIAL,
                &raw mut settings,
            )
        };
        if got != 0 {
            return;
        }
        change(&mut settings);
        // SAFETY: the kernel reads the structure that it has just filled.
        unsafe {
            nix::libc::ioctl(
                self.port.as_raw_fd(),
                nix::libc::TIOCSSERIAL,
                &raw const settings,
            );
        }
    }

    #[cfg(not(target_os = "linux"))]
    fn lower_latency(&self) {}

    #[cfg(not(target_os = "linux"))]
    fn close_at_once(&self) {}
}

impl Wire for Port {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Errno> {
        nix::unistd::read(self.descriptor(), bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<usize, Errno> {
        nix::unistd::write(self.descriptor(), bytes)
    }
}

/// `ASYNC_LOW_LATENCY` of linux/tty_flags.h.
#[cfg(target_os = "linux")]
const ASYNC_LOW_LATENCY: i32 = 1 << 13;

/// `ASYNC_CLOSING_WAIT_NONE` of linux/serial.h.
#[cfg(target_os = "linux")]
const ASYNC_CLOSING_WAIT_NONE: u16 = 65_535;

/// `struct serial_struct` of linux/serial.h.
#[cfg(target_os = "linux")]
#[repr(C)]
#[derive(Debug)]
struct SerialSettings {
    kind: i32,
    line: i32,
    port: u32,
    irq: i32,
    flags: i32,
    fifo: i32,
    custom_divisor: i32,
    baud_base: i32,
    close_delay: u16,
    io_type: u8,
    reserved: u8,
    hub6: i32,
    closing_wait: u16,
    closing_wait2: u16,
    memory: SerialMemory,
}

/// Registers of a port that is mapped into memory: the last fields of `struct serial_struct`.
#[cfg(target_os = "linux")]
#[repr(C)]
#[derive(Debug)]
struct SerialMemory {
    base: *mut u8,
    register_shift: u16,
    port_high: u32,
    map_base: nix::libc::c_ulong,
}

#[cfg(target_os = "linux")]
impl Default for SerialSettings {
    fn default() -> Self {
        // SAFETY: numbers and a pointer that is never followed; all may be zero.
        unsafe { std::mem::zeroed() }
    }
}

/// The error of a port that cannot be opened.
#[must_use]
pub fn refused(path: &str, error: &serialport::Error) -> UserError {
    use std::io::ErrorKind as Io;
    match error.kind() {
        ErrorKind::Io(Io::NotFound) => UserError::failure(format!("there is no {path}"))
            .help("plug the stylus in, or leave `address` out: its port is found by itself"),
        ErrorKind::Io(Io::PermissionDenied) => {
            UserError::failure(format!("{path} may not be opened by you")).help(
                "have `maulstick device allow` install the rule, or join the group \
                 dialout and log in anew",
            )
        }
        ErrorKind::NoDevice => UserError::failure(format!("{path} is in use by another program"))
            .help("end the other program; ModemManager tries new ports for some seconds"),
        _ => UserError::failure(format!("{path} is no serial port: {}", error.description))
            .help("name a serial port as the device's `address`, such as /dev/ttyACM0"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reason_has_its_own_error() {
        use std::io::ErrorKind::{NotFound, PermissionDenied};
        let faults = [
            ErrorKind::Io(PermissionDenied),
            ErrorKind::Io(NotFound),
            ErrorKind::NoDevice,
            ErrorKind::Unknown,
        ]
        .map(|kind| {
            let error = serialport::Error::new(kind, "Not a typewriter");
            refused("/dev/ttyACM0", &error)
        });
        for (place, fault) in faults.iter().enumerate() {
            assert!(fault.what.contains("/dev/ttyACM0"), "{fault}");
            let help = fault.help.as_ref().expect("what to do");
            let others = &faults[..place];
            assert!(others.iter().all(|other| other.help.as_ref() != Some(help)));
        }
    }
}
