//! Types and numbers of the HD library of OpenHaptics: facts of hd.h, hdDefines.h and hdScheduler.h,
//! the same in 3.0 and 3.4, and of appendix A of the reference guide 3.4, which says of what type
//! and how many the values of a parameter are.

use std::ffi::c_int;

/// A device (`HHD`).
pub type Handle = u32;
/// No device.
pub const INVALID_HANDLE: Handle = u32::MAX;

/// An error as `hdGetError` returns it, by value (`HDErrorInfo`).
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ErrorInfo {
    /// One of [`error`].
    pub code: u32,
    /// The driver's own number.
    pub internal: c_int,
    /// The device that it came from.
    pub device: Handle,
}

const _: () = assert!(size_of::<ErrorInfo>() == 12);

/// A parameter of `N` doubles.
#[derive(Clone, Copy, Debug)]
pub struct Doubles<const N: usize>(pub u32);
/// A parameter of one float, which can be got as nothing else.
#[derive(Clone, Copy, Debug)]
pub struct Float(pub u32);
/// A parameter of one integer.
#[derive(Clone, Copy, Debug)]
pub struct Integer(pub u32);
/// A parameter of one boolean.
#[derive(Clone, Copy, Debug)]
pub struct Boolean(pub u32);
/// A parameter that is a text.
#[derive(Clone, Copy, Debug)]
pub struct Text(pub u32);
/// Capability for `hdEnable`.
#[derive(Clone, Copy, Debug)]
pub struct Capability(pub u32);

/// Most values that any parameter of doubles has.
pub const MOST_DOUBLES: usize = 16;

/// Buttons of the stylus, a bit each.
pub const CURRENT_BUTTONS: Integer = Integer(0x2000);
/// True while the stylus is held where it conducts, on the models that sense it.
pub const CURRENT_SAFETY_SWITCH: Boolean = Boolean(0x2001);
/// True while the stylus is in its inkwell.
pub const CURRENT_INKWELL_SWITCH: Boolean = Boolean(0x2002);
/// Velocity, mm/s, smoothed by the driver.
pub const CURRENT_VELOCITY: Doubles<3> = Doubles(0x2051);
/// Stylus to base, column by column, mm.
pub const CURRENT_TRANSFORM: Doubles<16> = Doubles(0x2052);
/// The model's name.
pub const DEVICE_MODEL_TYPE: Text = Text(0x2501);
/// Version of the driver.
pub const DEVICE_DRIVER_VERSION: Text = Text(0x2502);
/// Serial number.
pub const DEVICE_SERIAL_NUMBER: Text = Text(0x2504);
/// Workspace in which all directions of force are available: least x, y, z, then greatest, mm.
pub const USABLE_WORKSPACE_DIMENSIONS: Doubles<6> = Doubles(0x2551);
/// Degrees of freedom that are sensed.
pub const INPUT_DOF: Integer = Integer(0x2553);
/// Degrees of freedom that are driven.
pub const OUTPUT_DOF: Integer = Integer(0x2554);
/// Bits of [`style`].
pub const CALIBRATION_STYLE: Integer = Integer(0x2555);
/// 0 to 1; the vendor's examples take it for N/mm.
pub const NOMINAL_MAX_STIFFNESS: Doubles<1> = Doubles(0x2602);
/// N.
pub const NOMINAL_MAX_FORCE: Doubles<1> = Doubles(0x2603);
/// N.
pub const NOMINAL_MAX_CONTINUOUS_FORCE: Doubles<1> = Doubles(0x2604);
/// 0 cold to 1 warm, of three or six motors.
pub const MOTOR_TEMPERATURE: Doubles<6> = Doubles(0x2605);
/// Speed above which the driver cuts the force, mm/s.
pub const SOFTWARE_VELOCITY_LIMIT: Doubles<1> = Doubles(0x2606);
/// Change of the force between two ticks above which it does so, N/ms.
pub const SOFTWARE_FORCE_IMPULSE_LIMIT: Float = Float(0x2607);
/// mN·m.
pub const NOMINAL_MAX_TORQUE: Doubles<1> = Doubles(0x2622);
/// Force, N, in the base's frame; applied as the frame ends.
pub const CURRENT_FORCE: Doubles<3> = Doubles(0x2700);
/// Torque, mN·m. The guide prints N·m in one of two tables; CHAI3D sends mN·m.
pub const CURRENT_TORQUE: Doubles<3> = Doubles(0x2701);

