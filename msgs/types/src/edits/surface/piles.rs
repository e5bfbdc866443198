//! Lets paint on a surface deplete or last.

use serde::de::{Deserialize, Deserializer};

use crate::edits::{Form, StepForm};
use crate::nearest::choice;
use crate::scene::PALETTE;
use crate::values::ValueError;
use crate::wire::define::wire_struct;

wire_struct! {
    /// Let paint on the palette deplete or last
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Piles {
        /// Paint on the palette when brushes take it up: deplete, or last
        #[serde(rename = "piles", deserialize_with = "lasts")]
        #[cfg_attr(feature = "cli", arg(value_name = "PILES", action = clap::ArgAction::Set, value_parser = last_of))]
        pub last: bool,
        /// The surface.
        #[serde(default = "palette")]
        #[cfg_attr(feature = "cli", arg(skip = PALETTE))]
        pub surface: u32,
    }
}

/// Words for what becomes of paint that brushes take up.
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
    match from.is_human_readable() {
        true => last_of(&String::deserialize(from)?).map_err(serde::de::Error::custom),
        false => bool::deserialize(from),
    }
}

fn palette() -> u32 {
    PALETTE
}

impl Form for Piles {
    const STEPS: &'static [StepForm] = &[StepForm::new("piles", &[], "{ piles = \"last\" }")];
    const ARGUMENTS: Option<&'static str> = Some("palette|piles|last");
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
