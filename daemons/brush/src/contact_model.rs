//! The contact model for the hand that holds a brush.

use glam::DVec3;
use maulstick_brush::desk::Plane;
use maulstick_brush::head_stiffness::Press;
use maulstick_brush::{BrushFile, BrushModel};
use maulstick_canvas::relief::tooth::Tooth;
use maulstick_types::Origin;
use maulstick_types::haptics::{ContactModel, ForceLaw, Grain, HeightPatch};
use maulstick_types::scene::{CANVAS, Scene};

/// k₂ of eq. 8.1: further force a head's length below, N.
const K2_N: f64 = 6.0;
/// k₁ at most: a stiffer brush would be a hard wall to a hand that light, N.
const K1_MOST_N: f64 = 3.0;
/// After this time without another model the force fades, ns.
const TIME_TO_LIVE_NS: u64 = 100_000_000;
/// A change of model is spread over this time, ns.
const RECOVERY_NS: u64 = 15_000_000;

/// Force law of a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ForceKind {
    /// Two straight pieces, k₁ that of the solved head (Baxter 2004, eq. 8.1).
    #[default]
    Linear,
    /// The piecewise cubic of the brush file (fig. 8.2).
    Hermite,
    /// The solved head, linearised where it is.
    Local,
    /// A hard wall, for comparison.
    Rigid,
    /// No force, for comparison.
    None,
}

impl ForceKind {
    /// The law of this name in `rig.toml`.
    #[must_use]
    pub fn of(name: &str) -> Option<Self> {
        Some(match name {
            "linear" => Self::Linear,
            "hermite" => Self::Hermite,
            "local" => Self::Local,
            "rigid" => Self::Rigid,
            "none" => Self::None,
            _ => return None,
        })
    }
}

/// The hard wall: each device bears less, and gives what it bears, N/m.
const RIGID_N_M: f64 = 2000.0;

/// Normal force by depth over `plane`, as the brush is bent now.
#[must_use]
pub fn law(kind: ForceKind, brush: &mut BrushModel, plane: &Plane) -> ForceLaw {
    let pressed = match kind {
        ForceKind::Local => brush.press(),
        _ => None,
    };
    match (kind, pressed) {
        (ForceKind::None, _) => ForceLaw::None,
        (ForceKind::Rigid, _) => ForceLaw::Rigid {
            stiffness_n_m: RIGID_N_M,
        },
        (ForceKind::Hermite, _) => ForceLaw::Hermite {
            knots: brush.tuples(),
        },
        (_, Some(press)) => local(&press, plane.normal()),
        // A head in the air, too.
        _ => ForceLaw::Linear {
            k1_n: brush.stiffness().k1_n.min(K1_MOST_N),
            k2_n: K2_N,
        },
    }
}

/// A pressed head: its force along the normal, and how that goes with depth.
fn local(press: &Press, normal: DVec3) -> ForceLaw {
    let [x, y, z] = normal.to_array();
    let rows = [x, y, z].map(|a| [x, y, z].map(|b| -press.stiffness_n_m * a * b));
    ForceLaw::Local {
        pose: press.pose.to_pose(),
        force_n: (normal * press.force_n).to_array(),
        stiffness_n_m: rows,
    }
}

/// No grain.
pub const NO_GRAIN: Grain = Grain {
    amplitude: 0.0,
    wavelength_m: 1e-3,
    seed: 0,
};
/// Share of the slope of the tooth that acts on a tuft: it rests on many threads.
const FELT_OF_SLOPE: f64 = 0.1;

/// Shortest wave that acts on the hand, m: twice what a device refuses.
const FINEST_M: f64 = 4e-4;

/// The grain of the canvas: amplitude π·depth/λ, the steepest slope of a wave as deep as the tooth, by the share of it
/// that acts on a tuft.
#[must_use]
pub fn grain(scene: &Scene) -> Grain {
    let canvas = scene.surfaces.iter().find(|surface| surface.id == CANVAS);
    let tooth = canvas.and_then(|surface| {
        let tooth = Tooth::new(&surface.tooth, surface.tooth_seed, surface.cell_m)?;
        Some((surface, tooth.relief_m()))
    });
    let grain = tooth.map(|(surface, [depth, wide])| Grain {
        amplitude: FELT_OF_SLOPE * std::f64::consts::PI * depth / wide,
        wavelength_m: wide * surface.zoom,
        seed: surface.tooth_seed,
    });
    // Of a canvas seen from afar it is too fine for a device.
    let felt = grain.filter(|grain| grain.wavelength_m >= FINEST_M);
    felt.unwrap_or(NO_GRAIN)
}

