//! Sides of the window.

use eframe::egui::Align2;
use serde::{Deserialize, Serialize};

/// A side of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WindowSide {
    /// Left of the view.
    Left,
    /// Right of the view.
    Right,
}

impl WindowSide {
    /// The other one.
    #[must_use]
    pub(crate) fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// Its upper corner, its lower one, and the direction from it to the middle.
    #[must_use]
    pub(crate) fn anchors(self) -> (Align2, Align2, f32) {
        match self {
            Self::Left => (Align2::LEFT_TOP, Align2::LEFT_BOTTOM, 1.0),
            Self::Right => (Align2::RIGHT_TOP, Align2::RIGHT_BOTTOM, -1.0),
        }
    }
}
