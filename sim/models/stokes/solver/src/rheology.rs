//! Herschel-Bulkley paint: τ = τ_y + K·γ̇ⁿ where it is sheared, solid below its yield stress.
//!
//! Yield stress and viscosity are those of impasto's levelling (its `Body`) where n = 1. Below the shear rate at which the
//! stress would need more than [`LARGEST_RELATIVE_VISCOSITY`] times the viscosity, paint creeps with that (O'Donovan and Tanner 1984).

use maulstick_num::{powf, wide};

use crate::domain::Domain;
use crate::grid::others;
use crate::stencil::Span;

/// Largest viscosity relative to that of sheared paint.
pub const LARGEST_RELATIVE_VISCOSITY: f64 = 2000.0;
/// Smallest viscosity of shear-thinning paint relative to that at the reference shear rate.
const LEAST_RELATIVE_VISCOSITY: f64 = 1e-3;

/// Rheology of a paint, divided by its density: stresses are in m²/s², viscosities in m²/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paint {
    /// Kinematic viscosity K·γ̇ⁿ⁻¹/ρ at [`rate`](Self::rate), m²/s.
    pub viscosity: f64,
    /// Yield stress divided by density, m²/s².
    pub yields: f64,
    /// Flow index n: 1 for a Bingham fluid, less for shear-thinning paint.
    pub index: f64,
    /// Reference shear rate of the viscosity, 1/s.
    pub rate: f64,
}

impl Paint {
    /// A Newtonian fluid of a kinematic viscosity, m²/s.
    #[must_use]
    pub const fn newtonian(viscosity: f64) -> Self {
        Self {
            viscosity,
            yields: 0.0,
            index: 1.0,
            rate: 1.0,
        }
    }

    /// Viscosity at a shear rate in 1/s, relative to that at the reference rate.
    #[must_use]
    pub fn relative(&self, rate: f64) -> f64 {
        let least = self.yields / (self.viscosity * LARGEST_RELATIVE_VISCOSITY);
        let rate = rate.max(least).max(1e-12);
        let thins = if self.index == 1.0 {
            1.0
        } else {
            powf(rate / self.rate, self.index - 1.0)
        };
        let yields = self.yields / (self.viscosity * rate);
        (thins + yields).clamp(LEAST_RELATIVE_VISCOSITY, LARGEST_RELATIVE_VISCOSITY)
    }

    /// Writes the relative viscosity of each cell for velocities in m/s on cells of `cell_m`, with a scratch field.
    pub fn viscosities(
        &self,
        domain: &Domain,
        velocity: [&[f32]; 3],
        cell_m: f64,
        (field, spare): (&mut Vec<f32>, &mut Vec<f32>),
    ) {
        let is_newtonian = self.yields == 0.0 && self.index == 1.0;
        for field in [&mut *field, &mut *spare] {
            field.clear();
            field.resize(domain.grid.len(), if is_newtonian { 1.0 } else { 0.0 });
        }
        if is_newtonian {
            return;
        }
        squared_rates(domain, velocity, field, spare);
        if self.index == 1.0 {
            let yields = self.yields / self.viscosity;
            bingham(field, yields, cell_m);
        } else {
            for place in domain
                .grid
                .places()
                .filter(|place| domain.wet[*place] > 0.0)
            {
                let rate = f64::from(field[place]).sqrt() / cell_m;
                field[place] = self.relative(rate) as f32;
            }
        }
        domain.grid.wrap(field);
    }
}

wide! {
    /// [`Paint::relative`] for n = 1, of squared rates in velocities per cell.
    fn bingham(field: &mut [f32], yields: f64, cell_m: f64) {
        let least = yields / LARGEST_RELATIVE_VISCOSITY;
        for value in field {
            let rate = f64::from(*value).sqrt() / cell_m;
            let rate = if rate > least { rate } else { least };
            let rate = if rate > 1e-12 { rate } else { 1e-12 };
            let relative = 1.0 + yields / rate;
            *value = if relative < LARGEST_RELATIVE_VISCOSITY { relative } else { LARGEST_RELATIVE_VISCOSITY } as f32;
        }
    }
}

/// Square of the shear rate of each cell, 2·E:E, in velocities per cell; an edge counts for the four cells around it.
fn squared_rates(domain: &Domain, velocity: [&[f32]; 3], into: &mut [f32], shear: &mut [f32]) {
    let span = Span::of(&domain.grid, domain.grid.range());
    for (axis, u) in velocity.into_iter().enumerate() {
        add_stretch(into, u, domain.grid.stride(axis), span);
    }
    for edge in 0..3 {
        let [a, b] = others(edge);
        let by = [a, b].map(|axis| domain.grid.stride(axis));
        let fields = [velocity[a], velocity[b]];
        square_shear(
            shear,
            &domain.edge[edge],
            &domain.slope[edge],
            fields,
            by,
            span,
        );
        domain.grid.wrap(shear);
        add_around(into, shear, by, span);
    }
}

wide! {
    fn add_stretch(into: &mut [f32], u: &[f32], by: usize, span: Span) {
        let (low, high) = (span.here(u), span.after(u, by));
        let into = span.here_mut(into);
        for i in 0..into.len() {
            let stretch = high[i] - low[i];
            into[i] += 2.0 * (stretch * stretch);
        }
    }
}

wide! {
    fn square_shear(into: &mut [f32], weight: &[f32], slope: &[Vec<f32>; 2], velocity: [&[f32]; 2], by: [usize; 2], span: Span) {
        let weight = span.here(weight);
        let (u_slope, v_slope) = (span.here(&slope[0]), span.here(&slope[1]));
        let (u_low, u) = (span.before(velocity[0], by[1]), span.here(velocity[0]));
        let (v_low, v) = (span.before(velocity[1], by[0]), span.here(velocity[1]));
        let into = span.here_mut(into);
        for i in 0..into.len() {
            let shear = u_slope[i] * (u[i] - u_low[i]) + v_slope[i] * (v[i] - v_low[i]);
            // Without paint there is no shear.
            into[i] = if weight[i] > 0.0 { shear * shear } else { 0.0 };
        }
    }
}

wide! {
    fn add_around(into: &mut [f32], edge: &[f32], by: [usize; 2], span: Span) {
        let (a, b) = (span.here(edge), span.after(edge, by[0]));
        let (c, d) = (span.after(edge, by[1]), &edge[span.from + by[0] + by[1]..]);
        let into = span.here_mut(into);
        let d = &d[..d.len().min(into.len())];
        for i in 0..d.len() {
            into[i] += 0.25 * ((a[i] + b[i]) + (c[i] + d[i]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paint_at_its_yield_stress_is_stiff_and_sheared_paint_thins() {
        let paint = Paint {
            viscosity: 1e-2,
            yields: 0.02,
            index: 0.5,
            rate: 10.0,
        };
        assert_eq!(paint.relative(0.0), LARGEST_RELATIVE_VISCOSITY);
        // τ = τ_y + K·γ̇ⁿ at the reference rate.
        assert!((paint.relative(10.0) - (1.0 + 0.2)).abs() < 1e-12);
        let fast = paint.relative(1000.0);
        assert!((fast - (0.1 + 0.002)).abs() < 1e-12, "{fast}");
        let newtonian = Paint::newtonian(1e-2);
        assert_eq!([newtonian.relative(0.0), newtonian.relative(1e9)], [1.0; 2]);
    }
}
