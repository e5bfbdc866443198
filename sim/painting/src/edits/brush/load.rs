//! Loads a brush with paint.

use maulstick_model::brush::load::Half;
use maulstick_types::paint::StepName;
use maulstick_types::values::{BrushName, ValueError};
use maulstick_types::{EditFields, Mixture};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::EditError;
use crate::painting::Painting;
use crate::painting::brushes::loads::named;
use crate::painting::brushes::seed_of;

/// Load a brush with paint
///
/// The old load goes to the cleaner.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Load {
    /// Mixture to load, such as "Cobalt Blue=0.7,Titanium White=0.3"
    #[serde(alias = "load", deserialize_with = "read::text")]
    pub mixture: Mixture,
    /// Second mixture, for the right half of the brush; the first then loads the left half
    #[serde(default, deserialize_with = "read::optional")]
    #[cfg_attr(feature = "cli", arg(long, value_name = "MIXTURE"))]
    pub beside: Option<Mixture>,
    /// Brush of the rig
    #[serde(default)]
    #[cfg_attr(feature = "cli", arg(long, default_value = "main"))]
    pub brush: BrushName,
}

impl EditFields for Load {
    const NAME: &'static str = "load";
}

impl Form for Load {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "load",
        &["beside"],
        "{ load = \"Ultramarine Blue=0.6,Titanium White=0.4\", beside = \"Bone Black\" }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&[
        "brush",
        "load",
        "Ultramarine Blue=0.6,Titanium White=0.4",
        "--beside",
        "Bone Black",
    ]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("load", "brush"));

    fn example() -> Result<Self, ValueError> {
        let part = |paint: &str, share: f64| maulstick_types::mixture::Part {
            paint: paint.to_owned(),
            share,
        };
        Ok(Self {
            mixture: Mixture {
                parts: vec![part("Ultramarine Blue", 0.6), part("Titanium White", 0.4)],
            },
            beside: Some(Mixture::pure("Bone Black")),
            brush: BrushName::main(),
        })
    }
}

impl PaintingEdit for Load {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let bench = &mut painting.bench;
        let brush = bench.brushes.at(&self.brush)?;
        let mixtures: Vec<Mixture> = std::iter::once(&self.mixture)
            .chain(&self.beside)
            .cloned()
            .collect();
        let slots = bench.desk.all_slots(&mixtures)?;
        let paints = named(&mixtures);
        bench.begin_step(StepName::Load { paints }, Some(brush));
        let parts: Vec<_> = match &slots[..] {
            [both] => vec![(&both[..], Half::Both)],
            halves => halves
                .iter()
                .map(|slots| &slots[..])
                .zip([Half::Left, Half::Right])
                .collect(),
        };
        let own = &mut bench.brushes[brush];
        let seed = seed_of(bench.accounts.work.strokes + 1);
        own.fill(&parts, &bench.desk, seed, &mut bench.accounts.ledger);
        bench.end_step_of(brush);
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        let beside = self.beside.as_ref();
        let beside = beside.map_or_else(String::new, |own| {
            format!(", beside it {}", words::mixture(own))
        });
        let mixture = words::mixture(&self.mixture);
        format!("load {} with {mixture}{beside}", self.brush)
    }

    fn brush_mut(&mut self) -> Option<&mut BrushName> {
        Some(&mut self.brush)
    }

    fn mixtures_mut(&mut self) -> Vec<&mut Mixture> {
        std::iter::once(&mut self.mixture)
            .chain(&mut self.beside)
            .collect()
    }
}
