//! What a test may ask of the device.

use serde::{Deserialize, Serialize};

/// A device and what befalls it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Script {
    /// Names under which it can be initiated; the empty one is a null pointer.
    pub names: Vec<String>,
    /// Initiating fails with this code and internal code.
    pub init_error: Option<(u32, i32)>,
    /// What a failed initiation hands out.
    pub failed_handle: u32,
    /// Scheduling fails with this code.
    pub schedule_error: Option<u32>,
    /// Starting the scheduler fails with this code.
    pub start_error: Option<u32>,
    /// Whether the scheduler calls back at all.
    pub scheduler: Scheduler,
    /// The model's name.
    pub model: String,
    /// Degrees of freedom that are sensed.
    pub input_dof: i32,
    /// Degrees of freedom that are driven.
    pub output_dof: i32,
    /// Nominal largest force, N.
    pub max_force: f64,
    /// Nominal continuous force, N.
    pub continuous_force: f64,
    /// Nominal largest stiffness, as the library says it: 0 to 1.
    pub stiffness: f64,
    /// Nominal largest torque, mN·m.
    pub max_torque: f64,
    /// Speed of the hand above which the driver cuts the force, mm/s.
    pub velocity_limit: f64,
    /// Change of the force between two ticks above which it does so, N/ms.
    pub impulse_limit: f64,
    /// Usable working area, mm.
    pub workspace: [f64; 6],
    /// Bits of the styles of calibration.
    pub styles: i32,
    /// States of calibration: the first is now, an update goes on to the next.
    pub calibration: Vec<u32>,
    /// What it does not know: asked for, an invalid enumerant.
    pub unknown: Vec<u32>,
    /// Who holds the stylus.
    pub grip: Grip,
    /// Where the hand wants it to be, mm.
    pub position: [f64; 3],
    /// Columns of the stylus's axes: x, y, z.
    pub axes: [[f64; 3]; 3],
    /// Velocity where it is held fast, mm/s.
    pub velocity: [f64; 3],
    /// Bits of the pressed buttons.
    pub buttons: i32,
    /// Whether the stylus is in its inkwell: 1 or 0.
    pub inkwell: u8,
    /// The safety switch: 1 or 0.
    pub safety: u8,
    /// Temperatures of six motors.
    pub temperatures: [f64; 6],
    /// What happens at which frames.
    pub moments: Vec<Moment>,
}

/// What the scheduler does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scheduler {
    /// It calls back a thousand times a second.
    Alive,
    /// It never calls back.
    Dead,
}

/// Who holds the stylus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Grip {
    /// A vice: it is where the script says.
    Fast,
    /// A hand: it gives way to force.
    Hand,
}

/// Something happens when the frame of this number, the first being 1, begins.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Number of the frame since the device was initiated.
    pub frame: u64,
    /// What.
    pub event: Event,
}

/// What may happen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Event {
    /// An error of a code and an internal code is reported once.
    Error(u32, i32),
    /// The same, at the frame's end.
    ErrorAtEnd(u32, i32),
    /// The cable is out: each frame, and each initiation, is a communication error.
    Unplug,
    /// It is in again.
    Plug,
    /// Bits of the pressed buttons.
    Buttons(i32),
    /// The inkwell's switch.
    Inkwell(u8),
    /// The safety switch.
    Safety(u8),
    /// Temperatures of the motors.
    Temperatures([f64; 6]),
    /// Where the hand wants it to be, mm.
    Position([f64; 3]),
    /// The stylus's axes.
    Axes([[f64; 3]; 3]),
    /// States of calibration from now on.
    Calibration(Vec<u32>),
    /// The scheduler calls nobody any more.
    Stall,
}

/// A Touch that lies still and is calibrated.
impl Default for Script {
    fn default() -> Self {
        Self {
            names: vec![String::new()],
            init_error: None,
            failed_handle: u32::MAX,
            schedule_error: None,
            start_error: None,
            scheduler: Scheduler::Alive,
            model: "Touch".into(),
            input_dof: 6,
            output_dof: 3,
            max_force: 3.3,
            continuous_force: 0.88,
            stiffness: 0.5,
            max_torque: 0.0,
            velocity_limit: 10_000.0,
            impulse_limit: 100.0,
            workspace: [-80.0, -60.0, -35.0, 80.0, 60.0, 35.0],
            styles: 2,
            calibration: vec![0x5000],
            unknown: Vec::new(),
            grip: Grip::Fast,
            position: [0.0; 3],
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            velocity: [0.0; 3],
            buttons: 0,
            inkwell: 0,
            safety: 1,
            temperatures: [0.0; 6],
            moments: Vec::new(),
        }
    }
}
