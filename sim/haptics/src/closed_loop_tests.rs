//! Stability of servo, device and hand in a closed loop, on a clock of its own.
//!
//! | module | holds |
//! | --- | --- |
//! | [`walls`] | bare walls at every stiffness and delay, and strokes over linen |
//! | [`guides`] | guides at every stiffness and delay, and strokes along a wavy path |
//! | [`recorded_models`] | contact models of one hand, replayed to others |
//! | [`scaled_devices`] | devices whose frame is smaller or larger than the desk |
//! | [`zero_order_hold`] | energy that sampling adds, by the period, the device's friction and its encoders |

mod guides;
mod recorded_models;
mod scaled_devices;
mod walls;
mod zero_order_hold;

pub(crate) use crate::extent::Extent;
use crate::plant::Hand;
use crate::servo::limits::Limits;

pub(crate) const HANDS: [Hand; 3] = [Hand::FINGERTIP, Hand::PEN_GRIP, Hand::ARM];
/// Period of the servo, s.
pub(crate) const DT: f64 = 1e-3;
/// Length of the head, m.
pub(crate) const HEAD_M: f64 = 0.025;

/// Greatest movement of the tip that counts as still, peak to peak, m: a literal, independent of the stability grid's
/// own.
pub(crate) const STILL_M: f64 = 1e-4;
/// Bounds of [`device`], N and N/s: literals, because the servo's own are under test.
pub(crate) const MOST_N: f64 = 1.5;
pub(crate) const MOST_SLEW_N_S: f64 = 200.0;

/// A device of 1.5 N and 200 N/s with a bound of 500 N/m.
pub(crate) fn device() -> Limits {
    Limits {
        max_force_n: 1.5,
        continuous_force_n: 1.5,
        slew_n_s: 200.0,
        max_stiffness_n_m: 500.0,
        damping_n_s_m: 0.3,
        ..Limits::default()
    }
}

/// Limits without the guards, as if the device's damping absorbed all that sampling adds: only the bounds of the bare
/// force remain.
pub(crate) fn unguarded() -> Limits {
    Limits {
        max_force_n: 3.3,
        continuous_force_n: 3.3,
        max_stiffness_n_m: 1e9,
        damping_n_s_m: 1e9,
        oscillation_m: f64::INFINITY,
        max_speed_m_s: f64::INFINITY,
        ..Limits::default()
    }
}

/// Uniform on [0, 1): the upper bits of a linear congruential generator (Knuth's multiplier).
pub(crate) fn random(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 40) as f64 / (1u64 << 24) as f64
}