/// The amplifiers.
pub const FORCE_OUTPUT: Capability = Capability(0x4000);
/// Forces larger than the motors can give are cut to what they can.
pub const MAX_FORCE_CLAMPING: Capability = Capability(0x4001);

/// States of calibration.
pub mod calibration {
    /// The device knows where it is.
    pub const OK: u32 = 0x5000;
    /// `hdUpdateCalibration` makes it know.
    pub const NEEDS_UPDATE: u32 = 0x5001;
    /// The user has to do something first.
    pub const NEEDS_MANUAL_INPUT: u32 = 0x5002;
}

/// Styles of calibration.
pub mod style {
    /// The arm stands in its reset position as the encoders are set to zero.
    pub const ENCODER_RESET: u32 = 1;
    /// The device finds its marks by itself.
    pub const AUTO: u32 = 2;
    /// The stylus is put into the inkwell.
    pub const INKWELL: u32 = 4;
}

/// Codes of errors.
pub mod error {
    /// None.
    pub const SUCCESS: u32 = 0x0000;
    /// First of those that say that a call was wrong.
    pub const INVALID_ENUM: u32 = 0x0100;
    /// See [`INVALID_ENUM`].
    pub const INVALID_INPUT_TYPE: u32 = 0x0103;
    /// No such device.
    pub const BAD_HANDLE: u32 = 0x0104;
    /// The motors are warm.
    pub const WARM_MOTORS: u32 = 0x0200;
    /// A force beyond the largest.
    pub const EXCEEDED_MAX_FORCE: u32 = 0x0201;
    /// A force that changed too fast.
    pub const EXCEEDED_MAX_FORCE_IMPULSE: u32 = 0x0202;
    /// A hand that was too fast.
    pub const EXCEEDED_MAX_VELOCITY: u32 = 0x0203;
    /// Another trouble with the force.
    pub const FORCE_ERROR: u32 = 0x0204;
    /// The device is out of order.
    pub const DEVICE_FAULT: u32 = 0x0300;
    /// Another program has the device.
    pub const DEVICE_ALREADY_INITIATED: u32 = 0x0301;
    /// The device does not answer.
    pub const COMM_ERROR: u32 = 0x0302;
    /// The port cannot be set up.
    pub const COMM_CONFIG_ERROR: u32 = 0x0303;
    /// The clock of the scheduler fails.
    pub const TIMER_ERROR: u32 = 0x0304;
    /// A frame in a frame.
    pub const ILLEGAL_BEGIN: u32 = 0x0400;
    /// The end of no frame.
    pub const ILLEGAL_END: u32 = 0x0401;
    /// A frame that went wrong.
    pub const FRAME_ERROR: u32 = 0x0402;
    /// A priority that there is not.
    pub const INVALID_PRIORITY: u32 = 0x0500;
    /// The scheduler takes no more callbacks.
    pub const SCHEDULER_FULL: u32 = 0x0501;
    /// No licence.
    pub const INVALID_LICENSE: u32 = 0x0600;
}

/// Return values of a callback.
pub mod next {
    /// Not to be called again.
    pub const DONE: u32 = 0;
    /// To be called again in the next tick.
    pub const CONTINUE: u32 = 1;
}

/// The most urgent callbacks.
pub const MAX_SCHEDULER_PRIORITY: u16 = u16::MAX;
/// Rate of the scheduler, Hz.
pub const RATE_HZ: u64 = 1000;
