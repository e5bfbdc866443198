//! Linear sRGB of films through the surface: [`Studio::shade`] on the device.

use maulstick_optics::Studio;

use crate::stage::Stage;

/// Shading of films.
pub(crate) static SHADE_FILMS: Stage = Stage {
    name: "shade_films",
    source: concat!(
        include_str!("shaders/films.wgsl"),
        include_str!("shaders/shade_films.wgsl")
    ),
    constants,
    planes: |_| 3,
};

fn constants(studio: &Studio) -> Vec<(&'static str, f64)> {
    let surface = studio.surface();
    vec![
        ("samples", studio.wavelengths() as f64),
        ("k2", surface.k2),
        ("open", (1.0 - surface.k1) * (1.0 - surface.k2)),
    ]
}
