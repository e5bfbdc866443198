//! Gives a dry layer another name.

use crate::edits::{Form, StepForm};
use crate::values::{LayerName, ValueError};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Give a dry layer another name
    pub struct NameLayer {
        /// Number of the layer.
        pub layer: u32,
        /// Its name from now on.
        pub name: LayerName,
    }
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
