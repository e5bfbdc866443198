//! The lamp of a scene.

use crate::quantity;
use crate::values::{OutOfRange, Quantity};
use crate::wire::define::{wire_enum, wire_struct};

quantity! {
    /// Factor on the light's strength.
    pub Intensity: "intensity", 0.0..=100.0, 0.1..=10.0, "",
    "How strong the lamp is; 1 as it was built"
}
quantity! {
    /// Factor of the eye, or camera, that looks at the painting.
    pub Exposure: "exposure", 0.0..=100.0, 0.1..=10.0, "",
    "How much of the light the eye takes"
}
quantity! {
    /// Factor on the slopes of the relief.
    pub Relief: "relief strength", 0.0..=10.0, 0.0..=5.0, "",
    "How strongly brush marks stand out; 1 as they are, 0 flat"
}
quantity! {
    /// Tangent of half the angle under which the lamp is seen.
    pub Softness: "softness of shadows", 0.0..=1.0, Self::RANGE, "",
    "How large the lamp is: 0 casts sharp shadows, 1 soft ones"
}
quantity! {
    /// Wavelengths of the rules `gauss` and `fitted`.
    pub Wavelengths: "number of wavelengths", 4.0..=16.0, Self::RANGE, "",
    "Wavelengths that are computed"
}

/// Names of the sampling rules.
pub const RULES: [&str; 3] = ["gauss", "fitted", "reference"];
/// The name of an illuminant has at most this many bytes.
pub const ILLUMINANT_NAME_MAX: usize = 128;

/// Bytes of the map of [`Environment::Picture`].
pub const ENVIRONMENT_BYTES: usize = 4 * (33 * 33 + 17 * 17 + 9 * 9 + 5 * 5);
/// Largest exponent of its texels: radiances below 2¹⁶ times their mean.
const EXPONENT_MAX: u8 = 128 + 16;

wire_enum! {
    /// Surroundings of a picture, which its gloss mirrors besides the lamp.
    #[derive(Default, Eq)]
    pub enum Environment {
        /// A room that is even, and dimmer below the picture.
        #[default]
        Even,
        /// A studio: a window wall at the left, a dim wall behind the viewer.
        Room,
        /// A dark room with a tall window of eight panes at the left.
        Window,
        /// Surroundings of a picture file.
        Picture {
            /// Name of the file without its ending.
            name: String,
            /// What slopes mirror at roughness .1, .2, .4 and .8, relative radiance of mean 1: squares of 33, 17, 9 and
            /// 5 texels a side over slopes of −1 to 1, rows from the lowest. Texel (i, j) of a square of n is what the
            /// slope (1 − 2i/(n − 1), 1 − 2j/(n − 1)) mirrors to a viewer straight above. A texel is mantissas of linear
            /// red, green and blue and an exponent e: m·2^(e − 136).
            texels: Vec<u8>,
        },
    }
}

impl Environment {
    /// Names of those that need no file.
    pub const NAMES: [&'static str; 3] = ["even", "room", "window"];

    /// One of these by its name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let place = Self::NAMES.iter().position(|own| *own == name)?;
        [Self::Even, Self::Room, Self::Window]
            .into_iter()
            .nth(place)
    }

    /// Its name, or that of its file.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Even => Self::NAMES[0],
            Self::Room => Self::NAMES[1],
            Self::Window => Self::NAMES[2],
            Self::Picture { name, .. } => name,
        }
    }

    fn check(&self) -> Result<(), LightError> {
        let Self::Picture { name, texels } = self else {
            return Ok(());
        };
        if name.len() > ILLUMINANT_NAME_MAX {
            return Err(LightError::EnvironmentName(name.len()));
        }
        let mut exponents = texels.chunks(4).map(|texel| texel.last().copied());
        let is_bounded = exponents.all(|exponent| exponent <= Some(EXPONENT_MAX));
        if texels.len() == ENVIRONMENT_BYTES && is_bounded {
            Ok(())
        } else {
            Err(LightError::Environment)
        }
    }
}

