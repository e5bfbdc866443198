//! What was called.

use serde::{Deserialize, Serialize};

/// A call of the library, or an error that it reported.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Call {
    /// `hdInitDevice` with a name; the empty one is a null pointer.
    Init(String),
    /// `hdDisableDevice`.
    DisableDevice(u32),
    /// `hdEnable` of a capability.
    Enable(u32),
    /// `hdDisable` of a capability.
    Disable(u32),
    /// `hdScheduleAsynchronous` with a priority.
    Schedule(u16),
    /// `hdUnschedule`.
    Unschedule(u64),
    /// `hdSetSchedulerRate`.
    Rate(u64),
    /// `hdStartScheduler`.
    Start,
    /// `hdStopScheduler`.
    Stop,
    /// `hdBeginFrame` in this tick of the scheduler.
    Begin(u64),
    /// A force was set, N.
    Force([f64; 3]),
    /// A torque was set, mN·m.
    Torque([f64; 3]),
    /// `hdEndFrame`: the force that the motors give from now on, N.
    End([f64; 3]),
    /// `hdCheckCalibration` and its answer.
    Check(u32),
    /// `hdUpdateCalibration` of a style.
    Update(u32),
    /// An error is reported.
    Error(u32),
    /// The callback has returned this code in this tick.
    Returned(u64, u32),
}
