//! Options of light, observer and rule.

use std::path::Path;

use clap::{Args, ValueEnum};
use maulstick_appearance::light::illuminant_named;
use maulstick_optics::{Illuminant, Observer, PaintLibrary, RuleKind, StudioSettings, Viewing};
use maulstick_rig::UserError;
use maulstick_rig::config::is_path;
use maulstick_rig::table_file::{MOST_BYTES, read_table};
use maulstick_types::scene::Wavelengths;
use maulstick_types::values::Quantity;

use crate::refusal::refused;

/// Options of light and observer.
#[derive(Args, Clone, Debug)]
pub struct ViewingOptions {
    /// Light: A, D50, D65, FL2, FL8, FL11, or a CSV file with the columns nm and power
    #[arg(long, value_name = "NAME|CSV", default_value = "D65")]
    pub illuminant: String,
    /// CIE observer
    #[arg(long, value_name = "YEAR", default_value = "1931")]
    pub observer: ObserverYear,
    /// Wavelength rule: fitted to the paints, Gaussian, or all 101
    #[arg(long, value_name = "RULE", default_value = "fitted")]
    pub rule: RuleName,
    /// Number of wavelengths, 4 to 16
    #[arg(long, value_name = "N", default_value = "16", value_parser = samples())]
    pub samples: u8,
    /// Show the cast of the light: no white balance (CAT16)
    #[arg(long)]
    pub no_adapt: bool,
}

fn samples() -> clap::builder::RangedI64ValueParser<u8> {
    let range = Wavelengths::RANGE;
    clap::value_parser!(u8).range(*range.start() as i64..=*range.end() as i64)
}

/// A standard observer by its year.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObserverYear {
    /// 2°
    #[value(name = "1931")]
    Cie1931,
    /// 10°
    #[value(name = "1964")]
    Cie1964,
}

/// A rule by its name.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum RuleName {
    /// Fitted to the paints and the light
    Fitted,
    /// Gaussian quadrature, weighted by the light and the eye
    Gauss,
    /// All 101 samples
    Reference,
}

impl ViewingOptions {
    fn illuminant(&self) -> Result<Illuminant, UserError> {
        illuminant(&self.illuminant).map_err(|fault| match fault.place {
            None => fault.at(format!("--illuminant {}", self.illuminant)),
            Some(_) => fault,
        })
    }

    /// The rule in words.
    #[must_use]
    pub fn rule_in_words(&self) -> String {
        match self.rule {
            RuleName::Reference => "101 samples".into(),
            RuleName::Fitted => format!("fitted, {} samples", self.samples),
            RuleName::Gauss => format!("Gauss, {} samples", self.samples),
        }
    }

    /// Viewing conditions of these options.
    ///
    /// # Errors
    /// A [`UserError`] for an unknown light, with the nearest name, or a bad file, with its line.
    pub fn viewing(&self, library: &PaintLibrary) -> Result<Viewing, UserError> {
        Ok(Viewing::new(&self.settings()?, library.paints()))
    }

    /// The same with all 101 samples.
    ///
    /// # Errors
    /// As [`viewing`](Self::viewing).
    pub fn reference(&self) -> Result<Viewing, UserError> {
        let settings = StudioSettings {
            rule: RuleKind::Reference,
            ..self.settings()?
        };
        Ok(Viewing::new(&settings, &[]))
    }

    fn settings(&self) -> Result<StudioSettings, UserError> {
        Ok(StudioSettings {
            light: self.illuminant()?,
            observer: match self.observer {
                ObserverYear::Cie1931 => Observer::Cie1931,
                ObserverYear::Cie1964 => Observer::Cie1964,
            },
            rule: match self.rule {
                RuleName::Fitted => RuleKind::Fitted,
                RuleName::Gauss => RuleKind::Gauss,
                RuleName::Reference => RuleKind::Reference,
            },
            samples: usize::from(self.samples),
            adapted: !self.no_adapt,
        })
    }
}

/// A light by its name, or of a table.
///
/// # Errors
/// A [`UserError`] for an unknown name, with the nearest, or a bad file, with its line.
pub fn illuminant(name: &str) -> Result<Illuminant, UserError> {
    if let Some(light) = Illuminant::named(name) {
        return Ok(light);
    }
    let path = Path::new(name);
    if !is_path(name) && !path.exists() {
        return illuminant_named(name).map_err(refused);
    }
    let text = read_table(path, MOST_BYTES)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    Illuminant::parse(&stem, &text).map_err(|error| {
        UserError::usage(error.fault.to_string())
            .at(format!("{name}:{}", error.line))
            .help("a row a wavelength: nm,power, rising")
    })
}
