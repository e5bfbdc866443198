//! Loads a brush with the mixture at a place.

use maulstick_optics::thinned;
use maulstick_types::EditFields;
use maulstick_types::scene::CANVAS;
#[cfg(feature = "cli")]
use maulstick_types::values::Quantity as _;
use maulstick_types::values::{BrushName, Distance, ThinnerShare, ValueError};
use serde::{Deserialize as _, Deserializer};

use crate::edits::{Applied, Form, Load, PaintingEdit, StepForm, read, words};
use crate::error::{EditError, SurfaceError};
use crate::painting::Painting;
use crate::painting::brushes::loads::{mixture_of, well_at};

/// Load a brush with the mixture at a place
///
/// The old load goes to the cleaner. Wet paint gives the mixture of all of it there, dry paint that of the newest
/// layer, and an untouched well its own.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct LoadFrom {
    /// Distance of the place from the left edge, mm
    #[cfg_attr(
        feature = "cli",
        arg(value_name = "X_MM", allow_negative_numbers = true)
    )]
    pub x: Distance,
    /// Distance of the place from the lower edge, mm
    #[cfg_attr(
        feature = "cli",
        arg(value_name = "Y_MM", allow_negative_numbers = true)
    )]
    pub y: Distance,
    /// Surface: 0 for the canvas, 1 for the palette
    #[cfg_attr(feature = "cli", arg(long, value_name = "NUMBER", default_value_t = CANVAS))]
    pub surface: u32,
    /// Share of thinner that is added
    #[cfg_attr(feature = "cli", arg(long, help = ThinnerShare::option_help(), value_name = "SHARE", default_value_t = ThinnerShare::NONE))]
    pub thinner: ThinnerShare,
    /// Brush of the rig
    #[cfg_attr(feature = "cli", arg(long, default_value = "main"))]
    pub brush: BrushName,
}

/// A step of a script.
#[derive(serde::Deserialize)]
struct LoadFromStep {
    load_from: [Distance; 2],
    #[serde(default = "read::canvas")]
    surface: u32,
    #[serde(default)]
    thinner: ThinnerShare,
}

impl EditFields for LoadFrom {
    const NAME: &'static str = "load_from";
}

impl Form for LoadFrom {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "load_from",
        &["surface", "thinner"],
        "{ load_from = [120, 45], thinner = 0.5 }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> =
        Some(&["brush", "load-from", "120", "45", "--thinner", "0.5"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("load-from", "brush"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            x: Distance::in_unit(120.0)?,
            y: Distance::in_unit(45.0)?,
            surface: CANVAS,
            thinner: ThinnerShare::in_unit(0.5)?,
            brush: BrushName::main(),
        })
    }

    fn read_step<'de, D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let LoadFromStep {
            load_from,
            surface,
            thinner,
        } = LoadFromStep::deserialize(from)?;
        let [x, y] = load_from;
        Ok(Self {
            x,
            y,
            surface,
            thinner,
            brush: BrushName::main(),
        })
    }
}

impl PaintingEdit for LoadFrom {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.bench.brushes.at(&self.brush)?;
        let on = painting.bench.desk.surfaces.at(self.surface)?;
        painting.commit();
        let desk = &painting.bench.desk;
        let at_m = [self.x, self.y].map(Distance::get);
        let counts = desk.surfaces[on].counts_at(at_m);
        let mixture = mixture_of(&counts, &desk.scene)
            .or_else(|| well_at(&desk.scene.surfaces[on], at_m))
            .ok_or(SurfaceError::NoPaintThere { at_m })?;
        let mixture = thinned(&mixture, self.thinner);
        Load {
            mixture: mixture.clone(),
            beside: None,
            brush: self.brush.clone(),
        }
        .apply(painting)?;
        Ok(Applied::Loaded(mixture))
    }

    fn log_words(&self) -> String {
        let [x, y] = [self.x, self.y].map(|distance| words::mm(distance.get()));
        let thinner = match self.thinner.get() {
            0.0 => String::new(),
            share => format!(", with {} of thinner", words::percent(share)),
        };
        let from = words::surface(self.surface);
        format!(
            "load {} from the {from} at {x}, {y} mm{thinner}",
            self.brush
        )
    }

    fn reply(&self) -> Option<&'static str> {
        Some("loaded: ")
    }

    fn brush_mut(&mut self) -> Option<&mut BrushName> {
        Some(&mut self.brush)
    }
}
