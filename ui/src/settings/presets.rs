//! Presets: brushes with their paint, by name.

use maulstick_brush::BrushFile;
use maulstick_painting::edits::common;
use maulstick_rig::UserError;
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushHandling, MARKER_FLOW, Tuning};
use maulstick_ui_kit::units::Units;
use serde::{Deserialize, Serialize};

use crate::settings::brush_library::{called, of_library};
use crate::settings::brush_load::BrushLoad;

/// Largest number of letters in the name of a preset or of a set of paints.
pub(crate) const NAME_MAX: usize = 40;

/// A brush with its paint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preset {
    /// Name given by the painter.
    pub name: String,
    /// Kind of the brush.
    pub kind: String,
    /// Its width, mm.
    pub width_mm: f64,
    /// Its file, TOML, unless it is one of the library's.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub file: String,
    /// Factor on its stiffness.
    pub stiffness: f64,
    /// Wetness, 0 to 1.
    pub wetness: f64,
    /// Name of its mode, as in [`BrushMode::NAMES`].
    pub mode: String,
    /// Flow of the marker, m/m.
    pub flow: f64,
    /// It adds no paint where as much is wet, m; 0 for no such bound.
    pub most_m: f64,
    /// Its load. If only thinner is named, the paint that was loaded last is thinned; else the brush keeps its paint.
    pub loading: BrushLoad,
    /// True for a brush that is cleaned first.
    pub clean: bool,
    /// Pressure of the mouse, 0 to 1; as it is if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pressure: Option<f64>,
}

impl Default for Preset {
    fn default() -> Self {
        Self {
            name: String::new(),
            kind: "round".to_owned(),
            width_mm: 10.0,
            file: String::new(),
            stiffness: 1.0,
            wetness: 0.0,
            mode: "normal".to_owned(),
            flow: MARKER_FLOW,
            most_m: 0.0,
            loading: BrushLoad::default(),
            clean: false,
            pressure: None,
        }
    }
}

/// Pressure and tuning of a brush before a preset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BeforePreset {
    /// The brush of the rig.
    pub brush: String,
    /// Pressure of the mouse, 0 to 1.
    pub pressure: f64,
    /// Factor on the stiffness.
    pub stiffness: f64,
    /// Wetness, 0 to 1.
    pub wetness: f64,
}

/// The presets of a new painter: four classic ways to lay oil over oil.
#[must_use]
pub(crate) fn classic() -> Vec<Preset> {
    let of = |name: &str, kind: &str, width_mm: f64, pressure: f64| Preset {
        name: name.to_owned(),
        kind: kind.to_owned(),
        width_mm,
        pressure: Some(pressure),
        ..Preset::default()
    };
    vec![
        // Thin and transparent over what is dry.
        Preset {
            most_m: 12e-6,
            loading: BrushLoad {
                thinner: 0.88,
                ..BrushLoad::default()
            },
            ..of(tr_noop!("Glaze"), "flat", 20.0, 0.3)
        },
        // Little paint, dragged lightly over the ridges.
        Preset {
            most_m: 60e-6,
            ..of(tr_noop!("Scumble"), "bright", 20.0, 0.15)
        },
        // Nothing but what lies there, softened.
        Preset {
            clean: true,
            ..of(tr_noop!("Blend"), "badger", 25.0, 0.15)
        },
        Preset {
            stiffness: 2.0,
            most_m: 120e-6,
            ..of(tr_noop!("Dry brush"), "flat", 20.0, 0.08)
        },
    ]
}

impl Preset {
    /// Short description.
    #[must_use]
    pub fn words(&self, units: Units) -> String {
        let kind = called(&self.kind);
        let width = units.width(self.width_mm);
        if self.loading.paint.is_empty() {
            return format!("{kind}, {width}");
        }
        let mut paint = self.loading.paint.clone();
        if let Some(other) = &self.loading.beside {
            paint = tr!("{paint} beside {other}", paint, other);
        }
        if self.loading.thinner > 0.0 {
            let percent = (100.0 * self.loading.thinner).round();
            paint = tr!("{paint}, {percent} % thinner", paint, percent);
        }
        format!("{kind}, {width}\n{paint}")
    }

