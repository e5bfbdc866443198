//! The scene's lamp over one of its surfaces.

use glam::DVec3;
use maulstick_num::geometry::Rigid;
use maulstick_optics::light::{Lamp, LampSetup};
use maulstick_types::scene::{CANVAS, Scene};

use crate::light::cast;

/// The lamp in the frame of `surface`: the scene gives its direction in the canvas's. A surface that is not in the
/// scene is taken to be parallel to the canvas.
#[must_use]
pub fn lamp_over(scene: &Scene, surface: u32) -> Lamp {
    let pose = |id: u32| {
        let found = scene.surfaces.iter().find(|other| other.id == id);
        found.map_or(Rigid::IDENTITY, |found| Rigid::from(&found.pose))
    };
    let mut toward = DVec3::from_array(scene.light.direction);
    if surface != CANVAS && scene.surfaces.iter().any(|other| other.id == surface) {
        let on_desk = pose(CANVAS).vector(toward);
        toward = pose(surface).inverse().vector(on_desk);
    }
    let light = &scene.light;
    Lamp::new(&LampSetup {
        toward: toward.to_array(),
        intensity: light.intensity,
        exposure: light.exposure,
        relief: light.relief,
        softness: light.softness,
        colour: cast(light),
    })
}
