//! Changes of the light over a painting, with the spectrum and the surroundings of files.

use maulstick_optics::Illuminant;
use maulstick_painting::edits::LightChange;
use maulstick_rig::UserError;
use maulstick_types::scene::Light;

use crate::surface::environment::environment;
use crate::viewing::illuminant;

/// The light after a change.
///
/// # Errors
/// A [`UserError`] for an unknown spectrum or environment or a bad file, and for a light out of range.
pub fn changed(change: &LightChange, light: &Light) -> Result<Light, UserError> {
    change.check_idle()?;
    let spectrum = match &change.illuminant {
        None => None,
        Some(name) => {
            let found = illuminant(name)?;
            let known = Illuminant::named(&found.name);
            let power = if known.as_ref() == Some(&found) {
                Vec::new()
            } else {
                found.power.0.to_vec()
            };
            Some((found.name, power))
        }
    };
    let around = change.environment.as_deref().map(environment);
    Ok(change.on(light, spectrum, around.transpose()?)?)
}
