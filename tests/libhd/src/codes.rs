//! Numbers of the interface (hdDefines.h of OpenHaptics 3.4).

pub(crate) const SUCCESS: u32 = 0;
pub(crate) const INVALID_ENUM: u32 = 0x0100;
pub(crate) const INVALID_VALUE: u32 = 0x0101;
pub(crate) const INVALID_OPERATION: u32 = 0x0102;
pub(crate) const INVALID_INPUT_TYPE: u32 = 0x0103;
pub(crate) const BAD_HANDLE: u32 = 0x0104;
pub(crate) const DEVICE_ALREADY_INITIATED: u32 = 0x0301;
pub(crate) const COMM_ERROR: u32 = 0x0302;
pub(crate) const DEVICE_FAULT: u32 = 0x0300;
pub(crate) const ILLEGAL_BEGIN: u32 = 0x0400;
pub(crate) const ILLEGAL_END: u32 = 0x0401;
pub(crate) const INVALID_HANDLE: u32 = u32::MAX;

pub(crate) const BUTTONS: u32 = 0x2000;
pub(crate) const SAFETY_SWITCH: u32 = 0x2001;
pub(crate) const INKWELL_SWITCH: u32 = 0x2002;
pub(crate) const POSITION: u32 = 0x2050;
pub(crate) const VELOCITY: u32 = 0x2051;
pub(crate) const TRANSFORM: u32 = 0x2052;
pub(crate) const VERSION: u32 = 0x2500;
pub(crate) const MODEL: u32 = 0x2501;
pub(crate) const DRIVER: u32 = 0x2502;
pub(crate) const VENDOR: u32 = 0x2503;
pub(crate) const SERIAL: u32 = 0x2504;
pub(crate) const USABLE_WORKSPACE: u32 = 0x2551;
pub(crate) const INPUT_DOF: u32 = 0x2553;
pub(crate) const OUTPUT_DOF: u32 = 0x2554;
pub(crate) const CALIBRATION_STYLE: u32 = 0x2555;
pub(crate) const MAX_STIFFNESS: u32 = 0x2602;
pub(crate) const MAX_FORCE: u32 = 0x2603;
pub(crate) const CONTINUOUS_FORCE: u32 = 0x2604;
pub(crate) const TEMPERATURE: u32 = 0x2605;
pub(crate) const VELOCITY_LIMIT: u32 = 0x2606;
pub(crate) const IMPULSE_LIMIT: u32 = 0x2607;
pub(crate) const MAX_TORQUE: u32 = 0x2622;
pub(crate) const FORCE: u32 = 0x2700;
pub(crate) const TORQUE: u32 = 0x2701;
pub(crate) const FORCE_OUTPUT: u32 = 0x4000;
/// The last of the capabilities.
pub(crate) const ONE_FRAME_LIMIT: u32 = 0x4004;

pub(crate) const INKWELL: u32 = 4;

/// What the library says of a code.
pub(crate) fn words(code: u32) -> &'static std::ffi::CStr {
    match code {
        SUCCESS => c"No errors",
        INVALID_ENUM => c"Invalid enum",
        INVALID_VALUE => c"Invalid value",
        INVALID_OPERATION => c"Invalid operation",
        INVALID_INPUT_TYPE => c"Invalid input type",
        BAD_HANDLE => c"Bad handle",
        DEVICE_FAULT => c"Device fault",
        DEVICE_ALREADY_INITIATED => c"Device already initiated",
        COMM_ERROR => c"Communication error",
        ILLEGAL_BEGIN => c"Illegal begin",
        ILLEGAL_END => c"Illegal end",
        _ => c"Other error",
    }
}
