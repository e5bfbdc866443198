//! Rheology of a model's wet paint, as the hand feels it: its drag and its relief.

use maulstick_num::exp;

/// Rheology of wet paint, unthinned and by its share of thinner.
#[derive(Clone, Copy, Debug)]
pub struct Rheology {
    /// Kinematic viscosity of unthinned paint, m²/s.
    pub viscosity_m2_s: f64,
    /// ln of the factor on the viscosity of paint that is thinner alone.
    pub thinning: f64,
    /// Share of the height of unthinned paint that stays under a brush: it yields at tens to hundreds of pascals, and a
    /// brush presses with kilopascals.
    pub bears: f64,
    /// Yield stress that a share of thinner of 0 to 1 leaves, by that of unthinned paint.
    pub yields: fn(f32) -> f32,
}

impl Rheology {
    /// Oil paint from the tube (Baxter 2004, § 5.2).
    pub const TUBE: Self = Self {
        viscosity_m2_s: 1e-2,
        thinning: -4.6,
        bears: 0.2,
        yields: yield_left,
    };

    /// Kinematic viscosity of paint with this share of thinner, m²/s.
    #[must_use]
    pub fn thinned_m2_s(&self, thinner: f64) -> f64 {
        self.viscosity_m2_s * exp(self.thinning * thinner)
    }
}

/// Yield stress of paint of which `thinner` is a share of 0 to 1, by that of paint from the tube: half of it takes it away.
#[must_use]
#[inline(always)]
pub fn yield_left(thinner: f32) -> f32 {
    let left = if thinner < 0.5 {
        1.0 - 2.0 * thinner
    } else {
        0.0
    };
    left * left * left
}

/// How a paint sets: a brush that shears it takes its structure apart, and at rest that comes back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Yield stress at rest, Pa.
    pub rest_pa: f64,
    /// Time in which 1 − 1/e of it is back, s.
    pub recovers_s: f64,
}

impl Default for Setting {
    fn default() -> Self {
        Self::TUBE
    }
}

/// Yield stress of paint while it is worked, Pa.
const WORKED_PA: f64 = 12.0;

impl Setting {
    /// Usual oil paint: whites yield at 50 to 500 Pa at rest (Salvant Plisson et al. 2014), and set within a second.
    pub const TUBE: Self = Self {
        rest_pa: 167.0,
        recovers_s: 0.1,
    };

    /// Mean yield stress from one time to another after it has been worked, s, in Pa.
    #[must_use]
    pub fn mean_pa(&self, from_s: f64, to_s: f64) -> f64 {
        let worked = WORKED_PA.min(self.rest_pa);
        let apart = |s: f64| exp(-s / self.recovers_s.max(1e-9));
        let lasts = self.recovers_s / (to_s - from_s).max(1e-9);
        let apart = (lasts * (apart(from_s) - apart(to_s))).clamp(0.0, 1.0);
        self.rest_pa - (self.rest_pa - worked) * apart
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paint_yields_at_its_worked_stress_first_and_at_its_rest_stress_last() {
        let own = Setting {
            rest_pa: 200.0,
            recovers_s: 0.5,
        };
        let near = |got: f64, want: f64| (got - want).abs() < 0.5;
        assert!(near(own.mean_pa(0.0, 1e-4), 12.0));
        // 200 - 188/e.
        assert!(near(own.mean_pa(0.4999, 0.5001), 130.84));
        assert!(near(own.mean_pa(20.0, 21.0), 200.0));
        let slower = Setting {
            recovers_s: 0.6,
            ..own
        };
        assert!(
            !near(slower.mean_pa(0.4999, 0.5001), 130.84),
            "a fault would pass"
        );
    }

    #[test]
    fn bodies_beyond_all_paint_stay_within_theirs() {
        for rest_pa in [0.0, 5.0, 1e5] {
            for recovers_s in [0.0, 86_400.0] {
                let own = Setting {
                    rest_pa,
                    recovers_s,
                };
                let pa = own.mean_pa(0.0, 0.25);
                assert!((0.0..=rest_pa).contains(&pa), "{own:?}: {pa}");
            }
        }
    }
}
