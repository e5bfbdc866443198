//! Loads a brush with paint.

use crate::Mixture;
use crate::edits::{Form, StepForm, read};
use crate::values::{BrushName, ValueError};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Load a brush with paint
    ///
    /// What it carried goes to the cleaner.
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Load {
        /// Mixture to load, such as "Cobalt Blue=0.7,Titanium White=0.3"
        #[serde(rename = "load", deserialize_with = "read::text")]
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
}

impl Form for Load {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "load",
        &["beside"],
        "{ load = \"Ultramarine Blue=0.6,Titanium White=0.4\", beside = \"Bone Black\" }",
    )];
    const ARGUMENTS: Option<&'static str> =
        Some("brush|load|Ultramarine Blue=0.6,Titanium White=0.4|--beside|Bone Black");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("load", "brush"));

    fn example() -> Result<Self, ValueError> {
        let part = |paint: &str, share: f64| crate::mixture::Part {
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

    fn brush_mut(&mut self) -> Option<&mut BrushName> {
        Some(&mut self.brush)
    }

    fn mixtures_mut(&mut self) -> Vec<&mut Mixture> {
        std::iter::once(&mut self.mixture)
            .chain(&mut self.beside)
            .collect()
    }
}
