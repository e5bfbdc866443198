//! What the device is and senses, and what was called.

use serde::{Deserialize, Serialize};

/// A device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Script {
    /// Serial numbers of the attached devices.
    pub serials: Vec<u16>,
    /// Whether another program holds them.
    pub is_held: bool,
    /// The vendor's number of its type.
    pub system_type: i32,
    /// Whether it senses how its handle is turned.
    pub has_wrist: bool,
    /// Position, m, in the vendor's axes.
    pub position: [f64; 3],
    /// Rows of the handle's frame.
    pub frame: [[f64; 3]; 3],
    /// Velocity, m/s.
    pub velocity: [f64; 3],
    /// Bits of the pressed buttons.
    pub buttons: u32,
    /// What reading its pose returns: 0, 1 for nothing new, -1 for an error.
    pub pose_code: i32,
    /// What setting a force returns: 0, 2 for saturated motors, -1 for an error.
    pub force_code: i32,
}

impl maulstick_scripted::Script for Script {
    const LIBRARY: &'static str = "maulstick_libdhd";
    type Call = Call;
}

/// An omega.6 that lies still.
impl Default for Script {
    fn default() -> Self {
        Self {
            serials: vec![7],
            is_held: false,
            system_type: 34,
            has_wrist: true,
            position: [0.0; 3],
            frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            velocity: [0.0; 3],
            buttons: 0,
            pose_code: 0,
            force_code: 0,
        }
    }
}

/// A call of the library that moves something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Call {
    /// `dhdOpenID` of a place.
    Open(i8),
    /// `dhdClose`.
    Close(i8),
    /// `dhdEnableForce`.
    Enable(bool),
    /// A force was set, N, in the vendor's axes.
    Force([f64; 3]),
}
