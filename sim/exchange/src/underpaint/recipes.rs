//! The mixture whose film comes nearest to a colour, in the local metric of ΔE₀₀: an unreachable colour loses chroma
//! rather than its hue.
//!
//! Least squares of lightness, chroma and hue over the amounts of the paints, none of which is below 0: damped
//! Gauss-Newton steps (Levenberg 1944, Marquardt 1963). Three equations determine only three unknowns, so among all
//! equivalent steps δ the one with the least Σ D·δ² is taken, with D the squared effect of a paint's amount on the
//! colour: δ = −D⁻¹Jᵀ(J·D⁻¹·Jᵀ + μ)⁻¹·f. So mixtures change as little, and as smoothly, as colours do. Paints that
//! would become negative are left out and the step is repeated without them.

use maulstick_optics::colour::{Matrix, apply, delta_e_2000_near, solve3};

use super::films::{Films, MOST_PAINTS, Shares};

/// Distance at which a colour counts as reached, ΔE₀₀.
const REACHED: f64 = 0.02;
/// Greatest number of steps with one set of paints.
const STEPS: usize = 40;
/// A step that gains less than this share is the last but one.
const GAIN: f64 = 1e-4;
/// Damping with which steps begin, and with which they are given up.
const DAMPING: [f64; 2] = [1e-3, 1e4];
/// Gain of adding a paint, as a share of its effect, below which it is not added.
const WORTH: f64 = 0.02;
/// Shares below this are none.
const NOTHING: f64 = 1e-7;

/// A mixture, and how far it is from its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Recipe {
    pub(crate) shares: Shares,
    pub(crate) off: f64,
}

/// A colour that is sought.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target {
    lab: [f64; 3],
    metric: Matrix,
}

impl Target {
    /// Target of a CIELAB colour.
    pub(crate) fn new(lab: [f64; 3]) -> Self {
        let metric = delta_e_2000_near(lab);
        Self { lab, metric }
    }

    /// CIELAB of the target.
    pub(crate) fn lab(&self) -> [f64; 3] {
        self.lab
    }

    /// Difference of a colour from it, in lightness, chroma and hue.
    fn off(&self, lab: [f64; 3]) -> [f64; 3] {
        apply(&self.metric, [0, 1, 2].map(|i| lab[i] - self.lab[i]))
    }
}

