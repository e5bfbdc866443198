//! The contact model for the hand that holds a brush.

use glam::DVec3;
use maulstick_brush::BrushFile;
use maulstick_brush::desk::Plane;
use maulstick_brush::feel::Feel;
use maulstick_types::Origin;
use maulstick_types::haptics::{ContactModel, ForceLaw, Grain};
use maulstick_types::paint::BrushCredit;

/// k₂ of eq. 8.1: further force a head's length below, N.
const K2_N: f64 = 6.0;
/// k₁ at most: a stiffer brush would be a hard wall to a hand that light, N.
const K1_MOST_N: f64 = 3.0;
/// After this time without another model the force fades, ns.
const TIME_TO_LIVE_NS: u64 = 100_000_000;
/// A change of model is spread over this time, ns.
const RECOVERY_NS: u64 = 15_000_000;

/// Density of paint, kg/m³.
const DENSITY_KG_M3: f64 = 1e3;
/// Half of the drag is felt in a film of this thickness, m: bristles in a thinner one slide.
const HALF_FILM_M: f64 = 25e-6;
/// Drag at most, N·s/m: the servo samples it.
const DRAG_MOST: f64 = 0.5;

/// Drag of the paint that a brush was last found in, N·s/m: μ·L, the viscous force by velocity on a
/// contact of length L (Baxter 2004, eq. 8.8), as far as there is a film for it.
#[must_use]
pub fn drag(credit: &BrushCredit) -> f64 {
    let [film, viscosity, contact] = [credit.film_m, credit.viscosity_m2_s, credit.contact_m];
    let wet = f64::from(film) / (f64::from(film) + HALF_FILM_M);
    let drag = DENSITY_KG_M3 * f64::from(viscosity) * f64::from(contact) * wet;
    // What comes over the bus may be anything.
    if drag.is_finite() {
        drag.clamp(0.0, DRAG_MOST)
    } else {
        0.0
    }
}

/// What the hand feels of a surface through a brush, and of the paint's [`drag`].
#[must_use]
pub fn contact_model(
    device: Origin,
    brush: &str,
    file: &BrushFile,
    plane: &Plane,
    feel: Feel,
    drag_n_s_m: f64,
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
        viscous_n_s_m: drag_n_s_m,
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

#[cfg(test)]
mod tests {
    use super::*;

    fn credit(film_m: f32, viscosity_m2_s: f32) -> BrushCredit {
        BrushCredit {
            brush: 1,
            epoch: 1,
            next: 1,
            wetness: 1.0,
            film_m,
            viscosity_m2_s,
            contact_m: 0.01,
        }
    }

    #[test]
    fn stiff_paint_drags_and_thin_or_missing_paint_hardly_does() {
        let tube = drag(&credit(1e-3, 1e-2));
        assert!((tube - 0.1 * 1e-3 / 1.025e-3).abs() < 1e-6, "μ·L: {tube}");
        assert!(drag(&credit(1e-3, 1e-4)) < 0.02 * tube);
        assert!(drag(&credit(5e-6, 1e-2)) < 0.2 * tube);
        assert_eq!(drag(&credit(0.0, 0.0)), 0.0);
        assert_eq!(drag(&credit(f32::NAN, 1.0)), 0.0);
        assert_eq!(drag(&credit(1.0, f32::MAX)), DRAG_MOST);
    }
}
