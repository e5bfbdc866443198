//! Interpretation of a picture's numbers without an ICC profile: a transfer function, and the chromaticities of
//! primaries and white.
//!
//! Codes and formulas are those of ITU-T H.273 (07/2024), tables 2 and 3, which PNG's chunk cICP gives; gAMA and cHRM
//! of PNG, chromaticities of OpenEXR and TIFF are the same without codes.

use maulstick_num::{exp, powf};

use super::adapt::bradford;
use super::matrix::{Matrix, apply, inverse, product};
use super::rgb::{D65, RgbSpace, srgb_decode, xyz_of_chromaticity};

/// Light of a diffuse white in pictures of high dynamic range, cd/m² (ITU-R BT.2408, § 2.2).
const DIFFUSE_WHITE: f64 = 203.0;
/// The signal of that white in hybrid log-gamma (ibid.).
const HLG_WHITE: f64 = 0.75;
/// Chromaticities that differ by less than this are the same: files have them in hundred thousandths, or in f32.
const CHROMATICITY_TOLERANCE: f64 = 1e-5;
/// Entries of a matrix beyond this one are of primaries that span hardly anything.
const MOST_ENTRY: f64 = 100.0;

/// From the numbers of a channel, 0 to 1, to light; 1 is white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transfer {
    /// Linear light.
    Linear,
    /// Light is a power of them.
    Power(f64),
    /// IEC 61966-2-1.
    Srgb,
    /// ITU-R BT.709, as BT.601 and BT.2020 have it too.
    Bt709,
    /// SMPTE ST 240.
    Smpte240,
    /// A logarithm over a number of decades, 0 below.
    Logarithm(f64),
    /// SMPTE ST 428-1, of digital cinema.
    Smpte428,
    /// Perceptual quantiser, SMPTE ST 2084.
    Quantiser,
    /// Hybrid log-gamma, ITU-R BT.2100: light of the scene.
    HybridLogGamma,
}

impl Transfer {
    /// The transfer function of a code of H.273, table 3; `None` for a reserved one.
    #[must_use]
    pub fn of_code(code: u8) -> Option<Self> {
        Some(match code {
            // 11 and 12 differ from it outside of 0 to 1 alone.
            1 | 6 | 11 | 12 | 14 | 15 => Self::Bt709,
            4 => Self::Power(2.2),
            5 => Self::Power(2.8),
            7 => Self::Smpte240,
            8 => Self::Linear,
            9 => Self::Logarithm(2.0),
            10 => Self::Logarithm(2.5),
            13 => Self::Srgb,
            16 => Self::Quantiser,
            17 => Self::Smpte428,
            18 => Self::HybridLogGamma,
            _ => return None,
        })
    }

    /// Light of a number; beyond 1 where the picture has more light than a diffuse white.
    #[must_use]
    pub fn decode(self, value: f64) -> f64 {
        let toe = |end: f64, slope: f64, above: f64| {
            if value < slope * end {
                value / slope
            } else {
                powf((value + above - 1.0) / above, 1.0 / 0.45)
            }
        };
        match self {
            Self::Linear => value,
            Self::Power(exponent) => powf(value.max(0.0), exponent),
            Self::Srgb => srgb_decode(value),
            Self::Bt709 => toe(0.018_053_968_510_807, 4.5, 1.099_296_826_809_442),
            Self::Smpte240 => toe(0.022_821_585_529_445, 4.0, 1.111_572_195_921_731),
            Self::Logarithm(decades) => {
                if value > 0.0 {
                    powf(10.0, decades * (value - 1.0))
                } else {
                    0.0
                }
            }
            Self::Smpte428 => powf(value.max(0.0), 2.6) * 52.37 / 48.0,
            Self::Quantiser => quantised(value) * 10_000.0 / DIFFUSE_WHITE,
            Self::HybridLogGamma => hybrid(value) / hybrid(HLG_WHITE),
        }
    }
}

