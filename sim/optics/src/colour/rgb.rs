//! Linear light of displays, and its encoding.

use maulstick_num::powf;

use super::adapt::{D50, adaptation, bradford};
use super::matrix::{Matrix, apply, inverse, product};

/// Chromaticity of daylight of 6504 K, the white of both spaces.
pub(super) const D65: [f64; 2] = [0.3127, 0.3290];

/// A colour space with white D65 and the transfer function of sRGB.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RgbSpace {
    /// IEC 61966-2-1.
    #[default]
    Srgb,
    /// The primaries of SMPTE EG 432-1, as of most wide displays.
    DisplayP3,
}

pub(super) fn xyz_of_chromaticity([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

impl RgbSpace {
    /// Chromaticities of red, green and blue.
    pub(super) const fn primaries(self) -> [[f64; 2]; 3] {
        match self {
            Self::Srgb => [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]],
            Self::DisplayP3 => [[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]],
        }
    }

    /// From linear light to XYZ, Y = 1 for white.
    #[must_use]
    pub fn to_xyz(self) -> Matrix {
        let primaries = self.primaries().map(xyz_of_chromaticity);
        let m: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| primaries[j][i]));
        let scale = apply(&inverse(&m), xyz_of_chromaticity(D65));
        m.map(|row| std::array::from_fn(|j| row[j] * scale[j]))
    }

    /// From linear light to the connection space of ICC profiles: XYZ whose white is [`D50`].
    #[must_use]
    pub fn to_pcs(self) -> Matrix {
        product(&bradford(xyz_of_chromaticity(D65), D50), &self.to_xyz())
    }

    /// From the working space, linear sRGB, to linear light of this one.
    #[must_use]
    pub fn from_working(self) -> Matrix {
        match self {
            // The product is the identity, except for rounding.
            Self::Srgb => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            Self::DisplayP3 => product(&inverse(&self.to_xyz()), &Self::Srgb.to_xyz()),
        }
    }
}

/// The matrix from XYZ under a light of white `white_xyz` (Y = 1) to linear sRGB, such that the perfect diffuser is (1,
/// 1, 1): CAT16 adaptation to sRGB's white.
#[must_use]
pub fn xyz_to_linear_srgb(white_xyz: [f64; 3]) -> Matrix {
    let adapt = adaptation(white_xyz, xyz_of_chromaticity(D65));
    product(&inverse(&RgbSpace::Srgb.to_xyz()), &adapt)
}

/// The matrix from XYZ (Y = 1 for the perfect diffuser) to linear sRGB for an eye that is not adapted
/// to the light: its cast stays.
#[must_use]
pub fn linear_srgb_as_it_is() -> Matrix {
    inverse(&RgbSpace::Srgb.to_xyz())
}

/// The sRGB transfer function of one channel in 0..1 (IEC 61966-2-1).
#[must_use]
pub fn srgb_encode(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * powf(linear, 1.0 / 2.4) - 0.055
    }
}

/// Linear light of an sRGB channel; the inverse of [`srgb_encode`].
#[must_use]
pub fn srgb_decode(encoded: f64) -> f64 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        powf((encoded + 0.055) / 1.055, 2.4)
    }
}

/// Maps linear light to sRGB bytes by table; within half a step of [`srgb_encode`].
#[derive(Debug)]
pub struct SrgbTable {
    bytes: Vec<u8>,
}

impl Default for SrgbTable {
    fn default() -> Self {
        let bytes = (0..=65535u32)
            .map(|i| (srgb_encode(f64::from(i) / 65535.0) * 255.0 + 0.5) as u8)
            .collect();
        Self { bytes }
    }
}

impl SrgbTable {
    /// The byte of `linear`, clamped to 0..1; not a number gives 0.
    #[must_use]
    pub fn byte(&self, linear: f32) -> u8 {
        self.bytes[(linear.clamp(0.0, 1.0) * 65535.0 + 0.5) as usize & 0xffff]
    }
}

/// Intervals of [`SrgbCurve`]: a power of two, so that finding one is exact.
const INTERVALS: usize = 1 << 16;

/// Maps linear light to 16-bit sRGB: the transfer function at 2¹⁶ places and straight between them,
/// which is off by less than .06 of a step.
#[derive(Debug)]
pub struct SrgbCurve {
    /// [`srgb_encode`] of i/2¹⁶, times 65535; one more than there are ends.
    nodes: Vec<f32>,
}

