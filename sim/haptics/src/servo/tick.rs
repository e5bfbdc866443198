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
    /// True if the tick took too long.
    pub late: bool,
    /// True if the force was cut to its largest value.
    pub clamped: bool,
    /// True if the model is past its time to live.
    pub stale: bool,
    /// True if the head touches.
    pub contact: bool,
    /// True if excess energy was removed from the hand.
    pub braked: bool,
    /// True if the amplifiers are off: switched off, or long without contact.
    pub resting: bool,
    /// True until force begins: there is no model, or the hand may be so deep that it would be pushed.
    pub waiting: bool,
    /// True if a guide of the hand is alive.
    pub guided: bool,
    /// Torque of the brush about its ferrule, N·m.
    pub torque_n_m: DVec3,
    /// Current largest force, N.
    pub cap_n: f64,
    /// Stiffness along the normal requested by the model, N/m.
    pub asked_n_m: f64,
    /// Stiffness along the normal after its bound, N/m.
    pub stiffness_n_m: f64,
}

/// Sender of a model, relative to the previous model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sender {
    /// The sender of the previous model.
    Same,
    /// Another sender, or a restarted one: the force engages anew.
    Another,
}

/// The painter's switch of force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// Force is rendered.
    On,
    /// The force is zero.
    Off,
}
