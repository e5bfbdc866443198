//! Changes of the light over a painting.

use maulstick_optics::Illuminant;
use maulstick_rig::UserError;
use maulstick_types::scene::Light;

use crate::viewing::illuminant;

/// Changes of a light; an absent field stays as it is. The names are those of [`Light`].
#[derive(Clone, Debug, Default)]
pub struct LightChange {
    /// A name, or a CSV file of nm,power.
    pub illuminant: Option<String>,
    /// Toward the lamp: right, up the canvas, out of it.
    pub direction: Option<[f64; 3]>,
    /// Factor on its strength.
    pub intensity: Option<f64>,
    /// Factor of the eye that looks at it.
    pub exposure: Option<f64>,
    /// Factor on the slopes of the relief.
    pub relief: Option<f64>,
    /// Tangent of half the angle under which the lamp is seen.
    pub softness: Option<f64>,
    /// CIE observer: 1931 or 1964.
    pub observer: Option<u32>,
    /// Sampling rule: fitted, gauss, reference.
    pub rule: Option<String>,
    /// Wavelengths of the rule, 4 to 16.
    pub samples: Option<u32>,
    /// True if the eye is adapted to the light's white.
    pub adapted: Option<bool>,
}

impl LightChange {
    /// The light after the change.
    ///
    /// # Errors
    /// A [`UserError`] for an unknown spectrum, or an invalid light.
    pub fn on(&self, light: &Light) -> Result<Light, UserError> {
        let mut light = light.clone();
        if let Some(name) = &self.illuminant {
            let found = illuminant(name)?;
            let known = Illuminant::named(&found.name);
            light.spectrum = match known.as_ref() == Some(&found) {
                true => Vec::new(),
                false => found.power.0.to_vec(),
            };
            light.illuminant = found.name;
        }
        light.direction = self.direction.unwrap_or(light.direction);
        for (to, value) in [
            (&mut light.intensity, self.intensity),
            (&mut light.exposure, self.exposure),
            (&mut light.relief, self.relief),
            (&mut light.softness, self.softness),
        ] {
            *to = value.unwrap_or(*to);
        }
        light.observer = self.observer.unwrap_or(light.observer);
        light.samples = self.samples.unwrap_or(light.samples);
        light.adapted = self.adapted.unwrap_or(light.adapted);
        if let Some(rule) = &self.rule {
            light.rule.clone_from(rule);
        }
        light.check().map_err(UserError::told)?;
        Ok(light)
    }
}
