//! A ball lit by the lamp, seen from above.

use eframe::egui::{Color32, ColorImage, Rgba};
use maulstick_appearance::lamp::exposure_under;
use maulstick_appearance::light::{cast, environment};
use maulstick_optics::light::{AMBIENT, Lamp, LampSetup};
use maulstick_types::scene::Light;

/// Side of the picture, pixels.
pub(super) const SIDE: usize = 256;
/// Share of the light that the ball throws back, and that its gloss does at most.
const ALBEDO: f32 = 0.5;
const GLOSS: f32 = 0.5;
/// Share of the surroundings that its gloss mirrors, and its roughness.
const SHEEN: f32 = 0.06;
const ROUGH: f32 = 0.15;
/// Exponent of its highlight.
const SHARPNESS: i32 = 48;

#[must_use]
pub(super) fn draw(light: &Light) -> ColorImage {
    let lamp = Lamp::new(&LampSetup {
        toward: light.direction,
        intensity: light.intensity,
        exposure: exposure_under(light),
        relief: light.relief,
        softness: light.softness,
        colour: cast(light),
        environment: environment(light),
    });
    let radius = 0.5 * SIDE as f32;
    let pixel = |place: usize| {
        let x = ((place % SIDE) as f32 + 0.5 - radius) / radius;
        let y = (radius - (place / SIDE) as f32 - 0.5) / radius;
        let across = (x * x + y * y).sqrt();
        // The rim is as wide as a pixel.
        let cover = (radius * (1.0 - across)).clamp(0.0, 1.0);
        let up = (1.0 - across * across).max(0.0).sqrt();
        let [red, green, blue] = lit(&lamp, [x, y, up]);
        Color32::from(Rgba::from_rgb(red, green, blue) * cover)
    };
    ColorImage::new([SIDE, SIDE], (0..SIDE * SIDE).map(pixel).collect())
}

/// Light that a point of the ball with this normal sends to the eye, linear.
fn lit(lamp: &Lamp, normal: [f32; 3]) -> [f32; 3] {
    let dot = |other: &[f32; 3]| (0..3).map(|i| normal[i] * other[i]).sum::<f32>();
    // A large lamp is not gone where its middle sets.
    let soft = lamp.softness;
    let incidence = ((dot(&lamp.toward) + soft) / (1.0 + soft)).max(0.0);
    let diffuse = AMBIENT + (1.0 - AMBIENT) * incidence;
    let [x, y, z] = lamp.toward;
    let length = (2.0 * (1.0 + z)).sqrt();
    let half = [x / length, y / length, (1.0 + z) / length];
    let gleam = GLOSS * dot(&half).max(0.0).powi(SHARPNESS);
    let slope = [0, 1].map(|i| -normal[i] / normal[2].max(1e-3));
    let around = lamp.environment.as_ref();
    let around = around.map_or([0.0; 3], |map| map.mirrored(slope, ROUGH));
    [0, 1, 2].map(|i| {
        let value = ALBEDO * diffuse + gleam + SHEEN * around[i];
        (lamp.intensity * value * lamp.colour[i]).clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(image: &ColorImage, x: f32, y: f32) -> [u8; 4] {
        let place = |v: f32| ((0.5 + 0.5 * v) * SIDE as f32) as usize;
        image.pixels[place(-y) * SIDE + place(x)].to_array()
    }

    #[test]
    fn the_ball_is_bright_toward_the_lamp_and_nothing_lies_beside_it() {
        let light = Light {
            direction: [-0.6, 0.6, 0.5],
            ..Light::default()
        };
        let image = draw(&light);
        let [bright, dark] = [at(&image, -0.5, 0.5), at(&image, 0.5, -0.5)];
        assert!(bright[0] > dark[0] + 60, "{bright:?} {dark:?}");
        assert_eq!(at(&image, 0.99, 0.99), [0; 4]);
        let other = draw(&Light {
            direction: [0.6, -0.6, 0.5],
            ..Light::default()
        });
        assert!(
            at(&other, -0.5, 0.5)[0] < at(&other, 0.5, -0.5)[0],
            "a fault would pass"
        );
    }

    #[test]
    fn lamplight_is_warm_to_an_eye_that_is_not_used_to_it() {
        let bulb = |adapted: bool| Light {
            illuminant: "A".to_owned(),
            adapted,
            ..Light::default()
        };
        let warm = at(&draw(&bulb(false)), 0.0, 0.0);
        let white = at(&draw(&bulb(true)), 0.0, 0.0);
        assert!(warm[0] > warm[2] + 40, "{warm:?}");
        assert_eq!(white[0], white[2]);
    }
}
