//! Viewer over the middle of the desk, and light of the scene's lamp, for drawing a brush.

use std::sync::LazyLock;

use eframe::egui::{Color32, Pos2};
use glam::Vec3;
use maulstick_optics::colour::SrgbTable;

/// Linear light to bytes.
static BYTES: LazyLock<SrgbTable> = LazyLock::new(SrgbTable::default);

/// Viewer and light for drawing a brush. Lengths are desk lengths in the frame of the surface below, m.
pub(crate) struct ViewLight<'a> {
    /// From that frame to the window, points.
    pub to_window: &'a dyn Fn(Vec3) -> Pos2,
    /// Points a metre.
    pub scale: f32,
    /// Unit vector toward the viewer.
    pub up: Vec3,
    /// Unit vector toward the lamp.
    pub toward: Vec3,
    /// Strength of the light, with the exposure.
    pub light: f32,
}

impl ViewLight<'_> {
    /// Unit vector halfway between lamp and viewer.
    #[must_use]
    pub(crate) fn half(&self) -> Vec3 {
        (self.toward + self.up).normalize_or(self.up)
    }

    /// Linear light as a vertex colour with opacity 0 to 1.
    #[must_use]
    pub(crate) fn vertex(&self, linear: Vec3, opacity: f32) -> Color32 {
        let [r, g, b] = (linear * self.light).to_array().map(|v| BYTES.byte(v));
        Color32::from_rgba_unmultiplied(r, g, b, (255.0 * opacity) as u8)
    }
}

/// Smooth from 0 at `low` to 1 at `high`.
#[must_use]
pub(crate) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
