//! Renames a dry layer.

use maulstick_types::EditFields;
use maulstick_types::paint::StepName;
use maulstick_types::values::{LayerName, ValueError};

use crate::edits::{Applied, Form, LayerRef, PaintingEdit, StepForm};
use crate::error::EditError;
use crate::painting::Painting;

/// Give a dry layer another name
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct NameLayer {
    /// Number of the layer.
    pub layer: u32,
    /// New name of the layer.
    pub name: LayerName,
}

impl EditFields for NameLayer {
    const NAME: &'static str = "name_layer";
}

impl Form for NameLayer {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static [&'static str]> = None;

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            layer: 2,
            name: LayerName::new("sky")?,
        })
    }
}

impl PaintingEdit for NameLayer {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let number = self.layer;
        let bench = &mut painting.bench;
        let place = LayerRef::Number { number }.place_in(&bench.desk.scene)?;
        bench.begin_step(StepName::LayerName, None);
        let scene = &mut bench.desk.scene;
        self.name.trim().clone_into(&mut scene.layers[place].name);
        scene.version += 1;
        bench.end_own_step();
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        format!("call the layer {} '{}'", self.layer, self.name)
    }
}