/// SMPTE ST 2084, eq. 4.1; 1 is 10,000 cd/m².
fn quantised(value: f64) -> f64 {
    const M1: f64 = 2610.0 / 16_384.0;
    const M2: f64 = 128.0 * 2523.0 / 4096.0;
    const C1: f64 = 3424.0 / 4096.0;
    const C2: f64 = 32.0 * 2413.0 / 4096.0;
    const C3: f64 = 32.0 * 2392.0 / 4096.0;
    let root = powf(value.max(0.0), 1.0 / M2);
    powf((root - C1).max(0.0) / (C2 - C3 * root), 1.0 / M1)
}

/// ITU-R BT.2100, table 5, inverse; 1 is the most light of the scene.
fn hybrid(value: f64) -> f64 {
    const A: f64 = 0.178_832_77;
    const B: f64 = 1.0 - 4.0 * A;
    const C: f64 = 0.559_910_73;
    if value <= 0.5 {
        value * value / 3.0
    } else {
        (exp((value - C) / A) + B) / 12.0
    }
}

/// Chromaticities x, y of red, green, blue and white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chromaticities {
    /// Red, green and blue.
    pub primaries: [[f64; 2]; 3],
    /// White.
    pub white: [f64; 2],
}

impl Chromaticities {
    /// Chromaticities of sRGB.
    pub const SRGB: Self = Self {
        primaries: RgbSpace::Srgb.primaries(),
        white: D65,
    };

    /// Chromaticities of a code of H.273, table 2; `None` for a reserved one.
    #[must_use]
    pub fn of_code(code: u8) -> Option<Self> {
        const C: [f64; 2] = [0.310, 0.316];
        let of = |red, green, blue, white| {
            Some(Self {
                primaries: [red, green, blue],
                white,
            })
        };
        match code {
            1 => Some(Self::SRGB),
            4 => of([0.67, 0.33], [0.21, 0.71], [0.14, 0.08], C),
            5 => of([0.64, 0.33], [0.29, 0.60], [0.15, 0.06], D65),
            6 | 7 => of([0.630, 0.340], [0.310, 0.595], [0.155, 0.070], D65),
            8 => of([0.681, 0.319], [0.243, 0.692], [0.145, 0.049], C),
            9 => of([0.708, 0.292], [0.170, 0.797], [0.131, 0.046], D65),
            10 => of([1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0; 2]),
            11 => of(
                [0.680, 0.320],
                [0.265, 0.690],
                [0.150, 0.060],
                [0.314, 0.351],
            ),
            12 => Some(Self {
                primaries: RgbSpace::DisplayP3.primaries(),
                white: D65,
            }),
            22 => of([0.630, 0.340], [0.295, 0.605], [0.155, 0.077], D65),
            _ => None,
        }
    }

