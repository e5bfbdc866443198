//! Renames a dry layer.

use maulstick_canvas::EditError;
use maulstick_types::EditFields;
use maulstick_types::paint::StepName;
use maulstick_types::values::{LayerName, ValueError};

use crate::edits::{Applied, Form, LayerRef, PaintingEdit, StepForm};
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
    const ARGUMENTS: Option<&'static str> = None;

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
        let place = LayerRef::Number { number }.place_in(&painting.scene)?;
        painting.begin_step(StepName::LayerName, None);
        self.name
            .trim()
            .clone_into(&mut painting.scene.layers[place].name);
        painting.scene.version += 1;
        painting.end_own_step();
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        format!("call the layer {} '{}'", self.layer, self.name)
    }
}
