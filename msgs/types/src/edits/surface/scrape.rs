//! Scrapes wet paint off a surface.

use crate::Region;
use crate::edits::{Form, StepForm, read};
use crate::scene::PALETTE;
use crate::values::ValueError;
use crate::wire::define::wire_struct;

wire_struct! {
    /// Scrape the wet paint off the palette
    ///
    /// It goes to the cleaner. Wells keep theirs.
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Scrape {
        /// Only this rectangle, mm from the lower left corner of the surface
        #[serde(default, deserialize_with = "read::optional")]
        #[cfg_attr(feature = "cli", arg(long, value_name = "X,Y,WxH", allow_hyphen_values = true))]
        pub region: Option<Region>,
        /// Scrape the canvas instead of the palette
        #[serde(default = "palette")]
        #[cfg_attr(feature = "cli", arg(long = "canvas", action = clap::ArgAction::SetTrue, value_parser = cli::surface()))]
        pub surface: u32,
    }
}

fn palette() -> u32 {
    PALETTE
}

impl Form for Scrape {
    const STEPS: &'static [StepForm] = &[StepForm::switch(
        "scrape",
        &["region", "surface"],
        "{ scrape = true, region = \"10,20,60x40\" }, { scrape = true, surface = 0 }",
    )];
    const ARGUMENTS: Option<&'static str> = Some("palette|scrape|--region|10,20,60x40");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("scrape", "palette"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            region: Some("10,20,60x40".parse()?),
            surface: PALETTE,
        })
    }
}

#[cfg(feature = "cli")]
mod cli {
    use clap::builder::{BoolishValueParser, TypedValueParser};

    use crate::scene::{CANVAS, PALETTE};

    pub(super) fn surface() -> impl TypedValueParser<Value = u32> {
        BoolishValueParser::new().map(|canvas| if canvas { CANVAS } else { PALETTE })
    }
}