    /// The matrix from linear light to XYZ, Y = 1 for white.
    #[must_use]
    pub fn to_xyz(&self) -> Matrix {
        let columns = self.primaries.map(|[x, y]| [x, y, 1.0 - x - y]);
        let m: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]));
        let scale = apply(&inverse(&m), xyz_of_chromaticity(self.white));
        m.map(|row| std::array::from_fn(|j| row[j] * scale[j]))
    }

    /// True for those of sRGB, as files have them.
    #[must_use]
    pub fn is_srgb(&self) -> bool {
        let all = |own: &Self| [own.primaries.as_flattened(), &own.white].concat();
        let mut pairs = all(self).into_iter().zip(all(&Self::SRGB));
        pairs.all(|(one, other)| (one - other).abs() < CHROMATICITY_TOLERANCE)
    }

    /// The matrix from linear light to that of sRGB, whose white is white (Bradford); the identity for
    /// sRGB's own. `None` where primaries and white span no gamut.
    #[must_use]
    pub fn to_srgb(&self) -> Option<Matrix> {
        if self.is_srgb() {
            return Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        }
        let [own, d65] = [self.white, D65].map(xyz_of_chromaticity);
        let adapted = bradford(own, d65);
        let from_xyz = inverse(&Self::SRGB.to_xyz());
        let matrix = product(&from_xyz, &product(&adapted, &self.to_xyz()));
        // NaN is not within either.
        let is_sound = matrix.iter().flatten().all(|v| v.abs() < MOST_ENTRY);
        is_sound.then_some(matrix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::srgb_encode;

    #[test]
    fn transfer_functions_have_their_published_values() {
        for (transfer, value, light) in [
            (Transfer::Linear, 0.25, 0.25),
            (Transfer::Power(2.2), 0.5, 0.217_637_6),
            (Transfer::Srgb, 0.5, 0.214_041_1),
            // The camera's curve at 18 % grey is .409.
            (Transfer::Bt709, 0.408_848_1, 0.18),
            (Transfer::Bt709, 0.045, 0.01),
            (Transfer::Smpte240, 0.04, 0.01),
            (Transfer::Logarithm(2.0), 0.5, 0.1),
            // ITU-R BT.2408, table 1: diffuse white is a signal of 58 % and of 75 %.
            (Transfer::Quantiser, 0.580_689, 1.0),
            (Transfer::Quantiser, 1.0, 10_000.0 / 203.0),
            (Transfer::HybridLogGamma, 0.75, 1.0),
            (Transfer::HybridLogGamma, 0.5, (1.0 / 12.0) / 0.264_963),
            (Transfer::Smpte428, 1.0, 1.091_042),
        ] {
            let got = transfer.decode(value);
            println!("{transfer:?} {value}: {got}, expected {light}");
            assert!((got / light - 1.0).abs() < 1e-4);
            assert!((transfer.decode(value * 0.99) / light - 1.0).abs() > 1e-3);
        }
        for code in 0..=u8::MAX {
            let Some(transfer) = Transfer::of_code(code) else {
                continue;
            };
            let values = [0.0, 1e-3, 0.02, 0.08, 0.2, 0.5, 0.8, 1.0].map(|v| transfer.decode(v));
            assert!(values.windows(2).all(|two| two[0] < two[1]), "{code}");
            assert!(values[0].abs() < 1e-2 && values[7] > 0.99, "{code}");
        }
        assert_eq!(Transfer::of_code(2), None);
    }

    #[test]
    fn primaries_come_into_srgb_with_their_white() {
        for code in 0..=u8::MAX {
            let Some(own) = Chromaticities::of_code(code) else {
                continue;
            };
            let to_srgb = own.to_srgb().expect("a gamut");
            let white = apply(&to_srgb, [1.0; 3]);
            println!("{code}: {white:?}");
            assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-9));
        }
        // sRGB's green is Display P3's (117, 251, 76).
        let wide = Chromaticities::of_code(12).expect("known");
        let light = [117.0, 251.0, 76.0].map(|byte: f64| srgb_decode(byte / 255.0));
        let green = apply(&wide.to_srgb().expect("a gamut"), light).map(srgb_encode);
        println!("{green:?}");
        assert!(green[0] < 0.05 && green[1] > 0.99 && green[2] < 0.05);
        // BT.2020's matrix into BT.709 is published in ITU-R BT.2407, § 2.2.
        let m = Chromaticities::of_code(9).and_then(|own| own.to_srgb());
        let m = m.expect("a gamut");
        assert!((m[0][0] - 1.6605).abs() < 1e-3 && (m[1][0] + 0.1246).abs() < 1e-3);
        for [x, y] in [[0.3, 0.3], [f64::NAN, 0.3], [0.0, 0.0]] {
            let none = Chromaticities {
                primaries: [[x, y]; 3],
                white: D65,
            };
            assert_eq!(none.to_srgb(), None);
        }
        let dark = Chromaticities {
            white: [0.3, 0.0],
            ..Chromaticities::SRGB
        };
        assert_eq!(dark.to_srgb(), None);
    }
}