/// Surface properties that enter the contact model.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceFeel {
    /// Normal force by depth.
    pub law: ForceLaw,
    /// Grain of the canvas.
    pub grain: Grain,
    /// Relief around the brush.
    pub relief: HeightPatch,
}

/// Contact model of a surface under a brush, the tip of whose unbent head is at a place of the desk, m.
#[must_use]
pub fn contact_model(
    device: Origin,
    brush: &str,
    (file, tip): (&BrushFile, DVec3),
    plane: &Plane,
    felt: SurfaceFeel,
) -> ContactModel {
    let (point, normal) = (plane.to_desk.point(DVec3::ZERO), plane.normal());
    let friction = file.contact.friction;
    let on_canvas = plane.id == CANVAS;
    ContactModel {
        device: device.source,
        device_epoch: device.epoch,
        brush: brush.to_owned(),
        plane_point_m: point.to_array(),
        plane_normal: normal.to_array(),
        friction_static: file.contact.friction_static.unwrap_or(friction),
        friction_kinetic: friction,
        // Paint drags by the fluid force, once.
        viscous_n_s_m: 0.0,
        grain: if on_canvas { felt.grain } else { NO_GRAIN },
        law: felt.law,
        head_length_m: file.length_m(),
        time_to_live_ns: TIME_TO_LIVE_NS,
        recovery_ns: RECOVERY_NS,
        relief: felt.relief,
        depth_m: (point - tip).dot(normal),
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::{Rigid, rotation};
    use maulstick_painting::PaintingSetup;

    use super::*;

    fn scene(tooth: &str, zoom: f64) -> Scene {
        let mut scene = PaintingSetup::default().scene();
        scene.surfaces[0].tooth = tooth.into();
        scene.surfaces[0].zoom = zoom;
        scene
    }

    #[test]
    fn a_rough_canvas_is_felt_more_than_a_smooth_one_and_none_from_afar() {
        let of = |tooth: &str| grain(&scene(tooth, 1.0));
        let linen = of("linen");
        // 80 µm deep every .9 mm.
        assert!((linen.amplitude - 0.0279).abs() < 1e-4, "{linen:?}");
        assert!((linen.wavelength_m - 0.9e-3).abs() < 1e-12);
        assert!(of("panel").amplitude < 0.1 * linen.amplitude);
        assert_eq!(grain(&scene("linen", 0.1)), NO_GRAIN);
        assert_eq!(of("no tooth"), NO_GRAIN);
    }

    #[test]
    fn a_model_has_the_depth_of_the_unbent_tip_along_the_normal_and_the_length_of_the_head() {
        let file = BrushFile::library("round").expect("a brush");
        // A plane through (0, 0, 30 mm) that leans by 30° to +y.
        let lean = rotation(DVec3::X, -std::f64::consts::FRAC_PI_6);
        let plane = Plane {
            id: CANVAS,
            to_desk: Rigid {
                rotation: lean,
                translation: DVec3::new(0.0, 0.0, 0.03),
            },
            zoom: 1.0,
            size_m: [0.2, 0.1],
            cell_m: 1e-3,
            radii_m: [0.0; 4],
        };
        let deep = |tip: DVec3| {
            let felt = SurfaceFeel {
                law: ForceLaw::None,
                grain: NO_GRAIN,
                relief: HeightPatch::flat(),
            };
            let hand = Origin {
                source: 1,
                epoch: 1,
            };
            contact_model(hand, "main", (&file, tip), &plane, felt)
        };
        // 20 mm below the point above which it lies, and 6 mm beside it.
        let tip = DVec3::new(6e-3, 0.0, 0.01);
        let expected_m = 0.02 * 3f64.sqrt() / 2.0;
        assert!((deep(tip).depth_m - expected_m).abs() < 1e-12);
        let above = DVec3::new(0.0, 0.0, 0.04);
        assert!(deep(above).depth_m < 0.0, "it is in the air");
        assert!((deep(tip).head_length_m - file.length_m()).abs() < 1e-12);
    }
}
