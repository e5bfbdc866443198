//! Input and report of a servo tick.

use glam::DVec3;

use super::fault::Fault;

/// Report of a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each may be so without the others"
)]
pub struct Tick {
    /// Latched fault.
    pub fault: Option<Fault>,
    /// The tick took too long.
    pub late: bool,
    /// The force was cut to its largest size.
    pub clamped: bool,
    /// The model is past its time to live.
    pub stale: bool,
    /// The head touches.
    pub contact: bool,
    /// Energy was taken back from the hand.
    pub braked: bool,
    /// The amplifiers are off: switched off, or nothing was touched for long.
    pub resting: bool,
    /// Force has yet to begin: there is no model, or the hand may be so deep that it would be pushed.
    pub waiting: bool,
    /// A guide of the hand is alive.
    pub guided: bool,
    /// Torque of the brush about its ferrule, N·m.
    pub torque_n_m: DVec3,
    /// Largest force now, N.
    pub cap_n: f64,
    /// Stiffness along the normal that the model asks for, N/m.
    pub asked_n_m: f64,
    /// Stiffness along the normal that is given, N/m.
    pub stiffness_n_m: f64,
}

/// Sender of a model, relative to the previous model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sender {
    /// The same sender.
    Same,
    /// Another sender, or the same one restarted: the force engages anew.
    Another,
}

/// The painter's switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// Force is given.
    On,
    /// No force is given.
    Off,
}
