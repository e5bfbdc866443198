//! Force of moving paint on the hand (Baxter 2004, § 8.8), from a solver that is far slower than the hand.
//!
//! A [`FluidForce`] is computed for one velocity; its Jacobian extrapolates it to the current velocity, a thousand
//! times a second: f = f₀ + J·v. So drag follows the hand without lag, whatever the solver's rate. From one message to
//! the next f₀ and J follow the step response of the Bartlett-Hanning window over the message's recovery, one period of
//! its source. A mixture of two dissipative Jacobians is dissipative.
//!
//! f₀ is the push of paint that is still moving. If the next message does not come, f₀ fades over a second period,
//! because the paint may have come to rest and then only drags. Held, f₀ would push the hand with energy that the paint
//! has lost.

use glam::{DMat3, DVec3};
use maulstick_types::haptics::{ContactModel, FluidForce};

use crate::bartlett_hanning::step_response;

/// Greatest drag, N·s/m: more, on a velocity in encoder steps, would shake by itself.
pub const MOST_DRAG: f64 = 0.8;
/// Greatest force on a hand at rest, N.
pub const MOST_FORCE_N: f64 = 1.5;
/// Share of a Jacobian's magnitude by which it may drive the hand, for rounding.
const ROUNDING: f64 = 1e-9;

/// A fluid force in the form that the servo evaluates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluid {
    film: Film,
    time_to_live_s: f64,
    recovery_s: f64,
}

/// Force by velocity: f = f₀ + J·v.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Film {
    /// Force on a hand at rest, N.
    at_rest: DVec3,
    /// Derivative of the force by velocity, N·s/m.
    jacobian: DMat3,
}

impl Film {
    const NONE: Self = Self {
        at_rest: DVec3::ZERO,
        jacobian: DMat3::ZERO,
    };

    fn times(self, share: f64) -> Self {
        Self {
            at_rest: self.at_rest * share,
            jacobian: self.jacobian * share,
        }
    }

    /// Interpolation to another film by `share`.
    fn toward(self, other: Self, share: f64) -> Self {
        let (own, other) = (self.times(1.0 - share), other.times(share));
        Self {
            at_rest: own.at_rest + other.at_rest,
            jacobian: own.jacobian + other.jacobian,
        }
    }
}

impl Fluid {
    /// Converts a message, with its force multiplied by `scale`. Angular parts are left out: the servo gives forces.
    ///
    /// # Errors
    /// The fault: a number that is not finite, a Jacobian that drives the hand, a time to live or a recovery
    /// of more than a second.
    pub fn new(message: &FluidForce, scale: f64) -> Result<Self, &'static str> {
        let part = |of: &[f64; 6]| DVec3::new(of[0], of[1], of[2]);
        let rows = [0, 1, 2].map(|i| part(&message.jacobian[i]));
        let jacobian = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
        let (force, velocity) = (part(&message.wrench), part(&message.velocity));
        let all = message.wrench.iter().chain(&message.velocity);
        let all = all.chain(message.jacobian.iter().flatten());
        let pose = message
            .pose
            .position_m
            .iter()
            .chain(&message.pose.orientation);
        if !all
            .chain(pose)
            .chain([&scale])
            .all(|number| number.is_finite())
        {
            return Err("a number is not finite");
        }
        if scale < 0.0 || drives(&jacobian) {
            return Err(
                "the force grows with the hand's velocity: paint would accelerate the hand",
            );
        }
        if message.time_to_live_ns > ContactModel::TIME_TO_LIVE_MOST_NS
            || message.recovery_ns > ContactModel::RECOVERY_MOST_NS
        {
            return Err("the time to live or the recovery is longer than a second");
        }
        let film = Film {
            at_rest: force - jacobian * velocity,
            jacobian,
        }
        .times(scale);
        Ok(Self {
            film: bounded(film),
            time_to_live_s: message.time_to_live_ns as f64 * 1e-9,
            recovery_s: message.recovery_ns as f64 * 1e-9,
        })
    }

    /// Share of its motion that the paint may still have at an age, s.
    fn still_moves(&self, age_s: f64) -> f64 {
        if self.recovery_s <= 0.0 {
            return 1.0;
        }
        (2.0 - age_s / self.recovery_s).clamp(0.0, 1.0)
    }
}

/// A film whose drag is scaled down to the bound of a device.
fn bounded(film: Film) -> Film {
    let columns = [
        film.jacobian.x_axis,
        film.jacobian.y_axis,
        film.jacobian.z_axis,
    ];
    let squares = columns.map(DVec3::length_squared);
    let size = (squares[0] + squares[1] + squares[2]).sqrt();
    // A film drags along two axes: √2 times the bound of one.
    let most = MOST_DRAG * std::f64::consts::SQRT_2;
    let film = if size > most {
        film.times(most / size)
    } else {
        film
    };
    Film {
        at_rest: film.at_rest.clamp_length_max(MOST_FORCE_N),
        ..film
    }
}

/// True if v·J·v > 0 for some v: the symmetric part of −J has a negative principal minor.
fn drives(jacobian: &DMat3) -> bool {
    let s = (*jacobian + jacobian.transpose()) * -0.5;
    let at = |i: usize, j: usize| s.col(j)[i];
    let size = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let size = size.fold(0.0, |most: f64, (i, j)| most.max(at(i, j).abs()));
    let minor = |i: usize, j: usize| at(i, i) * at(j, j) - at(i, j) * at(j, i);
    let least = -ROUNDING * size;
    (0..3).any(|i| at(i, i) < least)
        || [(0, 1), (0, 2), (1, 2)]
            .into_iter()
            .any(|(i, j)| minor(i, j) < least * size)
        || s.determinant() < least * size * size
}

/// The newest fluid forces and the transition between them.
#[derive(Clone, Copy, Debug, Default)]
pub struct FluidStage {
    /// Film before the newest one.
    before: Film,
    /// Newest force, and its age, s.
    newest: Option<(Fluid, f64)>,
}

impl FluidStage {
    /// Replaces the force by a newer one.
    pub fn receive(&mut self, fluid: Fluid, fade_s: f64) {
        self.before = self.film(fade_s);
        self.newest = Some((fluid, 0.0));
    }

    /// Advances the ages by `passed_s`.
    pub fn age(&mut self, passed_s: f64) {
        if let Some((_, age_s)) = &mut self.newest {
            *age_s += passed_s;
        }
    }

    /// Current film; past its time to live it fades over `fade_s`.
    fn film(&self, fade_s: f64) -> Film {
        let Some((fluid, age_s)) = &self.newest else {
            return Film::NONE;
        };
        let share = if fluid.recovery_s > 0.0 {
            step_response(age_s / fluid.recovery_s)
        } else {
            1.0
        };
        let overdue_s = (age_s - fluid.time_to_live_s).max(0.0);
        let left = (1.0 - overdue_s / fade_s).max(0.0);
        let film = Film {
            at_rest: fluid.film.at_rest * fluid.still_moves(*age_s),
            ..fluid.film
        };
        self.before.toward(film, share).times(left)
    }

    /// The force on a hand of this velocity, m/s, N.
    #[must_use]
    pub fn force(&self, velocity: DVec3, fade_s: f64) -> DVec3 {
        let film = self.film(fade_s);
        film.at_rest + film.jacobian * velocity
    }
}

#[cfg(test)]
pub(crate) mod tests;
