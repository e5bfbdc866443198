//! Dries wet paint, at once or while time goes by.

use crate::Region;
use crate::edits::{Form, StepForm, read};
use crate::scene::CANVAS;
use crate::values::{LayerName, Share, Ticks, ValueError};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Dry the wet paint into a new layer
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Dry {
        /// Share of the wet film to dry, from below, above 0 to 1
        #[serde(rename = "dry")]
        #[cfg_attr(feature = "cli", arg(long, default_value = "1", allow_negative_numbers = true))]
        pub share: Share,
        /// Name of the new layer [default: its number]
        #[serde(default)]
        #[cfg_attr(feature = "cli", arg(long, value_name = "NAME"))]
        pub layer: Option<LayerName>,
        /// Only this rectangle, mm from the lower left corner of the surface
        #[serde(default, deserialize_with = "read::optional")]
        #[cfg_attr(feature = "cli", arg(long, value_name = "X,Y,WxH", allow_hyphen_values = true))]
        pub region: Option<Region>,
        /// Dry all wet paint evenly over this time, such as 90s, 20min, 2h; you can paint meanwhile
        #[serde(default)]
        #[cfg_attr(feature = "cli", arg(long, value_name = "TIME", conflicts_with = "share"))]
        pub over: Option<Ticks>,
        /// Use the palette instead of the canvas
        #[serde(default = "read::canvas")]
        #[cfg_attr(feature = "cli", arg(long = "palette", action = clap::ArgAction::SetTrue, value_parser = read::surface()))]
        pub surface: u32,
    }
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

    fn check_idle(&self) -> Result<(), ValueError> {
        // Over a time all that is wet dries.
        match self.over.is_some() && self.share != Share::WHOLE {
            true => Err(ValueError::Idle {
                option: "a share below 1",
                with: "a time over which all wet paint dries".to_owned(),
            }),
            false => Ok(()),
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
            Ok(match stop {
                true => StopDrying { surface }.into(),
                false => dry.into(),
            })
        },
    };
}
