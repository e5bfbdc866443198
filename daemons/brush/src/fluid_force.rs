//! Drag of the paint on the hand that holds a brush (Baxter 2004, eq. 8.8).

use glam::{DMat3, DVec3};
use maulstick_types::haptics::FluidForce;
use maulstick_types::paint::BrushCredit;
use maulstick_types::stylus::{StylusPose, StylusSample};
use maulstick_types::{Origin, Pose};

/// After this time without another force it fades, ns.
const TIME_TO_LIVE_NS: u64 = 100_000_000;
/// Least time between two forces, over which one also gives way to the next, ns.
pub const PERIOD_NS: u64 = 15_000_000;

/// Density of paint, kg/m³.
const DENSITY_KG_M3: f64 = 1e3;
/// Film thickness at which half of the drag acts, m: bristles in a thinner one slide.
const HALF_FILM_M: f64 = 25e-6;
/// Factor on eq. 8.8, which gives 3 mN under a contact of 3 mm in paint from the tube at .1 m/s, less than a hand feels.
/// It lies near L/h, by which a film of thickness h that is sheared under the whole contact drags more than one as thick
/// as the contact is long.
const FELT: f64 = 20.0;
/// Drag at most, N·s/m: the servo samples it, and takes as much from no message.
const DRAG_MOST: f64 = 0.8;

/// Drag of the paint that a brush was last found in, N·s/m: μ·L, the viscous force by velocity on a
/// contact of length L (Baxter 2004, eq. 8.8), times [`FELT`], as far as there is a film for it.
#[must_use]
pub fn drag(credit: &BrushCredit) -> f64 {
    let [film, viscosity, contact] = [credit.film_m, credit.viscosity_m2_s, credit.contact_m];
    let wet = f64::from(film) / (f64::from(film) + HALF_FILM_M);
    let drag = FELT * DENSITY_KG_M3 * f64::from(viscosity) * f64::from(contact) * wet;
    // A message from the bus may hold any number.
    if drag.is_finite() {
        drag.clamp(0.0, DRAG_MOST)
    } else {
        0.0
    }
}

/// Pose and velocity of a handle, desk frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// Pose of the brush.
    pub pose: Pose,
    /// Velocity of the ferrule, m/s.
    pub velocity_m_s: DVec3,
}

impl Held {
    /// As a sample says.
    #[must_use]
    pub fn of(sample: &StylusSample) -> Self {
        let pose = match &sample.pose {
            StylusPose::Ferrule { pose } => pose.clone(),
            StylusPose::Contact { point_m, .. } => Pose {
                position_m: *point_m,
                ..Pose::IDENTITY
            },
        };
        Self {
            pose,
            velocity_m_s: DVec3::from_array(sample.velocity_m_s),
        }
    }
}

/// Drag of `drag_n_s_m` across a surface's unit `normal`, for the device.
#[must_use]
pub fn fluid_force(device: Origin, held: &Held, drag_n_s_m: f64, normal: DVec3) -> FluidForce {
    let across = DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
    let jacobian = (DMat3::IDENTITY - across) * -drag_n_s_m;
    let six = |v: DVec3| [v.x, v.y, v.z, 0.0, 0.0, 0.0];
    let row = |i: usize| six(jacobian.row(i));
    FluidForce {
        device: device.source,
        device_epoch: device.epoch,
        pose: held.pose.clone(),
        velocity: six(held.velocity_m_s),
        wrench: six(jacobian * held.velocity_m_s),
        jacobian: [row(0), row(1), row(2), [0.0; 6], [0.0; 6], [0.0; 6]],
        time_to_live_ns: TIME_TO_LIVE_NS,
        recovery_ns: PERIOD_NS,
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
            contact_m: 0.003,
            file: 0,
        }
    }

    #[test]
    fn stiff_paint_drags_and_thin_or_missing_paint_hardly_does() {
        let tube = drag(&credit(1e-3, 1e-2));
        // Newtons on a hand that paints at an ordinary and at a fast pace, and in a wash.
        let [slow, fast, wash] = [0.2 * tube, 1.0 * tube, 0.5 * drag(&credit(1e-3, 1e-5))];
        assert!(
            slow > 0.1 && fast < 1.0 && wash < 1e-3,
            "{slow} {fast} {wash}"
        );
        // Half the contact, half the drag.
        let mut half = credit(1e-3, 1e-2);
        half.contact_m *= 0.5;
        assert!((drag(&half) / tube - 0.5).abs() < 1e-6, "∝ L");
        assert!(drag(&credit(1e-3, 1e-4)) < 0.02 * tube);
        assert!(drag(&credit(5e-6, 1e-2)) < 0.2 * tube);
        assert_eq!(drag(&credit(0.0, 0.0)), 0.0);
        assert_eq!(drag(&credit(f32::NAN, 1.0)), 0.0);
        assert_eq!(drag(&credit(1.0, f32::MAX)), DRAG_MOST);
    }

    #[test]
    fn drag_is_across_the_normal_against_the_motion_and_a_servo_takes_it() {
        let device = Origin {
            source: 4,
            epoch: 5,
        };
        let normal = DVec3::new(0.0, 0.6, 0.8);
        let held = Held {
            pose: Pose::IDENTITY,
            velocity_m_s: DVec3::new(0.1, 0.02, -0.05),
        };
        let force = fluid_force(device, &held, 0.3, normal);
        maulstick_haptics::Fluid::new(&force, 1.0).expect("a servo takes it");
        let [x, y, z, ..] = force.wrench;
        let wrench = DVec3::new(x, y, z);
        assert!(wrench.dot(normal).abs() < 1e-15 && wrench.dot(held.velocity_m_s) < 0.0);
        assert!((wrench.x + 0.03).abs() < 1e-15);
        // The seeded fault: by an inward normal it would push, and no servo takes that.
        let pushing = fluid_force(device, &held, -0.3, normal);
        assert!(maulstick_haptics::Fluid::new(&pushing, 1.0).is_err());
    }
}