impl Default for SrgbCurve {
    fn default() -> Self {
        let node = |i: usize| srgb_encode(i as f64 / INTERVALS as f64) * 65_535.0;
        Self {
            nodes: (0..=INTERVALS + 1).map(|i| node(i) as f32).collect(),
        }
    }
}

impl SrgbCurve {
    /// The value of `linear`, clamped to 0..1; not a number gives 0.
    #[must_use]
    pub fn value(&self, linear: f32) -> u16 {
        let at = linear.clamp(0.0, 1.0) * INTERVALS as f32;
        let below = (at as usize).min(INTERVALS);
        let (low, high) = (self.nodes[below], self.nodes[below + 1]);
        (low + (high - low) * (at - below as f32) + 0.5) as u16
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white_and_srgb_has_its_published_matrix() {
        for white in [[0.950_43, 1.0, 1.0888], [1.098_49, 1.0, 0.355_825]] {
            let rgb = apply(&xyz_to_linear_srgb(white), white);
            assert!(
                rgb.iter().all(|channel| (channel - 1.0).abs() < 1e-12),
                "{rgb:?}"
            );
        }
        let m = xyz_to_linear_srgb(xyz_of_chromaticity(D65));
        assert!(
            (m[0][0] - 3.2406).abs() < 5e-4 && (m[2][2] - 1.0570).abs() < 5e-4,
            "{m:?}"
        );
    }

    #[test]
    fn srgb_bytes_are_those_of_the_formula() {
        let table = SrgbTable::default();
        for i in 0..=100_000u32 {
            let linear = f64::from(i) / 1e5;
            let exact = srgb_encode(linear) * 255.0;
            assert!(
                (f64::from(table.byte(linear as f32)) - exact).abs() < 0.56,
                "{linear}"
            );
        }
        assert_eq!(
            (table.byte(-1.0), table.byte(2.0), table.byte(f32::NAN)),
            (0, 255, 0)
        );
        assert!((srgb_decode(srgb_encode(0.2)) - 0.2).abs() < 1e-12);
    }

    #[test]
    fn sixteen_bits_are_those_of_the_formula() {
        let curve = SrgbCurve::default();
        let worst = |scale: f64| {
            let off = |i: u32| {
                let linear = (f64::from(i) / 1e6) as f32;
                let exact = srgb_encode(f64::from(linear) * scale) * 65_535.0;
                (f64::from(curve.value(linear)) - exact).abs()
            };
            (0..=1_000_000).map(off).fold(0.0, f64::max)
        };
        println!("{:.4} of a step", worst(1.0));
        assert!(worst(1.0) < 0.56);
        assert!(worst(0.9999) > 0.56, "a fault would pass");
        let ends = [-1.0, 0.0, 1.0, 2.0, f32::NAN].map(|linear| curve.value(linear));
        assert_eq!(ends, [0, 0, 65_535, 65_535, 0]);
    }

    #[test]
    fn display_p3_has_its_published_matrix_and_goes_both_ways() {
        // https://www.w3.org/TR/css-color-4/#color-conversion-code, lin_P3_to_XYZ.
        let published = [
            [
                0.486_570_948_648_216,
                0.265_667_693_169_093,
                0.198_217_285_234_362_5,
            ],
            [
                0.228_974_564_069_748_8,
                0.691_738_521_836_506_4,
                0.079_286_914_093_745,
            ],
            [0.0, 0.045_113_381_858_902_6, 1.043_944_368_900_976],
        ];
        let differs = |m: &Matrix| {
            let pairs = m.iter().flatten().zip(published.iter().flatten());
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let m = RgbSpace::DisplayP3.to_xyz();
        assert!(differs(&m) < 1e-12, "{m:?}");
        assert!(
            differs(&RgbSpace::Srgb.to_xyz()) > 1e-3,
            "a fault would pass"
        );
        let there = RgbSpace::DisplayP3.from_working();
        let white = apply(&there, [1.0; 3]);
        assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-12), "{white:?}");
        let red = apply(&inverse(&there), [1.0, 0.0, 0.0]);
        assert!(red[0] > 1.2 && red[1] < -0.04, "{red:?} is outside of sRGB");
        let back = apply(&there, red);
        assert!((back[0] - 1.0).abs() < 1e-12 && back[1].abs() < 1e-12);
    }

    #[test]
    fn white_is_d50_in_the_connection_space() {
        for space in [RgbSpace::Srgb, RgbSpace::DisplayP3] {
            let white = apply(&space.to_pcs(), [1.0; 3]);
            let off = (0..3).map(|i| (white[i] - D50[i]).abs());
            assert!(off.fold(0.0, f64::max) < 1e-12, "{white:?}");
        }
    }
}
