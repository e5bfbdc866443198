//! Internal reflectance of films, a plane a wavelength: [`Studio::bake`] on the device.

use maulstick_optics::Studio;

use crate::stage::Stage;

/// Baking of films.
pub(crate) static BAKE_FILMS: Stage = Stage {
    name: "bake_films",
    source: concat!(
        include_str!("shaders/films.wgsl"),
        include_str!("shaders/bake_films.wgsl")
    ),
    constants: |studio| vec![("samples", studio.wavelengths() as f64)],
    planes: Studio::wavelengths,
};
