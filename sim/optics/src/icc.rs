//! Output colour spaces, with ICC profiles for other programs.
//!
//! The encoding of sRGB and Display P3 is computed here, and is the same on every machine; so are the bytes of their
//! profiles, which contain no date. Colours for the profile of a display or a printer go through `moxcms`, whose
//! arithmetic may differ between processors.

mod incoming;

pub use incoming::Incoming;

use std::fmt;
use std::sync::{Arc, OnceLock};

use moxcms::{
    ColorProfile, DataColorSpace, Layout, LocalizableString, ProfileClass, ProfileText,
    RenderingIntent, ToneReprCurve, Transform16BitExecutor, TransformOptions, Xyzd,
};

use crate::colour::{
    D50, Matrix, RgbSpace, SrgbCurve, SrgbTable, apply, bradford, inverse, product, srgb_encode,
};

/// Errors of reading an output profile.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProfileError {
    /// The profile cannot be read.
    #[error("this is not an ICC profile, or it is damaged: {0}")]
    Damaged(String),
    /// Its colours are not red, green and blue.
    #[error("this profile is for {0} colours, but pictures are RGB")]
    NotRgb(String),
    /// It converts only from the device.
    #[error("colours cannot be converted to this profile: {0}")]
    OneWay(String),
}

/// Encoding of the gamut's linear light as the bytes of a picture.
enum Encoder {
    /// By the transfer function of sRGB.
    Curve(SrgbTable),
    /// By that and then by a profile.
    Foreign {
        steps: Vec<u16>,
        transform: Arc<Transform16BitExecutor>,
    },
}

/// A destination of pictures: the primaries of its gamut, its encoding, its profile.
pub struct Profile {
    icc: Vec<u8>,
    from_working: Matrix,
    encoder: Encoder,
    /// The transfer function of sRGB for pictures of 16 bits, made for the first of them.
    curve: OnceLock<SrgbCurve>,
}

/// Place of the date in a profile (ICC.1:2022, § 7.2.1), which `moxcms` sets to the time of writing; a fixed date gives
/// the same picture the same bytes: 1 January 2000, as its year, month and day.
const DATE: std::ops::Range<usize> = 24..36;
const NEW_CENTURY: [u8; 12] = [7, 208, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0];

/// Steps of linear light that are distinguished before a foreign profile.
const STEPS: u32 = 65_535;

impl Profile {
    /// The profile of a colour space.
    #[must_use]
    pub fn of(space: RgbSpace) -> Self {
        let name = match space {
            RgbSpace::Srgb => "sRGB",
            RgbSpace::DisplayP3 => "Display P3",
        };
        // It encodes its own input: only a lack of memory can fail.
        let icc = matrix_profile(&space.to_pcs(), name).encode();
        let mut icc = icc.unwrap_or_default();
        if let Some(date) = icc.get_mut(DATE) {
            date.copy_from_slice(&NEW_CENTURY);
        }
        Self {
            icc,
            from_working: space.from_working(),
            encoder: Encoder::Curve(SrgbTable::default()),
            curve: OnceLock::new(),
        }
    }

    /// The profile of a display or printer, from the bytes of an ICC file.
    ///
    /// # Errors
    /// [`ProfileError`].
    pub fn read(icc: Vec<u8>) -> Result<Self, ProfileError> {
        let damaged = |what: &dyn fmt::Display| ProfileError::Damaged(what.to_string());
        let target = ColorProfile::new_from_slice(&icc).map_err(|error| damaged(&error))?;
        if target.color_space != DataColorSpace::Rgb {
            return Err(ProfileError::NotRgb(format!("{:?}", target.color_space)));
        }
        if matches!(
            target.profile_class,
            ProfileClass::DeviceLink | ProfileClass::Named | ProfileClass::Abstract
        ) {
            let class = format!("it is of the class {:?}", target.profile_class);
            return Err(ProfileError::OneWay(class));
        }
        let has_table = target.lut_b_to_a_perceptual.is_some()
            || target.lut_b_to_a_colorimetric.is_some()
            || target.lut_b_to_a_saturation.is_some();
        // A profile with primaries has its own gamut; a table's gamut is unknown, and the wide space's is nearest.
        let to_pcs = if has_table {
            RgbSpace::DisplayP3.to_pcs()
        } else {
            let (r, g, b) = (
                target.red_colorant,
                target.green_colorant,
                target.blue_colorant,
            );
            [[r.x, g.x, b.x], [r.y, g.y, b.y], [r.z, g.z, b.z]]
        };
        let from_working = product(&inverse(&to_pcs), &RgbSpace::Srgb.to_pcs());
        // White is white, though the sum of three rounded primaries may be off.
        let white = apply(&from_working, [1.0; 3]);
        if !white.iter().all(|v| (0.5..2.0).contains(v)) {
            return Err(damaged(&"its primaries do not make white"));
        }
        let from_working: Matrix =
            std::array::from_fn(|i| from_working[i].map(|value| value / white[i]));
        if !from_working.iter().flatten().all(|v| v.abs() < 100.0) {
            return Err(damaged(&"its primaries span no gamut"));
        }
        let options = TransformOptions {
            rendering_intent: RenderingIntent::RelativeColorimetric,
            prefer_fixed_point: false,
            ..Default::default()
        };
        let transform = matrix_profile(&to_pcs, "")
            .create_transform_16bit(Layout::Rgb, &target, Layout::Rgb, options)
            .map_err(|error| ProfileError::OneWay(error.to_string()))?;
        let encoded = |i: u32| srgb_encode(f64::from(i) / f64::from(STEPS)) * 65_535.0 + 0.5;
        let profile = Self {
            icc,
            from_working,
            encoder: Encoder::Foreign {
                steps: (0..=STEPS).map(|i| encoded(i) as u16).collect(),
                transform,
            },
            curve: OnceLock::new(),
        };
        profile.check_ends()?;
        Ok(profile)
    }

