//! The painter's own sets of paints for the palette.

use maulstick_optics::PaintLibrary;
use maulstick_rig::UserError;
use maulstick_types::Mixture;
use serde::{Deserialize, Serialize};

use crate::settings::brush_load;

/// A set of paints for the palette.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PaintSet {
    /// Name given by the painter.
    pub name: String,
    /// Paints and mixtures, from the top of the palette.
    pub paints: Vec<String>,
}

impl PaintSet {
    /// A set of these mixtures.
    #[must_use]
    pub fn of(name: &str, mixtures: &[Mixture]) -> Self {
        let text = |mixture: &Mixture| match &mixture.parts[..] {
            [part] => part.paint.clone(),
            _ => mixture.to_string(),
        };
        Self {
            name: name.to_owned(),
            paints: mixtures.iter().map(text).collect(),
        }
    }

    /// Its mixtures.
    ///
    /// # Errors
    /// A [`UserError`] for a paint that the rig does not have.
    pub fn mixtures(&self, library: &PaintLibrary) -> Result<Vec<Mixture>, UserError> {
        let read = |text: &String| brush_load::read(text, library);
        self.paints.iter().map(read).collect()
    }
}
