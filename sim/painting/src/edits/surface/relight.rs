//! Changes the light, or how it becomes colour.

use maulstick_types::EditFields;
#[cfg(feature = "cli")]
use maulstick_types::scene;
use maulstick_types::scene::{Environment, Light, LightError};
#[cfg(feature = "cli")]
use maulstick_types::values::Quantity as _;
use maulstick_types::values::ValueError;
use serde::de::{Deserialize, Deserializer, Error};

use crate::edits::{Applied, Form, PaintingEdit, StepForm};
use crate::error::EditError;
use crate::painting::Painting;

/// Change the light
///
/// Front ends write a [`LightChange`], which needs the present light.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Relight {
    /// The light from now on; in range.
    #[serde(deserialize_with = "checked")]
    pub light: Light,
    /// True if the exposure is chosen again, so that the bare canvas does not clip.
    pub expose: bool,
}

fn checked<'de, D: Deserializer<'de>>(from: D) -> Result<Light, D::Error> {
    let light = Light::deserialize(from)?;
    light.check().map_err(D::Error::custom)?;
    Ok(light)
}

/// Changes of a light; absent fields are unchanged.
#[derive(Clone, Debug, Default, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct LightChange {
    /// Spectrum: A, D50, D65, FL2, FL8, FL11, or a CSV file of nm,power
    #[cfg_attr(feature = "cli", arg(long, value_name = "NAME|FILE"))]
    pub illuminant: Option<String>,
    /// Direction toward the lamp: right, up the canvas, out of it
    #[cfg_attr(feature = "cli", arg(long, value_name = "X,Y,Z", value_parser = three, allow_hyphen_values = true))]
    pub direction: Option<[f64; 3]>,
    /// Factor on the strength of the light
    #[cfg_attr(feature = "cli", arg(long, help = scene::Intensity::option_help(), allow_negative_numbers = true))]
    pub intensity: Option<f64>,
    /// Exposure; auto: the bare canvas just does not clip. Another spectrum starts with auto
    #[cfg_attr(feature = "cli", arg(long, value_name = "FACTOR|auto", value_parser = exposure, allow_negative_numbers = true))]
    pub exposure: Option<Exposure>,
    /// Factor on the slopes of the relief
    #[cfg_attr(feature = "cli", arg(long, help = scene::Relief::option_help(), allow_negative_numbers = true))]
    pub relief: Option<f64>,
    /// Softness of shadows
    #[cfg_attr(feature = "cli", arg(long, help = scene::Softness::option_help(), allow_negative_numbers = true))]
    pub softness: Option<f64>,
    /// Surroundings that gloss mirrors: even, room, window, or a picture by latitude and longitude, twice as wide as high
    #[cfg_attr(feature = "cli", arg(long, value_name = "NAME|FILE"))]
    pub environment: Option<String>,
    /// CIE observer
    #[cfg_attr(feature = "cli", arg(long, value_name = "1931|1964"))]
    pub observer: Option<u32>,
    /// Wavelength rule: fitted, gauss, reference
    #[cfg_attr(feature = "cli", arg(long))]
    pub rule: Option<String>,
    /// Number of wavelengths
    #[cfg_attr(feature = "cli", arg(long, help = scene::Wavelengths::option_help()))]
    pub samples: Option<u32>,
    /// Adapt colours to the white of the light (white balance)
    #[cfg_attr(feature = "cli", arg(long = "adapt", value_name = "true|false"))]
    pub adapted: Option<bool>,
}

/// Exposure of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// Chosen so that the bare canvas does not clip.
    Auto,
    /// Factor of the eye.
    Factor(f64),
}

impl LightChange {
    /// Names of its fields.
    pub const KEYS: [&'static str; 11] = [
        "illuminant",
        "direction",
        "intensity",
        "exposure",
        "relief",
        "softness",
        "environment",
        "observer",
        "rule",
        "samples",
        "adapted",
    ];
}

impl<'de> Deserialize<'de> for Exposure {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        f64::deserialize(from).map(Self::Factor)
    }
}

impl LightChange {
    /// The light after the change; `illuminant` and `environment` are those that it names, read by a caller with access
    /// to files.
    ///
    /// # Errors
    /// [`LightError`] for a light out of range.
    pub fn on(
        &self,
        light: &Light,
        illuminant: Option<(String, Vec<f64>)>,
        environment: Option<Environment>,
    ) -> Result<Light, LightError> {
        let mut light = light.clone();
        if let Some((name, spectrum)) = illuminant {
            (light.illuminant, light.spectrum) = (name, spectrum);
        }
        light.environment = environment.unwrap_or(light.environment);
        light.direction = self.direction.unwrap_or(light.direction);
        let exposure = match self.exposure {
            Some(Exposure::Factor(factor)) => Some(factor),
            Some(Exposure::Auto) | None => None,
        };
        for (to, value) in [
            (&mut light.intensity, self.intensity),
            (&mut light.exposure, exposure),
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
        light.check()?;
        Ok(light)
    }

    /// Checks that all that a painter wrote has an effect.
    ///
    /// # Errors
    /// [`ValueError::Idle`].
    pub fn check_idle(&self) -> Result<(), ValueError> {
        if self.rule.as_deref() == Some("reference") && self.samples.is_some() {
            return Err(ValueError::Idle {
                option: "a number of samples",
                with: "the rule 'reference', which has all 101".to_owned(),
            });
        }
        Ok(())
    }
}

/// A text that is not an exposure or a direction.
#[cfg(feature = "cli")]
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
enum LightTextError {
    #[error("give a number, or auto")]
    Exposure,
    #[error("'{0}' is not three numbers such as -0.5,0.5,0.7")]
    Direction(String),
}

#[cfg(feature = "cli")]
fn exposure(text: &str) -> Result<Exposure, LightTextError> {
    match text.parse() {
        Ok(factor) => Ok(Exposure::Factor(factor)),
        Err(_) if text == "auto" => Ok(Exposure::Auto),
        Err(_) => Err(LightTextError::Exposure),
    }
}

/// Reads `x,y,z`.
#[cfg(feature = "cli")]
fn three(text: &str) -> Result<[f64; 3], LightTextError> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|cell| cell.trim().parse()).collect();
    numbers
        .ok()
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| LightTextError::Direction(text.to_owned()))
}

impl EditFields for Relight {
    const NAME: &'static str = "relight";
}

impl Form for Relight {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "light",
        &[],
        "{ light = { intensity = 2.0, direction = [-0.7, 0.3, 0.5] } }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&[
        "canvas",
        "light",
        "--intensity",
        "2",
        "--direction",
        "-0.7,0.3,0.5",
    ]);

    fn example() -> Result<Self, ValueError> {
        let change = LightChange {
            intensity: Some(2.0),
            direction: Some([-0.7, 0.3, 0.5]),
            ..LightChange::default()
        };
        Ok(Self {
            light: change.on(&Light::default(), None, None)?,
            expose: false,
        })
    }
}

impl PaintingEdit for Relight {
    /// Changes the light. If its spectrum, or its conversion to colour, changes, dry layers are baked again on demand,
    /// tile by tile.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let desk = &mut painting.bench.desk;
        desk.relight(&self.light)?;
        if self.expose {
            desk.expose();
        }
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        "change the light".to_owned()
    }
}
