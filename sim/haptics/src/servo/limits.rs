//! Bounds of the force, whatever the models request.

use crate::guide::GuideBounds;

/// Greatest stiffness of a guide, as a share of the device's greatest: in the canvas it adds to a wall of that
/// stiffness.
const GUIDE_STIFFNESS: f64 = 0.25;

/// Limits of a servo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest force, N: the lesser of the device's nominal and the configured one.
    pub max_force_n: f64,
    /// Largest force for warm motors, N.
    pub continuous_force_n: f64,
    /// Largest stiffness, N/m.
    pub max_stiffness_n_m: f64,
    /// Least viscous friction of the device itself, N·s/m: it absorbs energy that a sampled wall adds.
    pub damping_n_s_m: f64,
    /// Fastest change of the force, N/s.
    pub slew_n_s: f64,
    /// Longest lever of the brush's torque on the hand, m.
    pub lever_m: f64,
    /// Speed above which a hand with force on it counts as driven by the device, m/s.
    pub max_speed_m_s: f64,
    /// Least swing of a shaking hand, m.
    pub oscillation_m: f64,
    /// Time over which a model past its time to live fades, s.
    pub fade_s: f64,
    /// Requested force up to which force may begin, N.
    pub engage_n: f64,
    /// Time over which force rises after a start, a fault or another sender, s.
    pub engage_s: f64,
    /// Duration above which a tick gives no force, and the ramp restarts, s.
    pub longest_tick_s: f64,
    /// Duration of a tick above which force also waits for a hand that has come up, s.
    pub standstill_s: f64,
    /// Time without contact after which the amplifiers go off, s.
    pub idle_s: f64,
    /// Bounds of a guide on a strong and stiff enough device.
    pub guide: GuideBounds,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_force_n: 3.0,
            continuous_force_n: 0.88,
            max_stiffness_n_m: 400.0,
            damping_n_s_m: 0.1,
            slew_n_s: 400.0,
            lever_m: 0.05,
            max_speed_m_s: 1.5,
            oscillation_m: 3e-4,
            fade_s: 0.075,
            engage_n: 0.2,
            engage_s: 0.5,
            longest_tick_s: 0.005,
            standstill_s: 0.1,
            idle_s: 60.0,
            guide: GuideBounds {
                stiffness_n_m: 100.0,
                // The passivity controller's bound: more would shake on a velocity in encoder steps.
                damping_n_s_m: 0.8,
                force_n: 0.6,
                reach_m: 0.03,
            },
        }
    }
}

impl Limits {
    /// The device's bounds for a servo in the desk frame, where a desk length is `scale` device lengths.
    ///
    /// The desk's place of the hand is x = s·y, for its place y in the device, and the hand gets f(x)/s. So a wall f =
    /// −K·x − B·ẋ becomes −K·y − B·ẏ on the hand: stiffness and damping are the same numbers in both frames, and so is
    /// every bound of a sampled wall, b > K·T/2. Forces, speeds and lengths of the device are s times as large on the
    /// desk. Work done on the hand is f/s·dx/s, the desk's divided by s²: both have the same sign.
    #[must_use]
    pub fn scaled(&self, scale: f64) -> Self {
        Self {
            max_force_n: scale * self.max_force_n,
            continuous_force_n: scale * self.continuous_force_n,
            slew_n_s: scale * self.slew_n_s,
            lever_m: scale * self.lever_m,
            max_speed_m_s: scale * self.max_speed_m_s,
            oscillation_m: scale * self.oscillation_m,
            engage_n: scale * self.engage_n,
            guide: GuideBounds {
                force_n: scale * self.guide.force_n,
                reach_m: scale * self.guide.reach_m,
                ..self.guide
            },
            ..*self
        }
    }

    /// Bounds of a guide's force.
    #[must_use]
    pub fn guide_bounds(&self) -> GuideBounds {
        let stiffness_n_m = GUIDE_STIFFNESS * self.max_stiffness_n_m;
        GuideBounds {
            stiffness_n_m: self.guide.stiffness_n_m.min(stiffness_n_m),
            force_n: self.guide.force_n.min(self.continuous_force_n),
            ..self.guide
        }
    }
}
