//! Colours of the window's own things as the display has to be sent them.

use std::sync::Arc;

use maulstick_optics::colour::srgb_decode;
use maulstick_optics::gamut::Gamut;
use maulstick_optics::icc::Profile;
use maulstick_paint::picture::Export;

/// From sRGB to the bytes of a display.
#[derive(Debug)]
pub struct Tint {
    gamut: Gamut,
    profile: Arc<Profile>,
}

impl Tint {
    /// For a display.
    #[must_use]
    pub fn new(export: &Export) -> Self {
        Self {
            gamut: Gamut::new(export.gamut, export.profile.from_working()),
            profile: Arc::clone(&export.profile),
        }
    }

    /// Values of 0 to 255 for such of sRGB.
    #[must_use]
    pub fn encoded(&self, srgb: [f32; 3]) -> [f32; 3] {
        let linear = srgb.map(|value| srgb_decode(f64::from(value) / 255.0) as f32);
        self.sent(linear).map(f32::from)
    }

    /// Linear light that, encoded as sRGB, is what the display has to be sent.
    #[must_use]
    pub fn linear(&self, linear: [f32; 3]) -> [f32; 3] {
        let decoded = |byte: u8| srgb_decode(f64::from(byte) / 255.0) as f32;
        self.sent(linear).map(decoded)
    }

    fn sent(&self, linear: [f32; 3]) -> [u8; 3] {
        let mut bytes = [0; 3];
        self.profile.encode(&[self.gamut.map(linear)], &mut bytes);
        bytes
    }
}

#[cfg(test)]
mod tests {
    use maulstick_optics::colour::RgbSpace;

    use super::*;

    #[test]
    fn red_lacquer_is_sent_less_red_to_a_wide_display() {
        let tint = |space: RgbSpace| {
            Tint::new(&Export {
                profile: Arc::new(Profile::of(space)),
                ..Default::default()
            })
        };
        let hog = [238.0, 214.0, 170.0];
        assert_eq!(tint(RgbSpace::Srgb).encoded(hog), hog);
        let [red, green, _] = tint(RgbSpace::DisplayP3).encoded([200.0, 60.0, 30.0]);
        assert!(red < 195.0 && green > 65.0, "{red} {green}");
    }
}
