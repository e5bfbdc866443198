//! Bounds of the force, whatever the models ask for.

use crate::guide::GuideBounds;

/// Stiffness of a guide at most, by the largest of the device: in the canvas it is felt beside a wall as stiff as that.
const GUIDE_STIFFNESS: f64 = 0.25;

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
    /// Longest lever by which a brush turns the hand, m.
    pub lever_m: f64,
    /// A hand that is faster than this with force on it is driven by the device, m/s.
    pub max_speed_m_s: f64,
    /// A shaking hand turns round by at least this much, m.
    pub oscillation_m: f64,
    /// Time over which a model past its time to live fades to nothing, s.
    pub fade_s: f64,
    /// Force comes up first where the models ask for no more than this, N.
    pub engage_n: f64,
    /// Time over which force comes up after a start, a fault or another sender, s.
    pub engage_s: f64,
    /// A tick longer than this has stood still: no force, and the ramp anew, s.
    pub longest_tick_s: f64,
    /// After one that is longer than this too, force waits for a hand that has come up, s.
    pub standstill_s: f64,
    /// Time without contact after which the amplifiers go off, s.
    pub idle_s: f64,
    /// Bounds of a guide of a device that is strong and stiff enough.
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
                // As of the passivity controller: more would shake on a velocity in encoder steps.
                damping_n_s_m: 0.8,
                force_n: 0.6,
                reach_m: 0.03,
            },
        }
    }
}

impl Limits {
    /// The same bounds of the device, for a servo in the desk frame where a desk length is `scale`
    /// device lengths.
    ///
    /// The desk's place of the hand is x = s·y, for its place y in the device, and the hand is given
    /// f(x)/s. So a wall f = −K·x − B·ẋ is on the hand −K·y − B·ẏ: stiffness and damping are the same
    /// numbers in both frames, and so is every bound of a sampled wall, b > K·T/2. Forces, speeds and
    /// lengths of the device are s times as large on the desk. Work done on the hand is f/s·dx/s, the
    /// desk's by s²: where the one is never above 0, the other is not.
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

    /// Bounds of what a guide may ask for.
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
