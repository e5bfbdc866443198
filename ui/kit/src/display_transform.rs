//! sRGB to the colours of the display, for everything that the window draws itself.

use std::sync::{Arc, LazyLock};

use eframe::egui::Color32;
use glam::Vec3;
use maulstick_appearance::picture::Export;
use maulstick_optics::colour::srgb_decode;
use maulstick_optics::gamut::Gamut;
use maulstick_optics::icc::Profile;

/// Linear light of each sRGB byte.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|byte| srgb_decode(byte as f64 / 255.0) as f32));

/// From sRGB to the bytes of a display.
#[derive(Debug)]
pub struct DisplayTransform {
    gamut: Gamut,
    profile: Arc<Profile>,
}

impl DisplayTransform {
    /// Transform to a display.
    #[must_use]
    pub fn new(export: &Export) -> Self {
        Self {
            gamut: Gamut::new(export.gamut, export.profile.from_working()),
            profile: Arc::clone(&export.profile),
        }
    }

    /// Linear light of an sRGB colour of 0 to 255, as [`linear`](Self::linear).
    #[must_use]
    pub fn seen(&self, srgb: [f32; 3]) -> Vec3 {
        let linear = srgb.map(|value| srgb_decode(f64::from(value) / 255.0) as f32);
        Vec3::from_array(self.linear(linear))
    }

    /// Linear light whose sRGB encoding is the value for the display.
    #[must_use]
    pub fn linear(&self, linear: [f32; 3]) -> [f32; 3] {
        self.sent(linear).map(|byte| LINEAR[usize::from(byte)])
    }

    /// The bytes that the display has to be sent for linear light.
    #[must_use]
    pub fn colour(&self, linear: [f32; 3]) -> Color32 {
        let [red, green, blue] = self.sent(linear);
        Color32::from_rgb(red, green, blue)
    }

    fn sent(&self, linear: [f32; 3]) -> [u8; 3] {
        let mut bytes = [0; 3];
        self.profile.encode(&[self.gamut.map(linear)], &mut bytes);
        bytes
    }
}

#[cfg(test)]
mod tests {
    use maulstick_optics::colour::{RgbSpace, srgb_encode};

    use super::*;

    #[test]
    fn red_lacquer_is_sent_less_red_to_a_wide_display() {
        let tint = |space: RgbSpace| {
            DisplayTransform::new(&Export {
                profile: Arc::new(Profile::of(space)),
                ..Default::default()
            })
        };
        let hog = [238.0, 214.0, 170.0];
        let seen = |space: RgbSpace, srgb: [f32; 3]| {
            let linear = tint(space).seen(srgb).to_array();
            linear.map(|v| (255.0 * srgb_encode(f64::from(v)) + 0.5) as u8)
        };
        assert_eq!(seen(RgbSpace::Srgb, hog), hog.map(|v| v as u8));
        let [red, green, _] = seen(RgbSpace::DisplayP3, [200.0, 60.0, 30.0]);
        assert!(red < 195 && green > 65, "{red} {green}");
    }
}
