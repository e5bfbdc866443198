//! Scrapes wet paint off a surface.

use maulstick_types::paint::StepName;
use maulstick_types::scene::PALETTE;
use maulstick_types::values::ValueError;
use maulstick_types::{EditFields, Region};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::{EditError, LayerError};
use crate::painting::Painting;

/// Scrape the wet paint off the palette
///
/// It goes to the cleaner. Wells keep theirs.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Scrape {
    /// Only this rectangle, mm from the lower left corner of the surface
    #[serde(default, deserialize_with = "read::optional")]
    #[cfg_attr(
        feature = "cli",
        arg(long, value_name = "X,Y,WxH", allow_hyphen_values = true)
    )]
    pub region: Option<Region>,
    /// Scrape the canvas instead of the palette
    #[serde(default = "palette")]
    #[cfg_attr(feature = "cli", arg(long = "canvas", action = clap::ArgAction::SetTrue, value_parser = cli::surface()))]
    pub surface: u32,
}

fn palette() -> u32 {
    PALETTE
}

impl EditFields for Scrape {
    const NAME: &'static str = "scrape";
}

impl Form for Scrape {
    const STEPS: &'static [StepForm] = &[StepForm::switch(
        "scrape",
        &["region", "surface"],
        "{ scrape = true, region = \"10,20,60x40\" }, { scrape = true, surface = 0 }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> =
        Some(&["palette", "scrape", "--region", "10,20,60x40"]);
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

impl PaintingEdit for Scrape {
    /// Moves the wet paint of a part to the cleaner, except in wells.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let Painting { bench, clock } = painting;
        bench.close_windows();
        let surfaces = &bench.desk.surfaces;
        let (on, part) = surfaces.part(self.surface, self.region.as_ref())?;
        let surface = &surfaces[on];
        let scraped = surface.scraped(|id| surface.staying(&part, id));
        if scraped.is_empty() {
            return Err(LayerError::NothingWet(self.region.clone()).into());
        }
        clock.stop(Some(self.surface));
        bench.begin_step(StepName::Scrape, None);
        bench.put_scraped(on, scraped);
        bench.end_own_step();
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        let place = words::place(self.surface, self.region.as_ref());
        format!("scrape the {place}")
    }
}

#[cfg(feature = "cli")]
mod cli {
    use clap::builder::{BoolishValueParser, TypedValueParser};

    use maulstick_types::scene::{CANVAS, PALETTE};

    pub(super) fn surface() -> impl TypedValueParser<Value = u32> {
        BoolishValueParser::new().map(|canvas| if canvas { CANVAS } else { PALETTE })
    }
}
