//! What a force may be, whatever the models say.

/// The bounds of a servo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest force, N: the least of the device's nominal and the configured one.
    pub max_force_n: f64,
    /// Largest force for warm motors, N.
    pub continuous_force_n: f64,
    /// Largest stiffness, N/m.
    pub max_stiffness_n_m: f64,
    /// Viscous friction of the device itself, at least, N·s/m: what it takes of the energy that a
    /// sampled wall gives.
    pub damping_n_s_m: f64,
    /// Fastest change of the force, N/s.
    pub slew_n_s: f64,
    /// A hand that is faster than this with force on it is driven by the device, m/s.
    pub max_speed_m_s: f64,
    /// A shaking hand turns round by at least this much, m.
    pub shaking_m: f64,
    /// Time over which a model past its time to live fades to nothing, s.
    pub fade_s: f64,
    /// Time over which force comes up after a start, a fault or another sender, s.
    pub engage_s: f64,
    /// A tick longer than this has stood still: no force, and engage anew, s.
    pub longest_tick_s: f64,
    /// Time without contact after which the amplifiers go off, s.
    pub idle_s: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_force_n: 3.0,
            continuous_force_n: 0.88,
            max_stiffness_n_m: 400.0,
            damping_n_s_m: 0.1,
            slew_n_s: 400.0,
            max_speed_m_s: 1.5,
            shaking_m: 3e-4,
            fade_s: 0.075,
            engage_s: 0.5,
            longest_tick_s: 0.005,
            idle_s: 60.0,
        }
    }
}
