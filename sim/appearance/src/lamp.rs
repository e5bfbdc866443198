//! The scene's lamp over one of its surfaces.

use glam::DVec3;
use maulstick_num::geometry::Rigid;
use maulstick_optics::light::{LOWEST_LAMP, Lamp, LampSetup};
use maulstick_types::scene::{CANVAS, Light, Scene};

use crate::light::{cast, environment};

/// Brightness of the lightest fiftieth of bare linen beyond its mean, by its mean and by the tangent of the lamp's angle
/// from the vertical: measured on cells of .125 mm.
const GLARE: f64 = 0.08;
/// That tangent up to which a painting's exposure is as it was chosen.
const HIGH_LAMP: f64 = 1.5;

/// The exposure of a light under its lamp: under a low one the slopes of a cloth are far brighter than its mean, and the eye
/// narrows until they do not glare.
#[must_use]
pub fn exposure_under(light: &Light) -> f64 {
    let toward = DVec3::from_array(light.direction);
    let tangent = toward.truncate().length() / toward.z.max(1e-9);
    let beyond = 1.0 + GLARE * tangent.min(1.0 / LOWEST_LAMP);
    light.exposure * ((1.0 + GLARE * HIGH_LAMP) / beyond).min(1.0)
}

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
        exposure: exposure_under(light),
        relief: light.relief,
        softness: light.softness,
        colour: cast(light),
        environment: environment(light),
    })
}