wire_struct! {
    /// The lamp, what is around, and how its light becomes colour.
    pub struct Light {
        /// Toward the lamp, canvas frame; of any length.
        pub direction: [f64; 3],
        /// Factor on the light's strength.
        pub intensity: f64,
        /// Name of the spectrum.
        pub illuminant: String,
        /// The spectrum itself where it is none of the CIE's: relative power at 101 wavelengths,
        /// 380 to 780 nm; empty for one that is known by its name.
        pub spectrum: Vec<f64>,
        /// Factor of the eye, or camera, that looks at it.
        pub exposure: f64,
        /// Factor on the slopes of the relief.
        pub relief: f64,
        /// Tangent of half the angle under which the lamp is seen: how soft shadows are.
        pub softness: f64,
        /// Year of the CIE observer: 1931 or 1964.
        pub observer: u32,
        /// Sampling rule: `gauss`, `fitted` or `reference`.
        pub rule: String,
        /// Wavelengths of the rule; `reference` has 101.
        pub samples: u32,
        /// True if the eye is adapted to the light's white; otherwise its cast stays.
        pub adapted: bool,
        /// What gloss mirrors besides the lamp.
        #[serde(default)]
        pub environment: Environment,
    }
}

impl Default for Light {
    /// Average daylight from the upper left.
    fn default() -> Self {
        Self {
            direction: [-0.5, 0.5, 0.7],
            intensity: 1.0,
            illuminant: "D65".to_owned(),
            spectrum: Vec::new(),
            exposure: 1.0,
            relief: 1.0,
            softness: 0.3,
            observer: 1931,
            rule: "fitted".to_owned(),
            samples: 16,
            adapted: true,
            environment: Environment::Even,
        }
    }
}

/// A light that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LightError {
    /// A number out of range.
    #[error(transparent)]
    Range(#[from] OutOfRange),
    /// A lamp below the canvas, or of no direction.
    #[error("the light must come from above the canvas: give x, y, z with z > 0")]
    Below,
    /// The name of a spectrum that is too long.
    #[error("an illuminant's name has at most {ILLUMINANT_NAME_MAX} bytes, not {0}")]
    Name(usize),
    /// Powers that are no spectrum.
    #[error("this is not a spectrum: give 101 powers of 0 or more, not all of them 0")]
    Spectrum,
    /// An observer that the CIE does not have.
    #[error("there is no CIE observer of {0}: choose 1931 or 1964")]
    Observer(u32),
    /// The name of surroundings that is too long.
    #[error("the name of an environment has at most {ILLUMINANT_NAME_MAX} bytes, not {0}")]
    EnvironmentName(usize),
    /// Surroundings that are no map.
    #[error("this is not an environment: give {ENVIRONMENT_BYTES} bytes of radiances below 65536")]
    Environment,
    /// An unknown sampling rule.
    #[error("there is no such sampling rule: choose one of {}", RULES.join(", "))]
    Rule,
}

impl Light {
    /// Checks that it shines, in bounds.
    ///
    /// # Errors
    /// [`LightError`].
    pub fn check(&self) -> Result<(), LightError> {
        Intensity::check(self.intensity)?;
        Exposure::check(self.exposure)?;
        Relief::check(self.relief)?;
        Softness::check(self.softness)?;
        let length: f64 = self.direction.iter().map(|v| v * v).sum();
        if !(1e-6..=1e6).contains(&length) || self.direction[2] <= 0.0 {
            return Err(LightError::Below);
        }
        if self.illuminant.len() > ILLUMINANT_NAME_MAX {
            return Err(LightError::Name(self.illuminant.len()));
        }
        let power = &self.spectrum;
        let good = power.iter().all(|v| (0.0..=1e9).contains(v)) && power.iter().any(|v| *v > 0.0);
        if !power.is_empty() && (power.len() != 101 || !good) {
            return Err(LightError::Spectrum);
        }
        if ![1931, 1964].contains(&self.observer) {
            return Err(LightError::Observer(self.observer));
        }
        if !RULES.contains(&self.rule.as_str()) {
            return Err(LightError::Rule);
        }
        if self.rule != "reference" {
            Wavelengths::check(f64::from(self.samples))?;
        }
        self.environment.check()
    }
}
