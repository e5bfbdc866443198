//! Paints of the palette.

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
}

impl Default for PaletteSection {
    fn default() -> Self {
        Self {
            wells: Vec::new(),
            piles: default_piles(),
        }
    }
}

/// Behaviours of the piles of paint on the palette.
pub const PILES: [&str; 2] = ["deplete", "last"];

fn default_piles() -> String {
    PILES[0].to_owned()
}
