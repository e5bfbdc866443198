//! Forces across the normal (Baxter 2004, § 8.7.2 and eq. 8.8): friction at rest and in motion, and the drag of paint.
//!
//! The text's f_t = k_t·(v − n(n·v)) would push the hand on; it opposes the motion, acts in contact
//! alone, and is bounded by μ·f_n. At rest it would be nothing, and a brush that is pulled gently would creep: there bristles
//! stick, a spring from the place where they took hold, which gives way where it would pull by more than μ_s·f_n (Dahl 1968;
//! Hayward and Armstrong 2000). What it stores it gives back, and what gives way is lost. The drag μ_p·L·v of eq. 8.8 has no
//! such bound: a film drags however lightly it is touched. All come up over the first half millimetre.

use glam::DVec3;
use maulstick_num::exp;

/// Friction and drag grow to their full size over this depth, m.
pub const RAMP_M: f64 = 5e-4;
/// Speed at which friction reaches its bound, m/s: k_t = μ·f_n by this. Friction at rest falls to that in motion by it, too
/// (Stribeck 1902).
const FULL_SPEED: f64 = 0.02;
/// Stiffness of bristles that stick by the greatest that the device bears.
pub const STUCK_SHARE: f64 = 0.2;

/// How far a depth has brought friction up, 0 to 1.
#[must_use]
pub fn ramp(depth_m: f64) -> f64 {
    (depth_m / RAMP_M).clamp(0.0, 1.0)
}

/// Friction at the velocity `across` the normal, m/s; its size is at most `bound_n`.
#[must_use]
pub fn friction(across: DVec3, bound_n: f64) -> DVec3 {
    let speed = across.length();
    if speed > 0.0 {
        across * (-bound_n * (speed / FULL_SPEED).min(1.0) / speed)
    } else {
        DVec3::ZERO
    }
}

/// Drag of paint at the velocity `across` the normal, m/s; `viscous` is μ·L, N·s/m.
#[must_use]
pub fn drag(across: DVec3, viscous: f64) -> DVec3 {
    -across * viscous
}

/// Bound of friction at a speed, N: at rest `still_n`, in motion `moving_n`.
#[must_use]
pub fn breakaway(still_n: f64, moving_n: f64, speed: f64) -> f64 {
    let share = speed / FULL_SPEED;
    moving_n + (still_n - moving_n).max(0.0) * exp(-share * share)
}

/// Hold of the bristles on the surface at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grip {
    /// Unit normal.
    pub normal: DVec3,
    /// Force at which they give way, N.
    pub bound_n: f64,
    /// Stiffness, N/m.
    pub stiffness_n_m: f64,
}

/// Bristles that stick: the place of the ferrule at which they pull nowhere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stiction {
    anchor: Option<DVec3>,
}

impl Stiction {
    /// Force on a ferrule at `position`, m, N.
    #[must_use]
    pub fn force(&self, position: DVec3, grip: &Grip) -> DVec3 {
        let Some(anchor) = self.anchor else {
            return DVec3::ZERO;
        };
        let way = anchor - position;
        let across = way - grip.normal * way.dot(grip.normal);
        (across * grip.stiffness_n_m).clamp_length_max(grip.bound_n.max(0.0))
    }

    /// The end of a tick with the ferrule at `position`, m: what pulls by more than its bound has given way. Without a grip
    /// nothing sticks.
    pub fn follow(&mut self, position: DVec3, grip: Option<&Grip>) {
        let held = grip.filter(|grip| grip.stiffness_n_m > 0.0);
        self.anchor = held.map(|grip| position + self.force(position, grip) / grip.stiffness_n_m);
    }
}

#[cfg(test)]
mod tests;
