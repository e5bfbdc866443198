//! `[paint]`: the painting and what computes it.

use std::path::PathBuf;

use maulstick_types::scene::default_model;
use serde::{Deserialize, Serialize};

use crate::size::{SizeError, parse_bytes};

/// Backends of paint and colour.
pub const BACKENDS: [&str; 3] = ["auto", "cpu", "gpu"];

/// `[paint]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PaintSection {
    /// Paint model of the canvas of a new painting, or `auto`; its name is checked where that is begun.
    pub model: String,
    /// One of [`BACKENDS`].
    pub backend: String,
    /// A paint file; the measured paints that come with the rig if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub paints: Option<PathBuf>,
    /// The painting's document; without it the painting is in memory alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub document: Option<PathBuf>,
    /// Most memory of the painting's tiles where it has a document.
    pub memory: String,
    /// Most room of its history; beyond that its oldest steps are merged. As the document has it if
    /// absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub history: Option<String>,
    /// Most room of the record of what was painted; 0 keeps none. As the document has it if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub record: Option<String>,
}

/// Room of a painting, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PaintingRoom {
    /// Most memory of its tiles.
    pub memory: u64,
    /// Most of its history, if that is set.
    pub history: Option<u64>,
    /// Most of its record, if that is set.
    pub record: Option<u64>,
}

/// Sizes that a painting cannot have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RoomError {
    /// A text that is not a size.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// Less memory than a painting takes.
    #[error("a memory of {0} is less than 64M")]
    Memory(String),
}

impl PaintSection {
    /// Bounds of memory, and of history and record where they are set.
    ///
    /// # Errors
    /// [`RoomError`].
    pub fn room(&self) -> Result<PaintingRoom, RoomError> {
        let memory = parse_bytes(&self.memory)?;
        if memory < MEMORY_MIN {
            return Err(RoomError::Memory(self.memory.clone()));
        }
        let bytes = |size: &Option<String>| size.as_deref().map(parse_bytes).transpose();
        Ok(PaintingRoom {
            memory,
            history: bytes(&self.history)?,
            record: bytes(&self.record)?,
        })
    }
}

/// Least memory of a painting, bytes.
const MEMORY_MIN: u64 = 64 << 20;

impl Default for PaintSection {
    fn default() -> Self {
        Self {
            model: default_model(),
            backend: "auto".into(),
            paints: None,
            document: None,
            memory: "1G".into(),
            history: None,
            record: None,
        }
    }
}
