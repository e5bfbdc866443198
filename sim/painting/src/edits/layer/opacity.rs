//! Makes a dry layer more or less opaque.

use std::fmt;
use std::str::FromStr;

use maulstick_types::EditFields;
use maulstick_types::paint::StepName;
#[cfg(feature = "cli")]
use maulstick_types::values::Quantity as _;
use maulstick_types::values::{LayerName, OpacityFactor, ValueError};

use maulstick_types::scene::Scene;

use crate::edits::{Applied, Form, PaintingEdit, StepForm, words};
use crate::error::{EditError, LayerError};
use crate::painting::Painting;

/// A dry layer.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum LayerRef {
    /// The layer of this number.
    Number {
        /// Its number.
        number: u32,
    },
    /// The newest layer of this name, or else the one whose number has these digits.
    Named {
        /// Its name.
        name: LayerName,
    },
}

impl FromStr for LayerRef {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Self, ValueError> {
        LayerName::new(text).map(|name| Self::Named { name })
    }
}

impl fmt::Display for LayerRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number { number } => write!(f, "{number}"),
            Self::Named { name } if name.bytes().all(|digit| digit.is_ascii_digit()) => {
                write!(f, "{name}")
            }
            Self::Named { name } => write!(f, "called '{name}'"),
        }
    }
}

impl LayerRef {
    /// Its place in a scene.
    pub(crate) fn place_in(&self, scene: &Scene) -> Result<usize, LayerError> {
        let layers = &scene.layers;
        let numbered = |number: u32| layers.iter().position(|layer| layer.number == number);
        let found = match self {
            Self::Number { number } => numbered(*number),
            Self::Named { name } => layers
                .iter()
                .rposition(|layer| layer.name == name.as_str())
                .or_else(|| numbered(name.parse().ok()?)),
        };
        found.ok_or_else(|| LayerError::Unknown {
            which: self.to_string(),
            known: layers
                .iter()
                .map(|layer| (layer.number, layer.name.clone()))
                .collect(),
        })
    }
}

/// Make a dry layer more or less opaque
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Opacity {
    /// Name or number of the layer
    #[serde(deserialize_with = "named")]
    pub layer: LayerRef,
    /// Factor on its optical thickness; its height does not change
    #[cfg_attr(feature = "cli", arg(help = OpacityFactor::option_help(), allow_negative_numbers = true))]
    pub opacity: OpacityFactor,
}

fn named<'de, D: serde::Deserializer<'de>>(from: D) -> Result<LayerRef, D::Error> {
    if from.is_human_readable() {
        <LayerName as serde::Deserialize>::deserialize(from).map(|name| LayerRef::Named { name })
    } else {
        serde::Deserialize::deserialize(from)
    }
}

impl EditFields for Opacity {
    const NAME: &'static str = "opacity";
}

impl Form for Opacity {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "opacity",
        &["layer"],
        "{ opacity = 0.7, layer = \"sky\" }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&["layer", "opacity", "sky", "0.7"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("opacity", "layer"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            layer: "sky".parse()?,
            opacity: OpacityFactor::new(0.7)?,
        })
    }
}

impl PaintingEdit for Opacity {
    /// Makes a dry layer more or less opaque: a factor on its optical thickness, never on its height.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let bench = &mut painting.bench;
        let place = self.layer.place_in(&bench.desk.scene)?;
        bench.begin_step(StepName::LayerOpacity, None);
        bench.desk.scene.layers[place].opacity = self.opacity.get();
        bench.desk.layers_changed();
        bench.end_own_step();
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        let opacity = words::percent(self.opacity.get().into());
        format!("make the layer {} {opacity} opaque", self.layer)
    }
}
