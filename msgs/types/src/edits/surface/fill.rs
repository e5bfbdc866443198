//! Lays an even film of wet paint over a surface.

use serde::de::{Deserialize as _, Deserializer};

use crate::Mixture;
use crate::edits::{Form, StepForm, read};
use crate::scene::CANVAS;
use crate::values::{BrushName, FilmThickness, ValueError};
use crate::wire::define::{wire_enum, wire_struct};

wire_enum! {
    /// Paint of a film.
    pub enum FillPaint {
        /// A mixture from the tubes.
        Mixture {
            /// The paints.
            mixture: Mixture,
        },
        /// The mean colour of the paint on a brush, which keeps what it has.
        Carried {
            /// The brush.
            brush: BrushName,
        },
    }
}

wire_struct! {
    /// Lay a film of wet paint over the canvas
    pub struct Fill {
        /// The paint.
        pub paint: FillPaint,
        /// Thickness of the film.
        pub thickness: FilmThickness,
        /// The surface.
        pub surface: u32,
    }
}

/// A step of a script.
#[derive(serde::Deserialize)]
struct FillStep {
    #[serde(default, deserialize_with = "read::optional")]
    fill: Option<Mixture>,
    #[serde(default)]
    um: FilmThickness,
}

impl Form for Fill {
    const STEPS: &'static [StepForm] = &[
        StepForm::new(
            "fill",
            &["um"],
            "{ fill = \"Yellow Ochre=0.3,Titanium White=0.7\", um = 40 }",
        ),
        StepForm::switch(
            "fill_with_brush",
            &["um"],
            "{ fill_with_brush = true, um = 30 }",
        ),
    ];
    const ARGUMENTS: Option<&'static str> =
        Some("canvas|fill|Yellow Ochre=0.3,Titanium White=0.7|--um|40");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> = Some(crate::edits::CommandForm::of::<
        cli::FillOptions,
    >("fill", "canvas"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            paint: FillPaint::Mixture {
                mixture: "Yellow Ochre=0.3,Titanium White=0.7".parse()?,
            },
            thickness: FilmThickness::in_unit(40.0)?,
            surface: CANVAS,
        })
    }

    fn read_step<'de, D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let FillStep { fill, um } = FillStep::deserialize(from)?;
        let brush = BrushName::main();
        Ok(Self {
            paint: fill.map_or(FillPaint::Carried { brush }, |mixture| FillPaint::Mixture {
                mixture,
            }),
            thickness: um,
            surface: CANVAS,
        })
    }

    fn brush_mut(&mut self) -> Option<&mut BrushName> {
        match &mut self.paint {
            FillPaint::Carried { brush } => Some(brush),
            FillPaint::Mixture { .. } => None,
        }
    }

    fn mixtures_mut(&mut self) -> Vec<&mut Mixture> {
        match &mut self.paint {
            FillPaint::Mixture { mixture } => vec![mixture],
            FillPaint::Carried { .. } => Vec::new(),
        }
    }
}

#[cfg(feature = "cli")]
mod cli {
    use super::{BrushName, Fill, FillPaint, FilmThickness, Mixture};
    use crate::edits::{Edit, read};

    /// Lay a film of wet paint over the canvas
    #[derive(clap::Args)]
    pub(super) struct FillOptions {
        /// Mixture, such as "Yellow Ochre=0.7,Titanium White=0.3"
        #[arg(required_unless_present = "with_brush", conflicts_with = "with_brush")]
        mixture: Option<Mixture>,
        /// Use the mean colour of the paint on this brush instead
        #[arg(long, value_name = "BRUSH")]
        with_brush: Option<BrushName>,
        /// Thickness of the film, µm
        #[arg(long, default_value = "50", allow_negative_numbers = true)]
        um: FilmThickness,
        /// Use the palette instead of the canvas
        #[arg(long = "palette", action = clap::ArgAction::SetTrue, value_parser = read::surface())]
        surface: u32,
    }

    impl From<FillOptions> for Edit {
        fn from(options: FillOptions) -> Self {
            let brush = options.with_brush.unwrap_or_default();
            let paint = match options.mixture {
                Some(mixture) => FillPaint::Mixture { mixture },
                None => FillPaint::Carried { brush },
            };
            Fill {
                paint,
                thickness: options.um,
                surface: options.surface,
            }
            .into()
        }
    }
}
