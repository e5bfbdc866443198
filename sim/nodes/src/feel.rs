//! The contact model for the hand that holds a brush.

use glam::DVec3;
use maulstick_brush::BrushFile;
use maulstick_brush::desk::Plane;
use maulstick_brush::feel::Feel;
use maulstick_types::Origin;
use maulstick_types::haptics::{ContactModel, ForceLaw, Grain};

/// k₂ of eq. 8.1: further force a head's length below, N.
const K2_N: f64 = 6.0;
/// k₁ at most: a stiffer brush would be a hard wall to a hand that light, N.
const K1_MOST_N: f64 = 3.0;
/// After this time without another model the force fades, ns.
const TIME_TO_LIVE_NS: u64 = 100_000_000;
/// A change of model is spread over this time, ns.
const RECOVERY_NS: u64 = 15_000_000;

/// What the hand feels of a surface through a brush.
#[must_use]
pub fn contact_model(
    device: Origin,
    brush: &str,
    file: &BrushFile,
    plane: &Plane,
    feel: Feel,
) -> ContactModel {
    let friction = file.contact.friction;
    ContactModel {
        device: device.source,
        device_epoch: device.epoch,
        brush: brush.to_owned(),
        plane_point_m: plane.to_desk.point(DVec3::ZERO).to_array(),
        plane_normal: plane.normal().to_array(),
        friction_static: file.contact.friction_static.unwrap_or(friction),
        friction_kinetic: friction,
        viscous_n_s_m: 0.0,
        grain: Grain {
            amplitude: 0.0,
            wavelength_m: 1e-3,
            seed: 1,
        },
        law: ForceLaw::Linear {
            k1_n: feel.k1_n.min(K1_MOST_N),
            k2_n: K2_N,
        },
        head_length_m: file.length_m(),
        time_to_live_ns: TIME_TO_LIVE_NS,
        recovery_ns: RECOVERY_NS,
    }
}
