//! Sets the mode of a brush.

use maulstick_types::EditFields;
use maulstick_types::scene::{BrushHandling, BrushMode, MARKER_FLOW};
#[cfg(feature = "cli")]
use maulstick_types::values::Quantity as _;
use maulstick_types::values::{BrushName, FilmLimit, MarkerFlow, ValueError};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::EditError;
use crate::painting::Painting;

/// Set the mode of a brush: sponge, marker, sampler, vacuum, …
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Handle {
    /// Mode: normal, no-push, sponge, sponge-no-push, marker, sampler or vacuum
    #[serde(deserialize_with = "read::text")]
    pub mode: BrushMode,
    /// Flow of the marker
    #[serde(default)]
    #[cfg_attr(
        feature = "cli",
        arg(long, value_name = "UM_PER_MM", help = MarkerFlow::option_help(), allow_negative_numbers = true)
    )]
    pub flow: Option<MarkerFlow>,
    /// Limit of the wet film
    #[serde(default, alias = "most_um")]
    #[cfg_attr(
        feature = "cli",
        arg(long = "most-um", value_name = "UM", help = FilmLimit::option_help(), allow_negative_numbers = true)
    )]
    pub most: Option<FilmLimit>,
    /// Brush of the rig
    #[serde(default)]
    #[cfg_attr(feature = "cli", arg(long, default_value = "main"))]
    pub brush: BrushName,
}

impl From<Handle> for BrushHandling {
    fn from(edit: Handle) -> Self {
        Self {
            brush: edit.brush.into(),
            mode: edit.mode,
            flow: edit.flow.map_or(MARKER_FLOW, MarkerFlow::get),
            most_m: edit.most.map_or(0.0, FilmLimit::get),
        }
    }
}

impl TryFrom<&BrushHandling> for Handle {
    type Error = ValueError;

    fn try_from(handling: &BrushHandling) -> Result<Self, ValueError> {
        let most = (handling.most_m != 0.0).then(|| FilmLimit::new(handling.most_m));
        Ok(Self {
            mode: handling.mode.clone(),
            flow: Some(MarkerFlow::new(handling.flow)?),
            most: most.transpose()?,
            brush: BrushName::new(&*handling.brush)?,
        })
    }
}

impl EditFields for Handle {
    const NAME: &'static str = "handle";
}

impl Form for Handle {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "mode",
        &["flow", "most_um"],
        "{ mode = \"marker\", flow = 4, most_um = 60 }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> =
        Some(&["brush", "mode", "marker", "--flow", "4", "--most-um", "60"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("mode", "brush"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            mode: BrushMode::Marker,
            flow: Some(MarkerFlow::in_unit(4.0)?),
            most: Some(FilmLimit::in_unit(60.0)?),
            brush: BrushName::main(),
        })
    }
}

impl PaintingEdit for Handle {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.bench.brushes.at(&self.brush)?;
        let handling = BrushHandling::from(self.clone());
        let scene = &mut painting.bench.desk.scene;
        let handlings = &mut scene.handlings;
        handlings.retain(|other| other.brush != handling.brush);
        if handling != BrushHandling::normal(&handling.brush) {
            handlings.push(handling);
        }
        scene.version += 1;
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        let flow = self.flow.map(|flow| words::number(flow.get() * 1e3));
        let flow = flow.map_or_else(String::new, |flow| format!(", {flow} µm/mm"));
        let most = self.most.map(|film| words::um(film.get()));
        let most = most.map_or_else(String::new, |most| format!(", at most {most} µm"));
        format!("use {} as {}{flow}{most}", self.brush, self.mode.name())
    }

    fn brush_mut(&mut self) -> Option<&mut BrushName> {
        Some(&mut self.brush)
    }

    fn check_idle(&self) -> Result<(), ValueError> {
        let with = || format!("the mode {}", self.mode.name());
        if self.flow.is_some() && self.mode != BrushMode::Marker {
            let option = "a flow";
            return Err(ValueError::Idle {
                option,
                with: with(),
            });
        }
        // These add no paint to the surface.
        if self.most.is_some() && matches!(self.mode, BrushMode::Sampler | BrushMode::Vacuum) {
            let option = "most_um";
            return Err(ValueError::Idle {
                option,
                with: with(),
            });
        }
        Ok(())
    }
}
