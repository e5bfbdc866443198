//! Covers a surface with an even film of wet paint.

use maulstick_canvas::quantum::{Counts, QUANTUM_M, SLOTS};
use maulstick_canvas::tile::TileId;
use maulstick_types::paint::StepName;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{BrushName, FilmThickness, ValueError};
use maulstick_types::{EditFields, Mixture};
use serde::de::{Deserialize as _, Deserializer};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::EditError;
use crate::ledger::Ledger;
use crate::painting::Painting;
use crate::painting::bench::Workbench;
use crate::painting::surfaces::film::Films;

/// Paint of a film.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum FillPaint {
    /// A mixture from the tubes.
    Mixture {
        /// The paints.
        mixture: Mixture,
    },
    /// The mean colour of the paint on a brush, whose load is unchanged.
    Carried {
        /// The brush.
        brush: BrushName,
    },
}

/// Lay a film of wet paint over the canvas
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Fill {
    /// The paint.
    pub paint: FillPaint,
    /// Thickness of the film.
    pub thickness: FilmThickness,
    /// The surface.
    pub surface: u32,
}

impl Fill {
    /// Lays the film over a whole surface, but for its wells; from where `book` says.
    fn lay(
        &self,
        on: usize,
        mixture: &Mixture,
        book: fn(&mut Ledger, &Counts),
        bench: &mut Workbench,
    ) -> Result<(), EditError> {
        let slots = bench.desk.slots(mixture)?;
        let mut quanta = [0.0f32; SLOTS];
        for (slot, share) in slots {
            quanta[slot] += (share * self.thickness.get() / QUANTUM_M).round() as f32;
        }
        bench.begin_step(StepName::Fill, None);
        let [across, up] = bench.desk.surfaces[on].store.grid();
        let mut films = Films::default();
        for y in 0..up {
            for x in 0..across {
                let place = (on, TileId { x, y });
                bench.lay_on(place, |_, slot| quanta[slot], Some(&mut films), book);
            }
        }
        bench.end_own_step();
        Ok(())
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

impl EditFields for Fill {
    const NAME: &'static str = "fill";
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
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&[
        "canvas",
        "fill",
        "Yellow Ochre=0.3,Titanium White=0.7",
        "--um",
        "40",
    ]);
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
}

impl PaintingEdit for Fill {
    /// Covers a surface with an even film of paint from the tubes, or of the mean colour of a brush's load, which is
    /// unchanged.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let bench = &mut painting.bench;
        let on = bench.desk.surfaces.at(self.surface)?;
        match &self.paint {
            FillPaint::Mixture { mixture } => self.lay(on, mixture, Ledger::from_tube, bench)?,
            FillPaint::Carried { brush } => {
                bench.commit();
                let brush = &bench.brushes[bench.brushes.at(brush)?];
                let mixture = brush.mixture(&bench.desk.scene)?;
                self.lay(on, &mixture, Ledger::from_mode_counts, bench)?;
            }
        }
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        let with = match &self.paint {
            FillPaint::Mixture { mixture } => words::mixture(mixture),
            FillPaint::Carried { brush } => format!("what {brush} carries"),
        };
        let film = words::um(self.thickness.get());
        let surface = words::surface(self.surface);
        format!("fill the {surface} with {with}, {film} µm")
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
    use crate::edits::read;
    use maulstick_types::Edit;
    use maulstick_types::values::Quantity as _;

    /// Lay a film of wet paint over the canvas
    #[derive(clap::Args)]
    pub(super) struct FillOptions {
        /// Mixture, such as "Yellow Ochre=0.7,Titanium White=0.3"
        #[arg(required_unless_present = "with_brush", conflicts_with = "with_brush")]
        mixture: Option<Mixture>,
        /// Use the mean colour of the paint on this brush instead
        #[arg(long, value_name = "BRUSH")]
        with_brush: Option<BrushName>,
        #[arg(long, help = FilmThickness::option_help(), default_value = "50", allow_negative_numbers = true)]
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
