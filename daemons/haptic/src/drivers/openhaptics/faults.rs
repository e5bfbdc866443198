//! Meaning of the library's errors: those that end the device, and those that are only reported.
//!
//! The vendor's `hduIsSchedulerError` lists the errors that end it, `hduIsForceError` those that do not; the latter
//! leaves out 0x202, a force that changes too fast, which the device bears by itself like its sisters: it cuts the
//! amplifiers and lets the force come up anew. Any unknown error ends the device: a hand is at the other end.

use maulstick_rig::UserError;

use super::abi::{ErrorInfo, error};
use crate::device::driver::DeviceError;

/// Error that is only reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notice {
    /// 0x200.
    WarmMotors,
    /// 0x201.
    TooMuchForce,
    /// 0x202.
    TooFastForce,
    /// 0x203.
    TooFastHand,
    /// 0x204.
    OtherForce,
    /// A model with a dead man's switch of which the library says nothing.
    NoSwitch,
}

impl Notice {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::WarmMotors,
        Self::TooMuchForce,
        Self::TooFastForce,
        Self::TooFastHand,
        Self::OtherForce,
        Self::NoSwitch,
    ];

    /// Its bit in a mask.
    #[must_use]
    pub fn bit(self) -> u32 {
        1 << self as u32
    }

    /// Message to the user.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::WarmMotors => {
                "the motors are warm: the device gives less force until they have cooled"
            }
            Self::TooMuchForce => {
                "a force was beyond the device's largest: it cut the motors for a moment"
            }
            Self::TooFastForce => {
                "a force changed faster than the device lets it: it cut the motors for a moment"
            }
            Self::TooFastHand => {
                "the stylus was faster than the device lets it: it cut the motors for a moment"
            }
            Self::OtherForce => {
                "the device had a trouble with its motors and cut them for a moment"
            }
            Self::NoSwitch => {
                "the library does not say whether the stylus is held, so there is no force: install the driver that fits this model"
            }
        }
    }
}

/// Effect of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// The servo goes on.
    Told(Notice),
    /// The device is closed, and looked for again.
    Ends,
}

/// The class of a code.
#[must_use]
pub fn class(code: u32) -> Class {
    match code {
        error::WARM_MOTORS => Class::Told(Notice::WarmMotors),
        error::EXCEEDED_MAX_FORCE => Class::Told(Notice::TooMuchForce),
        error::EXCEEDED_MAX_FORCE_IMPULSE => Class::Told(Notice::TooFastForce),
        error::EXCEEDED_MAX_VELOCITY => Class::Told(Notice::TooFastHand),
        error::FORCE_ERROR => Class::Told(Notice::OtherForce),
        _ => Class::Ends,
    }
}

/// True if a call was wrong, rather than the device: the reply of a model that lacks a feature.
#[must_use]
pub fn is_wrong_call(code: u32) -> bool {
    (error::INVALID_ENUM..=error::INVALID_INPUT_TYPE).contains(&code)
}

/// Meaning of a code that ends the device.
#[must_use]
pub fn device_error(code: u32) -> DeviceError {
    let (what, help) = match code {
        error::DEVICE_FAULT => (
            "the haptic device reports a fault of its own",
            "switch it off and on, and try the vendor's diagnostic program",
        ),
        error::DEVICE_ALREADY_INITIATED => (
            "the haptic device is in use by another program",
            "end the other program",
        ),
        error::COMM_ERROR => (
            "the haptic device does not answer",
            "see that it is plugged in and switched on, and that you may use its port",
        ),
        error::COMM_CONFIG_ERROR => (
            "the port of the haptic device cannot be set up",
            "see that you may use the port, and run the vendor's setup program",
        ),
        error::TIMER_ERROR => (
            "the clock of the vendor's scheduler fails",
            "allow real-time priority: 'rtprio 99' for your user in /etc/security/limits.conf",
        ),
        error::BAD_HANDLE => (
            "the vendor's library does not know the haptic device any more",
            "plug it in again; if that does not help, restart the rig",
        ),
        error::INVALID_ENUM..=error::INVALID_INPUT_TYPE => (
            "the vendor's library does not understand what it is asked",
            "install OpenHaptics 3.0 or newer with a driver that fits the device",
        ),
        error::ILLEGAL_BEGIN..=error::FRAME_ERROR => (
            "the vendor's library has lost count of its frames",
            "restart the rig; if it comes again, report it with the device's model",
        ),
        error::INVALID_PRIORITY | error::SCHEDULER_FULL => (
            "the vendor's scheduler does not take the servo",
            "end other programs that use the haptic device",
        ),
        error::INVALID_LICENSE => (
            "OpenHaptics has no valid licence",
            "install the licence that came with it, and set OH_SDK_LICENSE_PATH",
        ),
        _ => (
            "the vendor's library reports an error that is not known",
            "try the vendor's diagnostic program; the number is in its manual",
        ),
    };
    DeviceError {
        what,
        code: i64::from(code),
        help,
    }
}

/// An error on opening; `words` is what the library says of it.
#[must_use]
pub fn fault(error: ErrorInfo, words: &str) -> UserError {
    let device_error = device_error(error.code);
    let internal = error.internal;
    UserError::failure(format!(
        "{device_error}: the library says '{words}' (internal {internal})"
    ))
    .help(device_error.help)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_told_and_all_else_ends_the_device() {
        let told: Vec<u32> = (1..0x1_0000)
            .filter(|code| matches!(class(*code), Class::Told(_)))
            .collect();
        assert_eq!(told, [0x200, 0x201, 0x202, 0x203, 0x204]);
        let mask = Notice::ALL
            .iter()
            .fold(0, |mask, notice| mask | notice.bit());
        assert_eq!(mask, 0b11_1111, "each has a bit of its own");
    }

    #[test]
    fn codes_that_are_known_have_words_of_their_own() {
        let unknown = device_error(0x7777).what;
        for code in [
            0x100, 0x103, 0x104, 0x300, 0x301, 0x302, 0x303, 0x304, 0x400, 0x402, 0x500, 0x501,
            0x600,
        ] {
            assert_ne!(device_error(code).what, unknown, "{code:#x}");
            assert_eq!(device_error(code).code, i64::from(code));
        }
        assert_eq!(device_error(0x305).what, unknown);
    }
}