    /// The brush.
    ///
    /// # Errors
    /// A [`UserError`] if the file is invalid, as after an edit by hand.
    pub fn brush(&self) -> Result<BrushFile, UserError> {
        let wrong = |what: String| {
            let (whose, help) = match self.name.as_str() {
                "" => (
                    tr!("the brush of the last session").to_owned(),
                    tr!("choose one from the rack"),
                ),
                name => (tr!("the preset '{name}'", name), tr!("save it anew")),
            };
            UserError::failure(format!("{whose}: {what}")).help(help)
        };
        if !self.file.is_empty() {
            return BrushFile::parse(&self.file).map_err(|error| wrong(error.to_string()));
        }
        let file = of_library(&self.kind)
            .ok_or_else(|| wrong(tr!("there is no brush called '{kind}'", kind = self.kind)))?;
        file.scaled_to(self.width_mm)
            .map_err(|error| wrong(error.to_string()))
    }

    /// Stiffness and wetness that it gives a brush of the rig.
    #[must_use]
    pub(crate) fn tuning(&self, brush: &str) -> Tuning {
        Tuning {
            brush: brush.to_owned(),
            stiffness: self.stiffness,
            wetness: self.wetness,
        }
    }

    /// Use that it makes of a brush of the rig.
    ///
    /// # Errors
    /// A [`UserError`] where there is no such mode.
    pub(crate) fn handling(&self, brush: &str) -> Result<BrushHandling, UserError> {
        Ok(BrushHandling {
            mode: self.mode.parse()?,
            flow: self.flow,
            most_m: self.most_m,
            ..BrushHandling::normal(brush)
        })
    }

    /// The commands that use a brush of the rig so.
    ///
    /// # Errors
    /// A [`UserError`] where a number is out of range, or there is no such mode.
    pub(crate) fn edits(&self, brush: &str) -> Result<[Command; 2], UserError> {
        let tune = common::tune(&self.tuning(brush))?.into();
        Ok([tune, common::handle(&self.handling(brush)?)?.into()])
    }
}

/// Checks a name against the existing ones.
///
/// # Errors
/// [`NameFault`].
pub(crate) fn check_name<'a>(
    name: &str,
    mut others: impl Iterator<Item = &'a str>,
) -> Result<(), NameFault> {
    let length = name.chars().count();
    if length == 0 {
        Err(NameFault::Empty)
    } else if length > NAME_MAX || name.contains(char::is_control) {
        Err(NameFault::Unfit)
    } else if others.any(|other| other == name) {
        Err(NameFault::Taken(name.to_owned()))
    } else {
        Ok(())
    }
}

/// A name that a preset or a set of paints cannot have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum NameFault {
    /// None.
    Empty,
    /// Too long, or with control characters.
    Unfit,
    /// That of another.
    Taken(String),
}

impl NameFault {
    /// It and advice, in the language of the window.
    pub(crate) fn words(&self) -> String {
        match self {
            Self::Empty => tr!("Give it a name first.").to_owned(),
            Self::Unfit => tr!("Choose a name of at most {most} letters.", most = NAME_MAX),
            Self::Taken(name) => tr!("There is a '{name}' already; choose another name.", name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_classic_ones_are_brushes_that_can_be_taken_up() {
        let classic = classic();
        assert_eq!(classic.len(), 4);
        for preset in &classic {
            let file = preset.brush().expect(&preset.name);
            assert_eq!(file.head.width_mm, preset.width_mm, "{}", preset.name);
            preset
                .mode
                .parse::<maulstick_types::scene::BrushMode>()
                .expect("a mode");
            let others = classic.iter().filter(|other| *other != preset);
            let names = others.map(|other| other.name.as_str());
            assert_eq!(check_name(&preset.name, names), Ok(()));
        }
    }
}
