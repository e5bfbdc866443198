//! Dries wet paint, at once or while time goes by.

use maulstick_canvas::EditError;
use maulstick_types::paint::StepName;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{LayerName, Share, Ticks, ValueError};
use maulstick_types::{EditFields, Region};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::painting::Painting;
use crate::painting::layers::next_layer;

/// Dry the wet paint into a new layer
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Dry {
    /// Share of the wet film to dry, from below, above 0 to 1
    #[serde(alias = "dry")]
    #[cfg_attr(
        feature = "cli",
        arg(long, default_value = "1", allow_negative_numbers = true)
    )]
    pub share: Share,
    /// Name of the new layer [default: its number]
    #[serde(default)]
    #[cfg_attr(feature = "cli", arg(long, value_name = "NAME"))]
    pub layer: Option<LayerName>,
    /// Only this rectangle, mm from the lower left corner of the surface
    #[serde(default, deserialize_with = "read::optional")]
    #[cfg_attr(
        feature = "cli",
        arg(long, value_name = "X,Y,WxH", allow_hyphen_values = true)
    )]
    pub region: Option<Region>,
    /// Dry all wet paint evenly over this time, such as 90s, 20min, 2h; you can paint meanwhile
    #[serde(default)]
    #[cfg_attr(
        feature = "cli",
        arg(long, value_name = "TIME", conflicts_with = "share")
    )]
    pub over: Option<Ticks>,
    /// Use the palette instead of the canvas
    #[serde(default = "read::canvas")]
    #[cfg_attr(feature = "cli", arg(long = "palette", action = clap::ArgAction::SetTrue, value_parser = read::surface()))]
    pub surface: u32,
}

impl Dry {
    /// Dries all wet paint of a surface at once.
    #[must_use]
    pub fn whole(surface: u32) -> Self {
        Self {
            share: Share::WHOLE,
            layer: None,
            region: None,
            over: None,
            surface,
        }
    }
}

impl EditFields for Dry {
    const NAME: &'static str = "dry";
}

impl Form for Dry {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "dry",
        &["layer", "region", "over"],
        "{ dry = 0.5, layer = \"sky\", region = \"10,20,60x40\" }, { dry = 1.0, over = \"90s\" }",
    )];
    const ARGUMENTS: Option<&'static str> =
        Some("layer|dry|--share|0.5|--layer|sky|--region|10,20,60x40");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> = Some(cli::COMMAND);

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            share: Share::new(0.5)?,
            layer: Some(LayerName::new("sky")?),
            region: Some("10,20,60x40".parse()?),
            over: None,
            surface: CANVAS,
        })
    }
}

impl PaintingEdit for Dry {
    /// Dries the lower share of the wet paint of a surface, or of a part, into a new layer, at once or over a time.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        self.check_idle()?;
        if let Some(over) = self.over {
            return painting.dry_over(self, over);
        }
        painting.close_windows();
        let (on, part) = painting.surfaces.part(self.surface, self.region.as_ref())?;
        let number = next_layer(&painting.scene);
        let dried = painting.surfaces[on].dried(&part, number, self.share.get());
        if dried.is_empty() {
            return Err(EditError::NothingWet(self.region.clone()));
        }
        painting.clock.stop(Some(self.surface));
        painting.begin_step(StepName::Dry, None);
        painting.put_changed(on, dried);
        let name = self.layer.as_deref().unwrap_or_default();
        let layer = painting.add_layer(number, name);
        painting.end_own_step();
        Ok(Applied::Dried(layer))
    }

    fn log_words(&self) -> String {
        let share = match self.share {
            Share::WHOLE => String::new(),
            share => format!("{} of ", words::percent(share.get().into())),
        };
        let over = self.over.map(|over| format!(" over {}", words::time(over)));
        let layer = self.layer.as_ref();
        let layer = layer.map_or_else(String::new, |name| format!(" to the layer '{name}'"));
        let place = words::place(self.surface, self.region.as_ref());
        format!("dry {share}the {place}{}{layer}", over.unwrap_or_default())
    }

    fn reply(&self) -> Option<&'static str> {
        Some(if self.over.is_some() {
            "dries "
        } else {
            "dried: "
        })
    }

    fn check_idle(&self) -> Result<(), ValueError> {
        // Over a time all that is wet dries.
        if self.over.is_some() && self.share != Share::WHOLE {
            Err(ValueError::Idle {
                option: "a share below 1",
                with: "a time over which all wet paint dries".to_owned(),
            })
        } else {
            Ok(())
        }
    }
}

#[cfg(feature = "cli")]
mod cli {
    use super::Dry;
    use crate::edits::{CommandForm, StopDrying};

    /// Dry the wet paint into a new layer, at once or over time; or stop a drying.
    #[derive(clap::Args)]
    struct DryOrStop {
        #[command(flatten)]
        dry: Dry,
        /// Stop a running drying; what is still wet stays wet
        #[arg(long, conflicts_with_all = ["share", "layer", "region", "over"])]
        stop: bool,
    }

    pub(super) const COMMAND: CommandForm = CommandForm {
        name: "dry",
        group: "layer",
        augment: <DryOrStop as clap::Args>::augment_args,
        read: |matches| {
            let DryOrStop { dry, stop } = clap::FromArgMatches::from_arg_matches(matches)?;
            let surface = dry.surface;
            Ok(if stop {
                StopDrying { surface }.into()
            } else {
                dry.into()
            })
        },
    };
}
