//! `[light]` of the settings.

use std::path::Path;

use maulstick_types::scene::{Environment, Light};
use serde::{Deserialize, Serialize};

/// `[light]`: the lamp at the start, and how its light becomes colour.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LightSection {
    /// One of the CIE's illuminants, or a CSV file `nm,power`.
    pub illuminant: String,
    /// Year of the CIE observer: 1931 or 1964.
    pub observer: u32,
    /// True if the eye is adapted to the light's white.
    pub adapt: bool,
    /// `fitted`, `gauss` or `reference`.
    pub rule: String,
    /// Wavelengths of the rule, 4 to 16.
    pub samples: u32,
    /// Toward the lamp: x right, y up the canvas, z out of it.
    pub direction: [f64; 3],
    /// Factor on the light's strength.
    pub intensity: f64,
    /// Factor of the eye that looks at it; such that the bare canvas does not clip, if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exposure: Option<f64>,
    /// Factor on the slopes of the relief.
    pub relief: f64,
    /// Tangent of half the angle under which the lamp is seen.
    pub softness: f64,
    /// What gloss mirrors: `even`, `room`, `window`, or a picture by latitude and longitude.
    pub environment: String,
}

impl LightSection {
    /// The light, but for a spectrum and surroundings of its own; a spectrum of a file is called as the file is.
    #[must_use]
    pub fn light(&self) -> Light {
        let name = Path::new(&self.illuminant).file_stem();
        Light {
            direction: self.direction,
            intensity: self.intensity,
            illuminant: name.unwrap_or_default().to_string_lossy().into_owned(),
            spectrum: Vec::new(),
            exposure: self.exposure.unwrap_or(1.0),
            relief: self.relief,
            softness: self.softness,
            observer: self.observer,
            rule: self.rule.clone(),
            samples: self.samples,
            adapted: self.adapt,
            environment: Environment::named(&self.environment).unwrap_or_default(),
        }
    }
}

impl Default for LightSection {
    fn default() -> Self {
        let light = Light::default();
        Self {
            illuminant: light.illuminant,
            observer: light.observer,
            adapt: light.adapted,
            rule: light.rule,
            samples: light.samples,
            direction: light.direction,
            intensity: light.intensity,
            exposure: None,
            relief: light.relief,
            softness: light.softness,
            environment: light.environment.name().to_owned(),
        }
    }
}