/// A place of the search.
struct Place {
    shares: Shares,
    far: f64,
    /// Distance of the colour, and its slopes by the amount of each paint.
    off: [f64; 3],
    slopes: [[f64; 3]; MOST_PAINTS],
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Place {
    fn of(films: &Films, shares: Shares, ground: &[f64], target: &Target) -> Self {
        let (lab, mut slopes) = films.lab_with_slopes(&shares, ground);
        let off = target.off(lab);
        for slope in slopes.iter_mut().take(films.paints()) {
            *slope = apply(&target.metric, *slope);
        }
        Self {
            shares,
            far: dot(off, off).sqrt(),
            off,
            slopes,
        }
    }

    /// The step of the paints of `used` under this damping: new amounts, none below 0, of the sum 1.
    fn step(&self, used: &[bool; MOST_PAINTS], damping: f64) -> Shares {
        let mut free = *used;
        let mut next = self.shares;
        // Each round fixes a paint at least.
        for _ in 0..MOST_PAINTS {
            let mut off = self.off;
            let mut normal: Matrix = [[0.0; 3]; 3];
            for i in 0..MOST_PAINTS {
                let slope = self.slopes[i];
                if !used[i] {
                    continue;
                }
                if !free[i] {
                    (0..3).for_each(|p| off[p] -= slope[p] * self.shares[i]);
                    continue;
                }
                let scale = dot(slope, slope) + 1e-12;
                for p in 0..3 {
                    (0..3).for_each(|q| normal[p][q] += slope[p] * slope[q] / scale);
                }
            }
            (0..3).for_each(|p| normal[p][p] += damping);
            let pull = solve3(&normal, off);
            let mut fixed = false;
            for i in 0..MOST_PAINTS {
                if !used[i] {
                    continue;
                }
                let slope = self.slopes[i];
                let scale = dot(slope, slope) + 1e-12;
                next[i] = if free[i] {
                    self.shares[i] - dot(slope, pull) / scale
                } else {
                    0.0
                };
                if next[i] < 0.0 {
                    (free[i], fixed) = (false, true);
                }
            }
            if !fixed {
                break;
            }
        }
        let next = next.map(|share| if share > NOTHING { share } else { 0.0 });
        let sum: f64 = next.iter().sum();
        next.map(|share| share / sum)
    }

    /// The paint, not yet used, of which a little brings the colour nearest.
    fn worth_adding(&self, used: &[bool; MOST_PAINTS], paints: usize) -> Option<usize> {
        let gain = |i: &usize| {
            let slope = self.slopes[*i];
            -dot(slope, self.off) / (dot(slope, slope).sqrt() + 1e-12)
        };
        let unused = (0..paints).filter(|i| !used[*i]);
        let best = unused.max_by(|a, b| gain(a).total_cmp(&gain(b)))?;
        (gain(&best) > WORTH * self.far).then_some(best)
    }
}

/// The nearest mixture to a CIELAB colour that is found from `start` on; of other paints than it has
/// only where they help.
pub(crate) fn refine(films: &Films, start: Shares, ground: &[f64], target: &Target) -> Recipe {
    let mut used = start.map(|share| share > 0.0);
    let mut place = Place::of(films, start, ground, target);
    loop {
        descend(films, &mut place, &used, ground, target);
        if place.far < REACHED {
            break;
        }
        let Some(paint) = place.worth_adding(&used, films.paints()) else {
            break;
        };
        used[paint] = true;
    }
    Recipe {
        shares: place.shares,
        off: place.far,
    }
}

fn descend(
    films: &Films,
    place: &mut Place,
    used: &[bool; MOST_PAINTS],
    ground: &[f64],
    target: &Target,
) {
    let mut damping = DAMPING[0];
    for _ in 0..STEPS {
        if place.far < REACHED || damping > DAMPING[1] {
            return;
        }
        let shares = place.step(used, damping);
        let off = target.off(films.lab(&shares, ground));
        let far = dot(off, off).sqrt();
        // A step that leads nowhere is no number, and not smaller.
        if far < place.far {
            let gain = 1.0 - far / place.far;
            *place = Place::of(films, shares, ground, target);
            damping *= 0.2;
            if gain < GAIN {
                return;
            }
        } else {
            damping = (10.0 * damping).max(DAMPING[0]);
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_optics::colour::delta_e_2000;

    use super::*;
    use crate::underpaint::candidates::Candidates;
    use crate::underpaint::films::tests::palette;

    /// ΔE₀₀ of the nearest that is found.
    fn nearest(films: &Films, starts: &[Shares], ground: &[f64], target: [f64; 3]) -> f64 {
        let sought = Target::new(target);
        let found = starts
            .iter()
            .map(|start| refine(films, *start, ground, &sought));
        let seen = found.map(|recipe| films.lab(&recipe.shares, ground));
        seen.map(|lab| delta_e_2000(lab, target))
            .fold(f64::MAX, f64::min)
    }

    #[test]
    fn a_mixture_of_the_paints_is_found_again() {
        let (studio, paints) = palette();
        let ground = vec![0.95; studio.wavelengths()];
        let mut random = 1u64;
        let mut uniform = move || {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (random >> 11) as f64 / (1u64 << 53) as f64
        };
        for um in [10.0, 60.0, 400.0] {
            let films = Films::new(&studio, &paints, um * 1e-6);
            let candidates = Candidates::new(&films, &ground);
            let (mut worst, mut fault) = (0.0f64, 0.0f64);
            for _ in 0..300 {
                let mut shares = [0.0; MOST_PAINTS];
                for _ in 0..4 {
                    let paint = (uniform() * paints.len() as f64) as usize;
                    shares[paint] += maulstick_num::exp(-6.0 * uniform());
                }
                let sum: f64 = shares.iter().sum();
                let shares = shares.map(|share| share / sum);
                let target = films.lab(&shares, &ground);
                let starts = candidates.nearest::<3>(target);
                let near = nearest(&films, &starts, &ground, target);
                worst = worst.max(near);
                fault = fault.max(delta_e_2000(films.lab(&starts[0], &ground), target));
            }
            println!("{um} µm: worst {worst:.4}, unrefined {fault:.2}");
            assert!(worst < 0.3, "{um}");
            assert!(fault > 0.3, "a fault would pass");
        }
    }

    #[test]
    fn shares_sum_to_one_and_none_is_negative() {
        let (studio, paints) = palette();
        let ground = vec![0.95; studio.wavelengths()];
        let films = Films::new(&studio, &paints, 50e-6);
        let candidates = Candidates::new(&films, &ground);
        for target in [
            [60.0, 90.0, -80.0],
            [0.0, 0.0, 0.0],
            [100.0, 0.0, 0.0],
            [55.0, 10.0, 30.0],
        ] {
            for start in candidates.nearest::<3>(target) {
                let off = Target::new(target).off(films.lab(&start, &ground));
                let before = dot(off, off).sqrt();
                let recipe = refine(&films, start, &ground, &Target::new(target));
                let sum: f64 = recipe.shares.iter().sum();
                assert!((sum - 1.0).abs() < 1e-9 && recipe.shares.iter().all(|s| *s >= 0.0));
                assert!(recipe.off <= before + 1e-9);
                println!("{target:?}: {before:.2} to {:.2}", recipe.off);
            }
        }
    }

    #[test]
    fn no_random_mixture_is_nearer_to_what_cannot_be_reached() {
        let (studio, paints) = palette();
        let ground = vec![0.95; studio.wavelengths()];
        let films = Films::new(&studio, &paints, 80e-6);
        let candidates = Candidates::new(&films, &ground);
        let mut random = 5u64;
        let mut uniform = move || {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (random >> 11) as f64 / (1u64 << 53) as f64
        };
        for target in [
            [50.0, 80.0, 60.0],
            [60.0, -90.0, 60.0],
            [30.0, 60.0, -100.0],
            [12.0, 0.0, 0.0],
        ] {
            let starts = candidates.nearest::<3>(target);
            let sought = Target::new(target);
            let found = starts
                .iter()
                .map(|start| refine(&films, *start, &ground, &sought));
            let near = found.map(|recipe| recipe.off).fold(f64::MAX, f64::min);
            let mut best = f64::MAX;
            for _ in 0..20_000 {
                let mut shares = [0.0; MOST_PAINTS];
                for _ in 0..3 {
                    let paint = (uniform() * paints.len() as f64) as usize;
                    shares[paint] += maulstick_num::exp(-7.0 * uniform());
                }
                let sum: f64 = shares.iter().sum();
                let off = sought.off(films.lab(&shares.map(|share| share / sum), &ground));
                best = best.min(dot(off, off).sqrt());
            }
            println!("{target:?}: {near:.3}, by chance {best:.3}");
            assert!(near < best + 0.05, "{target:?}");
        }
    }
}
