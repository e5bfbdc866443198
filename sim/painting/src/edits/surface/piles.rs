//! Makes paint on a surface deplete or last.

use maulstick_types::EditFields;
use maulstick_types::nearest::choice;
use maulstick_types::scene::PALETTE;
use maulstick_types::values::ValueError;
use serde::de::{Deserialize, Deserializer};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, words};
use crate::error::EditError;
use crate::painting::Painting;

/// Let paint on the palette deplete or last
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Piles {
    /// Paint on the palette when brushes take it up: deplete, or last
    #[serde(alias = "piles", deserialize_with = "lasts")]
    #[cfg_attr(feature = "cli", arg(value_name = "PILES", action = clap::ArgAction::Set, value_parser = last_of))]
    pub last: bool,
    /// The surface.
    #[serde(default = "palette")]
    #[cfg_attr(feature = "cli", arg(skip = PALETTE))]
    pub surface: u32,
}

/// Words for the two behaviours of paint that brushes take up.
const WORDS: [&str; 2] = ["deplete", "last"];

fn last_of(word: &str) -> Result<bool, ValueError> {
    match word {
        "last" => Ok(true),
        "deplete" => Ok(false),
        _ => Err(ValueError::Unknown {
            what: "way of piles",
            name: word.chars().take(40).collect(),
            choice: choice(word, WORDS),
        }),
    }
}

fn lasts<'de, D: Deserializer<'de>>(from: D) -> Result<bool, D::Error> {
    if from.is_human_readable() {
        last_of(&String::deserialize(from)?).map_err(serde::de::Error::custom)
    } else {
        bool::deserialize(from)
    }
}

fn palette() -> u32 {
    PALETTE
}

impl EditFields for Piles {
    const NAME: &'static str = "piles";
}

impl Form for Piles {
    const STEPS: &'static [StepForm] = &[StepForm::new("piles", &[], "{ piles = \"last\" }")];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&["palette", "piles", "last"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("piles", "palette"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            last: true,
            surface: PALETTE,
        })
    }
}

impl PaintingEdit for Piles {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let desk = &mut painting.bench.desk;
        desk.change_surface(self.surface, |own| own.piles_last = self.last)?;
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        let does = if self.last { "last" } else { "deplete" };
        format!("let piles on the {} {does}", words::surface(self.surface))
    }
}
