//! An example of a scene.

use maulstick_types::Mixture;
use maulstick_types::scene::{
    BrushSet, Environment, Layer, Light, NamedVersion, PaintSlot, Scene, Surface, Tuning, Well, WellKind,
};

use super::{handling, pose};

/// An example of a surface.
fn surface() -> Surface {
    let well = |kind: WellKind| Well {
        center_m: [0.1, 0.2],
        radius_m: 0.01,
        kind,
    };
    Surface {
        id: 0,
        pose: pose(),
        zoom: 1.0,
        cells: [64, 32],
        cell_m: 2.5e-4,
        ground: "gesso".into(),
        tooth: "linen".into(),
        tooth_seed: 2,
        wells: vec![
            well(WellKind::Cleaner),
            well(WellKind::Medium),
            well(WellKind::Paint {
                mixture: Mixture::pure("Bone Black"),
            }),
        ],
        stain_m: 1e-5,
        piles_last: true,
        model: "impasto".into(),
    }
}

/// An example of a light.
fn light() -> Light {
    Light {
        direction: [0.0, 0.0, 1.0],
        intensity: 1.0,
        illuminant: "D65".into(),
        spectrum: vec![1.0; 2],
        exposure: 0.9,
        relief: 2.0,
        softness: 0.1,
        observer: 1964,
        rule: "gauss".into(),
        samples: 8,
        adapted: false,
        environment: Environment::Picture {
            name: "hall".into(),
            texels: vec![128, 64, 0, 129],
        },
    }
}

/// An example of a scene.
pub(crate) fn scene() -> Scene {
    Scene {
        version: 1,
        surfaces: vec![surface()],
        paints: vec![PaintSlot {
            name: "Bone Black".into(),
            masstone: [0.01; 3],
            tint: [0.5; 3],
            file_hash: 3,
        }],
        light: light(),
        tunings: vec![Tuning {
            brush: "main".into(),
            stiffness: 1.5,
            wetness: 0.5,
        }],
        layers: vec![Layer {
            number: 1,
            name: "sky".into(),
            opacity: 0.5,
        }],
        versions: vec![NamedVersion {
            name: "warm".into(),
            parent: "sketch".into(),
            here: true,
        }],
        handlings: vec![handling()],
        sets: vec![BrushSet {
            brush: "main".into(),
            given: 2,
            angles_rad: vec![[0.01, -0.02]],
        }],
    }
}
