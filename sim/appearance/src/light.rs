//! The scene's light as input of the optics.

use std::sync::Arc;

use maulstick_optics::colour::apply;
use maulstick_optics::light::EnvironmentMap;
use maulstick_optics::{Illuminant, Observer, RuleKind, Spectrum, StudioSettings};
use maulstick_types::scene::{Environment, Light};

use crate::error::LookError;

/// Optical settings of the light, without its direction and strength.
///
/// # Errors
/// [`LookError`] for a light out of bounds, or a name of no illuminant.
pub fn studio_settings(light: &Light) -> Result<StudioSettings, LookError> {
    light.check()?;
    let spectrum: Result<[f64; maulstick_optics::spectrum::SAMPLES], _> =
        light.spectrum.as_slice().try_into();
    let illuminant = match spectrum {
        Ok(power) => {
            let found = Illuminant {
                name: light.illuminant.clone(),
                power: Spectrum(power),
            };
            found.check()?;
            found
        }
        Err(_) => illuminant_named(&light.illuminant)?,
    };
    Ok(StudioSettings {
        light: illuminant,
        observer: match light.observer {
            1964 => Observer::Cie1964,
            _ => Observer::Cie1931,
        },
        rule: RuleKind::named(&light.rule).unwrap_or_default(),
        samples: light.samples as usize,
        adapted: light.adapted,
    })
}

/// One of the CIE's illuminants.
///
/// # Errors
/// [`LookError`] with the nearest name and all of them.
pub fn illuminant_named(name: &str) -> Result<Illuminant, LookError> {
    Illuminant::named(name).ok_or_else(|| LookError::NoIlluminant {
        name: name.to_owned(),
        known: maulstick_optics::cie::ILLUMINANTS.to_vec(),
    })
}

/// The light's own colour in linear sRGB, which an adapted eye sees as white.
#[must_use]
pub fn cast(light: &Light) -> [f64; 3] {
    if light.adapted {
        return [1.0; 3];
    }
    studio_settings(light).map_or([1.0; 3], |settings| {
        apply(&settings.to_rgb(), settings.white())
    })
}

/// What the gloss mirrors besides the lamp; `None` for an even room.
#[must_use]
pub fn environment(light: &Light) -> Option<Arc<EnvironmentMap>> {
    match &light.environment {
        Environment::Even => None,
        Environment::Room => Some(EnvironmentMap::room()),
        Environment::Window => Some(EnvironmentMap::window()),
        Environment::Picture { texels, .. } => EnvironmentMap::from_bytes(texels).map(Arc::new),
    }
}

/// True if two lights differ in their optical settings, which requires all colours to be recomputed.
#[must_use]
pub fn changes_colour(one: &Light, other: &Light) -> bool {
    let spectral = |light: &Light| {
        let Light {
            illuminant,
            spectrum,
            observer,
            rule,
            samples,
            adapted,
            ..
        } = light.clone();
        (illuminant, spectrum, observer, rule, samples, adapted)
    };
    spectral(one) != spectral(other)
}