    /// A profile that maps all to one colour was damaged where no reader looks.
    fn check_ends(&self) -> Result<(), ProfileError> {
        let mut ends = [0; 6];
        self.encode(&[[0.0; 3], [1.0; 3]], &mut ends);
        if ends[..3] == ends[3..] {
            let what = "black and white are the same in it";
            return Err(ProfileError::Damaged(what.to_owned()));
        }
        Ok(())
    }

    /// The bytes to embed in a picture.
    #[must_use]
    pub fn icc(&self) -> &[u8] {
        &self.icc
    }

    /// From the working space to linear light of the gamut that [`encode`](Self::encode) takes.
    #[must_use]
    pub fn from_working(&self) -> &Matrix {
        &self.from_working
    }

    /// Bytes of pixels, three each, for linear light of the gamut.
    pub fn encode(&self, linear: &[[f32; 3]], bytes: &mut [u8]) {
        match &self.encoder {
            Encoder::Curve(table) => {
                for (pixel, colour) in bytes.chunks_exact_mut(3).zip(linear) {
                    pixel.copy_from_slice(&colour.map(|channel| table.byte(channel)));
                }
            }
            Encoder::Foreign { steps, transform } => {
                let step = |v: &f32| (v.clamp(0.0, 1.0) * STEPS as f32 + 0.5) as usize;
                let from: Vec<u16> = linear.iter().flatten().map(|v| steps[step(v)]).collect();
                let to = through(&**transform, &from);
                for (byte, value) in bytes.iter_mut().zip(to) {
                    // Division by 257 to the nearest.
                    *byte = ((u32::from(value) + 128) / 257) as u8;
                }
            }
        }
    }

    /// [`encode`](Self::encode) with 16 bits a channel: values of pixels, three each.
    pub fn encode16(&self, linear: &[[f32; 3]], values: &mut [u16]) {
        let curve = self.curve.get_or_init(SrgbCurve::default);
        for (pixel, colour) in values.chunks_exact_mut(3).zip(linear) {
            pixel.copy_from_slice(&colour.map(|channel| curve.value(channel)));
        }
        if let Encoder::Foreign { transform, .. } = &self.encoder {
            let to = through(&**transform, values);
            values.copy_from_slice(&to);
        }
    }

    /// For a display with its own profile: its values for the colours of a cube of `side`³ nodes of encoded light, red
    /// fastest; 0 to 1. `None` where the encoding of sRGB suffices.
    #[must_use]
    pub fn cube(&self, side: usize) -> Option<Vec<[f32; 3]>> {
        let Encoder::Foreign { transform, .. } = &self.encoder else {
            return None;
        };
        let last = side.max(2) - 1;
        let node = |i: usize| ((i * 65_535 + last / 2) / last) as u16;
        let from: Vec<u16> = (0..side * side * side)
            .flat_map(|i| [i % side, i / side % side, i / side / side].map(node))
            .collect();
        let to = through(&**transform, &from);
        let colours = to.chunks_exact(3);
        Some(
            colours
                .map(|rgb| [0, 1, 2].map(|i| f32::from(rgb[i]) / 65_535.0))
                .collect(),
        )
    }
}

/// White where the profile refuses: lengths agree by construction.
fn through(transform: &Transform16BitExecutor, from: &[u16]) -> Vec<u16> {
    let mut to = vec![u16::MAX; from.len()];
    if transform.transform(from, &mut to).is_err() {
        to.fill(u16::MAX);
    }
    to
}

/// A profile of three primaries, rows to the connection space, with the transfer function of sRGB.
fn matrix_profile(to_pcs: &Matrix, name: &str) -> ColorProfile {
    let xyz = |[x, y, z]: [f64; 3]| Xyzd { x, y, z };
    let column = |j: usize| xyz(to_pcs.map(|row| row[j]));
    let text = |value: &str| {
        let [language, country] = ["en", "US"].map(str::to_owned);
        let text = LocalizableString::new(language, country, value.to_owned());
        Some(ProfileText::Localizable(vec![text]))
    };
    // IEC 61966-2-1 as the parametric curve of type 3: g, a, b, c, d.
    let curve = [2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.040_45];
    let curve = Some(ToneReprCurve::Parametric(curve.to_vec()));
    let d65 = apply(&RgbSpace::Srgb.to_xyz(), [1.0; 3]);
    // Not all of its fields can be named in an expression.
    let mut profile = ColorProfile::default();
    profile.profile_class = ProfileClass::DisplayDevice;
    profile.color_space = DataColorSpace::Rgb;
    profile.pcs = DataColorSpace::Xyz;
    profile.rendering_intent = RenderingIntent::RelativeColorimetric;
    profile.red_colorant = column(0);
    profile.green_colorant = column(1);
    profile.blue_colorant = column(2);
    profile.white_point = xyz(D50);
    profile.media_white_point = Some(xyz(D50));
    profile.chromatic_adaptation = Some(moxcms::Matrix3d {
        v: bradford(d65, D50),
    });
    profile.red_trc.clone_from(&curve);
    profile.green_trc.clone_from(&curve);
    profile.blue_trc = curve;
    profile.description = text(name);
    profile.copyright = text("CC0 1.0, no rights reserved.");
    profile
}

impl fmt::Debug for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Profile")
            .field("bytes", &self.icc.len())
            .field("from_working", &self.from_working)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests;
