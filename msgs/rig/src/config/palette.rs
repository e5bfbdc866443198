//! Paints of the palette.

use maulstick_types::scene::default_model;
use serde::{Deserialize, Serialize};

/// `[palette]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaletteSection {
    /// Mixtures in the wells.
    #[serde(default)]
    pub wells: Vec<String>,
    /// One of [`PILES`].
    #[serde(default = "default_piles")]
    pub piles: String,
    /// Its paint model, of a new painting.
    #[serde(default = "default_model")]
    pub model: String,
}

impl Default for PaletteSection {
    fn default() -> Self {
        Self {
            wells: Vec::new(),
            piles: default_piles(),
            model: default_model(),
        }
    }
}

/// Behaviours of the piles of paint on the palette.
pub const PILES: [&str; 2] = ["deplete", "last"];

fn default_piles() -> String {
    PILES[0].to_owned()
}
