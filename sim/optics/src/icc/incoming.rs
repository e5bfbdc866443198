//! Input profiles: conversion of a foreign profile's colours to sRGB.

use std::fmt;
use std::sync::Arc;

use moxcms::{
    ColorProfile, DataColorSpace, Layout, RenderingIntent, Transform16BitExecutor, TransformOptions,
};

use super::{ProfileError, matrix_profile, through};
use crate::colour::RgbSpace;

/// The profile that a picture brings with it.
pub struct Incoming {
    channels: usize,
    transform: Arc<Transform16BitExecutor>,
}

impl Incoming {
    /// From the bytes of an ICC profile, of grey or of RGB.
    ///
    /// # Errors
    /// [`ProfileError`].
    pub fn read(icc: &[u8]) -> Result<Self, ProfileError> {
        let damaged = |error: moxcms::CmsError| ProfileError::Damaged(error.to_string());
        let source = ColorProfile::new_from_slice(icc).map_err(damaged)?;
        let (channels, layout) = match source.color_space {
            DataColorSpace::Rgb => (3, Layout::Rgb),
            DataColorSpace::Gray => (1, Layout::Gray),
            other => return Err(ProfileError::NotRgb(format!("{other:?}"))),
        };
        let options = TransformOptions {
            rendering_intent: RenderingIntent::RelativeColorimetric,
            prefer_fixed_point: false,
            ..Default::default()
        };
        let srgb = matrix_profile(&RgbSpace::Srgb.to_pcs(), "");
        let transform = source
            .create_transform_16bit(layout, &srgb, Layout::Rgb, options)
            .map_err(|error| ProfileError::OneWay(error.to_string()))?;
        Ok(Self {
            channels,
            transform,
        })
    }

    /// Channels of a pixel: 1, grey, or 3.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Encoded sRGB, 0 to 65535, of encoded pixels, by `moxcms`, which may differ in the last digit between processors.
    /// Colours outside of sRGB are clipped.
    #[must_use]
    pub fn to_srgb(&self, encoded: &[u16]) -> Vec<u16> {
        if self.channels == 3 {
            return through(&*self.transform, encoded);
        }
        let mut to = vec![u16::MAX; 3 * encoded.len()];
        if self.transform.transform(encoded, &mut to).is_err() {
            to.fill(u16::MAX);
        }
        to
    }
}

impl fmt::Debug for Incoming {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Incoming")
            .field("channels", &self.channels)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::icc::Profile;

    fn off(one: &[u16], two: &[u16]) -> u16 {
        let pairs = one.iter().zip(two);
        pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(u16::MAX)
    }

    #[test]
    fn colours_of_other_profiles_come_into_srgb() {
        let srgb = Incoming::read(Profile::of(RgbSpace::Srgb).icc()).expect("whole");
        let pixels = [0, 20_000, 65_535, 9_000, 40_000, 33_000];
        let same = srgb.to_srgb(&pixels);
        assert!(off(&same, &pixels) < 40, "{same:?}");
        // sRGB's green (0, 1, 0) in Display P3 is (.4584, .9853, .2983).
        let wide = Incoming::read(Profile::of(RgbSpace::DisplayP3).icc()).expect("whole");
        let green = wide.to_srgb(&[30_041, 64_572, 19_549]);
        println!("{green:?}");
        assert!(off(&green[1..2], &[65_535]) < 200 && green[0] < 3000 && green[2] < 3000);
        assert!(off(&srgb.to_srgb(&[30_041, 64_572, 19_549]), &green) > 9000);
        let grey = ColorProfile::new_gray_with_gamma(1.0)
            .encode()
            .expect("whole");
        let grey = Incoming::read(&grey).expect("whole");
        assert_eq!(grey.channels(), 1);
        // Linear .2140 is sRGB's half.
        let half = grey.to_srgb(&[14_027]);
        println!("{half:?}");
        assert!(off(&half, &[32_768; 3]) < 200, "{half:?}");
    }

    #[test]
    fn what_is_no_profile_is_refused() {
        assert!(matches!(
            Incoming::read(b"no"),
            Err(ProfileError::Damaged(_))
        ));
    }
}
