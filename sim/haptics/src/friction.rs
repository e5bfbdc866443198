//! Forces across the normal (Baxter 2004, § 8.7.2 and eq. 8.8): friction at rest and in motion, and the drag of paint.
//!
//! The text's f_t = k_t·(v − n(n·v)) would accelerate the hand; here it opposes the motion, acts only in contact, and
//! is bounded by μ·f_n. It vanishes at rest, where a brush that is pulled gently would creep. So there bristles stick:
//! a spring from the point of adhesion, which slips where it would exceed μ_s·f_n (Dahl 1968; Hayward and Armstrong
//! 2000). The spring returns its energy, and slip dissipates it. The drag μ_p·L·v of eq. 8.8 has no such bound: a film
//! drags however lightly it is touched. All rise over the first half millimetre.

use glam::DVec3;

/// Depth over which friction and drag rise to their full value, m.
pub const RAMP_M: f64 = 5e-4;
/// Speed at which friction reaches its bound, m/s: k_t = μ·f_n by this.
const FULL_SPEED: f64 = 0.02;
/// Slip over which friction at rest falls to that in motion, m.
const SLID_M: f64 = 5e-4;
/// Time after which bristles that slide no more stick as before, s.
const STICKING_S: f64 = 0.05;
/// Stiffness of sticking bristles as a share of the device's greatest.
pub const STUCK_SHARE: f64 = 0.2;

/// Share of full friction at a depth, 0 to 1.
#[must_use]
pub fn ramp(depth_m: f64) -> f64 {
    (depth_m / RAMP_M).clamp(0.0, 1.0)
}

/// Friction at the velocity `across` the normal, m/s; its magnitude is at most `bound_n`.
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

/// Hold of the bristles on the surface at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grip {
    /// Unit normal.
    pub normal: DVec3,
    /// Force at which sticking bristles begin to slip, N.
    pub still_n: f64,
    /// Force at which slipping bristles keep slipping, N; not more.
    pub moving_n: f64,
    /// Stiffness, N/m.
    pub stiffness_n_m: f64,
}

/// State of sticking bristles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stiction {
    /// Position of the ferrule at which they do not pull.
    anchor: Option<DVec3>,
    /// From 0, sticking, to 1, sliding. It depends on the distance slid and not on speed, because encoder steps make a
    /// still hand seem to move.
    sliding: f64,
}

impl Stiction {
    /// Current force of slip, N.
    #[must_use]
    pub fn bound_n(&self, grip: &Grip) -> f64 {
        let bound = grip.still_n + (grip.moving_n - grip.still_n) * self.sliding;
        bound.max(0.0)
    }

    /// Force on a ferrule at `position`, m, N.
    #[must_use]
    pub fn force(&self, position: DVec3, grip: &Grip) -> DVec3 {
        self.pull(position, grip)
            .clamp_length_max(self.bound_n(grip))
    }

    /// The force without slip, N.
    fn pull(&self, position: DVec3, grip: &Grip) -> DVec3 {
        let way = self.anchor.map_or(DVec3::ZERO, |anchor| anchor - position);
        (way - grip.normal * way.dot(grip.normal)) * grip.stiffness_n_m
    }

    /// Ends a tick of `dt` s with the ferrule at `position`, m: bristles that pull above their bound have slipped.
    /// Without a grip nothing sticks.
    pub fn follow(&mut self, position: DVec3, grip: Option<&Grip>, dt: f64) {
        let Some(grip) = grip.filter(|grip| grip.stiffness_n_m > 0.0) else {
            *self = Self::default();
            return;
        };
        let force = self.force(position, grip);
        let slid_m = (self.pull(position, grip) - force).length() / grip.stiffness_n_m;
        self.anchor = Some(position + force / grip.stiffness_n_m);
        let change = if slid_m > 0.0 {
            slid_m / SLID_M
        } else {
            -dt / STICKING_S
        };
        self.sliding = (self.sliding + change).clamp(0.0, 1.0);
    }
}

#[cfg(test)]
mod tests;
