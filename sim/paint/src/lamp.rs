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

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::rotation;
    use maulstick_types::scene::PALETTE;

    use super::*;
    use crate::setup::PaintingSetup;

    #[test]
    fn a_turned_palette_is_lit_from_the_same_side_of_the_desk() {
        let mut scene = PaintingSetup::default().scene();
        assert_eq!(lamp_over(&scene, PALETTE), lamp_over(&scene, CANVAS));
        let quarter = rotation(DVec3::Z, std::f64::consts::FRAC_PI_2);
        scene.surfaces[1].pose.orientation = quarter.to_array();
        let [x, y, z] = lamp_over(&scene, CANVAS).toward;
        let turned = lamp_over(&scene, PALETTE).toward;
        for (got, expected) in turned.iter().zip([y, -x, z]) {
            assert!((got - expected).abs() < 1e-6, "{turned:?}");
        }
        // The lamp stays above the desk when canvas and palette turn together.
        scene.surfaces[0].pose.orientation = quarter.to_array();
        assert!((lamp_over(&scene, PALETTE).toward[0] - x).abs() < 1e-6);
        assert_eq!(lamp_over(&scene, 7), lamp_over(&scene, CANVAS));
    }

    #[test]
    fn exposure_relief_and_softness_are_the_scenes() {
        let mut scene = PaintingSetup::default().scene();
        (scene.light.intensity, scene.light.exposure) = (2.0, 0.25);
        (scene.light.relief, scene.light.softness) = (3.0, 0.4);
        let lamp = lamp_over(&scene, CANVAS);
        assert_eq!(
            (lamp.intensity, lamp.relief, lamp.softness),
            (0.5, 3.0, 0.4)
        );
    }
}
