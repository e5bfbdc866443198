//! From the numbers of a file to light: by its profile, or by a transfer function and chromaticities.

use std::fmt;

use maulstick_optics::colour::{Chromaticities, Matrix, Transfer};
use maulstick_optics::icc::Incoming;

/// Most bytes of a profile: those of printers have some megabytes.
pub(super) const MOST_PROFILE: usize = 32 << 20;

/// A mark of a picture's colours that was passed over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnusedMark {
    /// The mark, as its format calls it.
    pub mark: &'static str,
    /// The defect.
    pub reason: String,
}

impl fmt::Display for UnusedMark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mark, reason } = self;
        write!(
            f,
            "its {mark} cannot be used ({reason}); its colours may be off"
        )
    }
}

/// The numbers of black and of white, of 65,535.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub(super) black: f64,
    pub(super) white: f64,
}

impl Range {
    /// The full range of numbers.
    pub(super) const FULL: Self = Self {
        black: 0.0,
        white: 65_535.0,
    };
}

/// Conversion of a picture's colours to linear sRGB.
pub(super) struct Colours {
    profile: Option<Incoming>,
    /// Light of each number, 0 to 65,535; for a profile, of its converted numbers.
    light: Vec<f32>,
    /// From that light to sRGB's, where it is not sRGB's.
    to_srgb: Option<[[f32; 3]; 3]>,
}

impl Colours {
    /// Those of sRGB.
    pub(super) fn srgb() -> Self {
        Self {
            profile: None,
            light: table(Transfer::Srgb, Range::FULL),
            to_srgb: None,
        }
    }

    /// Colours by a profile, for a picture of 1 or 3 colour channels.
    pub(super) fn of_profile(icc: &[u8], channels: usize) -> Result<Self, UnusedMark> {
        let unused = |reason: String| UnusedMark {
            mark: "colour profile",
            reason,
        };
        if icc.len() > MOST_PROFILE {
            let most = MOST_PROFILE >> 20;
            return Err(unused(format!("it has more than {most} MB")));
        }
        let profile = Incoming::read(icc).map_err(|error| unused(error.to_string()))?;
        // An RGB profile is right for grey, too.
        if profile.channels() == 1 && channels != 1 {
            return Err(unused("it is one for grey".to_owned()));
        }
        Ok(Self {
            profile: Some(profile),
            ..Self::srgb()
        })
    }

    /// By a transfer function and chromaticities; `None` where these span no gamut.
    pub(super) fn encoded(
        transfer: Transfer,
        chromaticities: &Chromaticities,
        range: Range,
    ) -> Option<Self> {
        let to_srgb: Matrix = chromaticities.to_srgb()?;
        let is_own = chromaticities.is_srgb();
        Some(Self {
            profile: None,
            light: table(transfer, range),
            to_srgb: (!is_own).then(|| to_srgb.map(|row| row.map(|value| value as f32))),
        })
    }

    /// True where floats are light, and no profile says otherwise.
    pub(super) fn takes_floats(&self) -> bool {
        self.profile.is_none()
    }

    /// Linear sRGB of pixels of `channels` numbers each, 1 or 3; not within 0 to 1 where they are of
    /// another gamut or have more light than white.
    pub(super) fn of_whole(&self, row: &[u16], channels: usize) -> Vec<[f32; 3]> {
        let spread = |row: &[u16]| -> Vec<u16> {
            let pixels = row.chunks_exact(channels);
            let spread = pixels.flat_map(|pixel| [0, 1, 2].map(|c| pixel[c.min(channels - 1)]));
            spread.collect()
        };
        let encoded = match &self.profile {
            Some(profile) if profile.channels() == channels => profile.to_srgb(row),
            Some(profile) => profile.to_srgb(&spread(row)),
            None => spread(row),
        };
        let pixels = encoded.chunks_exact(3);
        let light = pixels.map(|pixel| [0, 1, 2].map(|c| self.light[usize::from(pixel[c])]));
        light.map(|light| self.in_srgb(light)).collect()
    }

    /// The same of floats that are light.
    pub(super) fn of_light(&self, row: &[f32], channels: usize) -> Vec<[f32; 3]> {
        let pixels = row.chunks_exact(channels);
        let light = pixels.map(|pixel| [0, 1, 2].map(|c| bounded(pixel[c.min(channels - 1)])));
        light.map(|light| self.in_srgb(light)).collect()
    }

    fn in_srgb(&self, light: [f32; 3]) -> [f32; 3] {
        match &self.to_srgb {
            None => light,
            Some(rows) => rows.map(|row| row[0] * light[0] + row[1] * light[1] + row[2] * light[2]),
        }
    }
}

/// Infinity, as brightest highlights have it, as a number that a matrix can take.
fn bounded(light: f32) -> f32 {
    const LARGEST_HALF: f32 = 65_504.0;
    light.clamp(-LARGEST_HALF, LARGEST_HALF)
}

fn table(transfer: Transfer, range: Range) -> Vec<f32> {
    let value = |i: u32| (f64::from(i) - range.black) / (range.white - range.black);
    let light = |i: u32| transfer.decode(value(i).clamp(0.0, 1.0)) as f32;
    (0..=65_535).map(light).collect()
}

impl fmt::Debug for Colours {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Colours")
            .field("profile", &self.profile)
            .field("to_srgb", &self.to_srgb)
            .finish_non_exhaustive()
    }
}
