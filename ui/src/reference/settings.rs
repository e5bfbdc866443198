//! Settings of the reference picture that are remembered.

use std::path::PathBuf;

use maulstick_types::quantity;
use maulstick_types::values::Quantity;
use serde::{Deserialize, Serialize};

use super::LEAST;

quantity! {
    /// Opacity of the picture's frame.
    pub(crate) FrameOpacity: "opacity", 0.1..=1.0, Self::RANGE, "",
    tr_noop!("How much of the desk the picture hides")
}

/// Settings of the reference picture that are remembered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ReferencePreferences {
    /// True while it is shown.
    pub shown: bool,
    pub path: Option<PathBuf>,
    /// Position of its frame, points from the window's upper left corner.
    pub place: [f32; 2],
    /// Width and height of the frame's inside, points.
    pub size: [f32; 2],
    /// A [`FrameOpacity`].
    pub opacity: f32,
    /// True to search among all paints, false among those of the palette.
    pub all_paints: bool,
}

impl Default for ReferencePreferences {
    fn default() -> Self {
        Self {
            shown: false,
            path: None,
            place: [24.0, 24.0],
            size: [320.0, 320.0],
            opacity: 1.0,
            all_paints: false,
        }
    }
}

impl ReferencePreferences {
    /// The same with numbers that make a frame.
    pub(super) fn sound(&self) -> Self {
        let within = |value: f32, least: f32, most: f32, usual: f32| {
            if value.is_finite() {
                value.clamp(least, most)
            } else {
                usual
            }
        };
        let usual = Self::default();
        Self {
            place: [0, 1].map(|i| within(self.place[i], 0.0, 20_000.0, usual.place[i])),
            size: [0, 1].map(|i| within(self.size[i], LEAST[i], 20_000.0, usual.size[i])),
            opacity: within(
                self.opacity,
                *FrameOpacity::RANGE.start() as f32,
                *FrameOpacity::RANGE.end() as f32,
                usual.opacity,
            ),
            ..self.clone()
        }
    }
}
