//! A desk with a bare canvas in its middle.

use maulstick_types::Pose;
use maulstick_types::scene::{Light, Scene, Surface};

pub(crate) fn scene() -> Scene {
    let canvas = Surface {
        id: 0,
        pose: Pose {
            position_m: [-0.128, -0.128, 0.0],
            ..Pose::IDENTITY
        },
        zoom: 1.0,
        cells: [1024; 2],
        cell_m: 2.5e-4,
        ground: "gesso".into(),
        tooth: "linen".into(),
        tooth_seed: 1,
        wells: Vec::new(),
        stain_m: 3e-6,
        piles_last: false,
        model: "impasto".into(),
    };
    let light = Light {
        direction: [0.0, 0.0, 1.0],
        ..Light::default()
    };
    Scene {
        version: 1,
        surfaces: vec![canvas],
        paints: Vec::new(),
        tunings: Vec::new(),
        layers: Vec::new(),
        versions: Vec::new(),
        handlings: Vec::new(),
        sets: Vec::new(),
        light,
    }
}
