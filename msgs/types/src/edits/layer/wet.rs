//! Makes dry layers wet again.

use std::fmt;
use std::num::NonZeroU32;

use serde::de::{Deserialize, Deserializer, Error, Visitor};

use crate::Region;
use crate::edits::{Form, StepForm, read};
use crate::scene::CANVAS;
use crate::values::ValueError;
use crate::wire::define::wire_struct;

wire_struct! {
    /// Make dry layers wet again
    pub struct Wet {
        /// Number of the newest dry layers to make wet; all if absent.
        #[serde(rename = "wet", deserialize_with = "count_or_all")]
        pub layers: Option<u32>,
        /// The part; all of it if absent.
        #[serde(default, deserialize_with = "read::optional")]
        pub region: Option<Region>,
        /// The surface.
        #[serde(default = "read::canvas")]
        pub surface: u32,
    }
}

/// Reads a number above 0, or "all".
struct CountOrAll;

impl Visitor<'_> for CountOrAll {
    type Value = Option<u32>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("how many of the newest layers, or \"all\"")
    }

    fn visit_i64<E: Error>(self, count: i64) -> Result<Option<u32>, E> {
        let layers = u32::try_from(count).ok().and_then(NonZeroU32::new);
        let unexpected = serde::de::Unexpected::Signed(count);
        layers
            .map(|count| Some(count.get()))
            .ok_or_else(|| E::invalid_value(unexpected, &self))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Option<u32>, E> {
        match text {
            "all" => Ok(None),
            _ => Err(E::invalid_value(serde::de::Unexpected::Str(text), &self)),
        }
    }
}

fn count_or_all<'de, D: Deserializer<'de>>(from: D) -> Result<Option<u32>, D::Error> {
    if from.is_human_readable() {
        return from.deserialize_any(CountOrAll);
    }
    match Option::<u32>::deserialize(from)? {
        Some(0) => Err(D::Error::custom("no layer is to be made wet")),
        layers => Ok(layers),
    }
}

impl Form for Wet {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "wet",
        &["region"],
        "{ wet = 1 }, { wet = \"all\", region = \"10,20,60x40\" }",
    )];
    const ARGUMENTS: Option<&'static str> = Some("layer|wet");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> = Some(crate::edits::CommandForm::of::<
        cli::WetOptions,
    >("wet", "layer"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            layers: Some(1),
            region: None,
            surface: CANVAS,
        })
    }
}

#[cfg(feature = "cli")]
mod cli {
    use super::{Region, Wet};
    use crate::edits::{Edit, read};

    /// Make dry layers wet again
    #[derive(clap::Args)]
    pub(super) struct WetOptions {
        /// Number of the newest dry layers to make wet
        #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
        layers: u32,
        /// Make all dry layers wet
        #[arg(long, conflicts_with = "layers")]
        all: bool,
        /// Only this rectangle, mm from the lower left corner of the surface
        #[arg(long, value_name = "X,Y,WxH", allow_hyphen_values = true)]
        region: Option<Region>,
        /// Use the palette instead of the canvas
        #[arg(long = "palette", action = clap::ArgAction::SetTrue, value_parser = read::surface())]
        surface: u32,
    }

    impl From<WetOptions> for Edit {
        fn from(options: WetOptions) -> Self {
            Wet {
                layers: (!options.all).then_some(options.layers),
                region: options.region,
                surface: options.surface,
            }
            .into()
        }
    }
}
