//! Search for the serial port of a stylus.

use std::path::Path;

use maulstick_rig::UserError;
use serialport::{SerialPortInfo, SerialPortType};

/// USB vendor of the Teensy boards that the devices are built around.
const VENDOR: u16 = 0x16C0;
/// USB products of a Teensy that has a serial port.
const PRODUCTS: std::ops::RangeInclusive<u16> = 0x0483..=0x048F;

/// The serial ports of this machine.
///
/// # Errors
/// A [`UserError`] if the system does not list them.
pub fn ports() -> Result<Vec<SerialPortInfo>, UserError> {
    // On a system without any terminals serialport panics.
    if cfg!(target_os = "linux") && !Path::new("/sys/class/tty").is_dir() {
        return Ok(Vec::new());
    }
    serialport::available_ports().map_err(|error| {
        UserError::failure(format!("serial ports cannot be listed: {error}"))
            .help("name the stylus' port as the device's `address`")
    })
}

/// The reason why no port is known to be a stylus'.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FindError {
    /// None of these ports is.
    Absent(Vec<SerialPortInfo>),
    /// Each of these may be.
    Several(Vec<SerialPortInfo>),
}

impl From<FindError> for UserError {
    fn from(error: FindError) -> Self {
        match error {
            FindError::Absent(ports) => {
                let help = if ports.is_empty() {
                    "plug it in; this machine has no serial port now".to_owned()
                } else {
                    format!(
                        "plug it in, or name its port as the device's `address`; there are: {}",
                        listed(&ports)
                    )
                };
                Self::failure("no WoodenHaptics or Polhem stylus is plugged in").help(help)
            }
            FindError::Several(ports) => Self::failure(format!(
                "several ports may be a WoodenHaptics or Polhem stylus: {}",
                listed(&ports)
            ))
            .help("name one as the device's `address`"),
        }
    }
}

/// The one of `ports` that a stylus is at.
///
/// # Errors
/// [`FindError`].
pub fn only(ports: &[SerialPortInfo]) -> Result<&str, FindError> {
    let fits: Vec<&SerialPortInfo> = ports.iter().filter(|port| fits(port)).collect();
    match fits[..] {
        [port] => Ok(&port.port_name),
        [] => Err(FindError::Absent(ports.to_vec())),
        _ => Err(FindError::Several(fits.into_iter().cloned().collect())),
    }
}

fn fits(port: &SerialPortInfo) -> bool {
    matches!(&port.port_type, SerialPortType::UsbPort(usb) if is_board(usb.vid, usb.pid))
}

/// True for the USB vendor and product numbers of a board that a stylus may be built around.
#[must_use]
pub fn is_board(vendor: u16, product: u16) -> bool {
    vendor == VENDOR && PRODUCTS.contains(&product)
}

fn listed(ports: &[SerialPortInfo]) -> String {
    let words: Vec<String> = ports
        .iter()
        .map(|port| match &port.port_type {
            SerialPortType::UsbPort(usb) => {
                let product = usb.product.as_deref().unwrap_or("USB");
                let (name, vid, pid) = (&port.port_name, usb.vid, usb.pid);
                format!("{name} ({product} {vid:04X}:{pid:04X})")
            }
            _ => port.port_name.clone(),
        })
        .collect();
    words.join(", ")
}

#[cfg(test)]
mod tests {
    use serialport::UsbPortInfo;

    use super::*;

    fn usb(name: &str, vid: u16, pid: u16) -> SerialPortInfo {
        SerialPortInfo {
            port_name: name.into(),
            port_type: SerialPortType::UsbPort(UsbPortInfo {
                vid,
                pid,
                serial_number: None,
                manufacturer: None,
                product: Some("USB Serial".into()),
            }),
        }
    }

    #[test]
    fn the_one_teensy_among_other_ports_is_the_stylus() {
        let other = SerialPortInfo {
            port_name: "/dev/ttyS0".into(),
            port_type: SerialPortType::Unknown,
        };
        let modem = usb("/dev/ttyACM0", 0x2341, 0x0483);
        let programmer = usb("/dev/ttyACM1", 0x16C0, 0x05DC);
        let teensy = usb("/dev/ttyACM2", 0x16C0, 0x0487);
        let ports = [other, modem, programmer, teensy];
        assert_eq!(only(&ports).ok(), Some("/dev/ttyACM2"));

        for others in [&ports[..3], &[]] {
            assert_eq!(only(others), Err(FindError::Absent(others.to_vec())));
        }
    }

    #[test]
    fn of_two_teensies_the_painter_names_one() {
        let ports = [
            usb("/dev/ttyACM0", 0x16C0, 0x0483),
            usb("/dev/ttyACM1", 0x16C0, 0x048F),
        ];
        assert_eq!(only(&ports), Err(FindError::Several(ports.to_vec())));
    }

    #[test]
    fn the_ports_of_this_machine_can_be_asked_for() {
        assert!(ports().is_ok());
    }
}
