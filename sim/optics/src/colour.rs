//! XYZ, Lab, ΔE₀₀ and sRGB.

use maulstick_num::{atan2, cos, exp, powf, sin};

type Matrix = [[f64; 3]; 3];

/// CAT16's cone matrix (Li et al. 2017, *Comprehensive color solutions: CAM16, CAT16*).
const CAT16: Matrix = [
    [0.401_288, 0.650_173, -0.051_461],
    [-0.250_268, 1.204_414, 0.045_854],
    [-0.002_079, 0.048_952, 0.953_127],
];

/// Chromaticities of the sRGB primaries and of its white (IEC 61966-2-1).
const SRGB_PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
const SRGB_WHITE: [f64; 2] = [0.3127, 0.3290];

fn times(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let column = |j: usize| times(a, [b[0][j], b[1][j], b[2][j]]);
    let columns = [column(0), column(1), column(2)];
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}

fn inverse(m: &Matrix) -> Matrix {
    let minor = |i: usize, j: usize| {
        let (r, s) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[r][c] * m[s][d] - m[r][d] * m[s][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / determinant))
}

/// The solution x of m·x = v.
pub(crate) fn solve3(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    times(&inverse(m), v)
}

fn xyz_of_chromaticity([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

/// From linear sRGB to XYZ, Y = 1 for its white.
fn srgb_to_xyz() -> Matrix {
    let primaries = SRGB_PRIMARIES.map(xyz_of_chromaticity);
    let m: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| primaries[j][i]));
    let scale = times(&inverse(&m), xyz_of_chromaticity(SRGB_WHITE));
    m.map(|row| std::array::from_fn(|j| row[j] * scale[j]))
}

/// The matrix from XYZ under a light of white `white_xyz` (Y = 1) to linear sRGB, such that the
/// perfect diffuser is (1, 1, 1): CAT16 adaptation to sRGB's white.
#[must_use]
pub fn xyz_to_linear_srgb(white_xyz: [f64; 3]) -> Matrix {
    let from = times(&CAT16, white_xyz);
    let to = times(&CAT16, xyz_of_chromaticity(SRGB_WHITE));
    let scaled: Matrix = std::array::from_fn(|i| CAT16[i].map(|value| value * to[i] / from[i]));
    let adapt = product(&inverse(&CAT16), &scaled);
    product(&inverse(&srgb_to_xyz()), &adapt)
}

/// The matrix from XYZ (Y = 1 for the perfect diffuser) to linear sRGB for an eye that is not adapted
/// to the light: its cast stays.
#[must_use]
pub fn linear_srgb_as_it_is() -> Matrix {
    inverse(&srgb_to_xyz())
}

/// Applies a colour matrix.
#[must_use]
pub fn apply(matrix: &Matrix, colour: [f64; 3]) -> [f64; 3] {
    times(matrix, colour)
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

/// Brings colours outside the display's gamut onto its edge along the line to white
/// (Baxter 2004, § 7.8.1, with the chromaticity min(RGB)/sum that its pseudocode means).
#[must_use]
pub fn clamp_chromaticity(rgb: [f32; 3]) -> [f32; 3] {
    let least = rgb[0].min(rgb[1]).min(rgb[2]);
    if least >= 0.0 {
        return rgb;
    }
    let sum = rgb[0] + rgb[1] + rgb[2];
    if sum <= 0.0 {
        return [0.0; 3];
    }
    let third = 1.0 / 3.0;
    let t = third / (third - least / sum);
    rgb.map(|channel| ((third + t * (channel / sum - third)) * sum).max(0.0))
}

/// CIE 1976 L*a*b* relative to `white` (both Y = 1 for the perfect diffuser).
#[must_use]
pub fn lab(xyz: [f64; 3], white: [f64; 3]) -> [f64; 3] {
    const EDGE: f64 = 216.0 / 24389.0;
    let f = |t: f64| {
        if t > EDGE {
            powf(t, 1.0 / 3.0)
        } else {
            (24389.0 / 27.0 * t + 16.0) / 116.0
        }
    };
    let [x, y, z]: [f64; 3] = std::array::from_fn(|i| f(xyz[i] / white[i]));
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// CIEDE2000 of two Lab colours, k_L = k_C = k_H = 1 (Sharma, Wu and Dalal 2005).
#[must_use]
pub fn delta_e_2000(one: [f64; 3], two: [f64; 3]) -> f64 {
    let degrees = |y: f64, x: f64| {
        if x == 0.0 && y == 0.0 {
            0.0
        } else {
            atan2(y, x).to_degrees().rem_euclid(360.0)
        }
    };
    let chroma = |a: f64, b: f64| (a * a + b * b).sqrt();
    let seventh = |c: f64| {
        let c7 = powf(c, 7.0);
        (c7 / (c7 + 6_103_515_625.0)).sqrt()
    };
    let mean_c = 0.5 * (chroma(one[1], one[2]) + chroma(two[1], two[2]));
    let stretch = 1.0 + 0.5 * (1.0 - seventh(mean_c));
    let polar = |lab: [f64; 3]| {
        let a = lab[1] * stretch;
        (chroma(a, lab[2]), degrees(lab[2], a))
    };
    let ((c1, h1), (c2, h2)) = (polar(one), polar(two));
    let grey = c1 * c2 == 0.0;
    let dl = two[0] - one[0];
    let dc = c2 - c1;
    let mut dh = h2 - h1;
    if grey {
        dh = 0.0;
    } else if dh > 180.0 {
        dh -= 360.0;
    } else if dh < -180.0 {
        dh += 360.0;
    }
    let big_dh = 2.0 * (c1 * c2).sqrt() * sin(0.5 * dh.to_radians());
    let mean_l = 0.5 * (one[0] + two[0]);
    let mean_c = 0.5 * (c1 + c2);
    let mean_h = if grey {
        h1 + h2
    } else if (h1 - h2).abs() <= 180.0 {
        0.5 * (h1 + h2)
    } else if h1 + h2 < 360.0 {
        0.5 * (h1 + h2 + 360.0)
    } else {
        0.5 * (h1 + h2 - 360.0)
    };
    let cosine = |factor: f64, shift: f64| cos((factor * mean_h + shift).to_radians());
    let t = 1.0 - 0.17 * cosine(1.0, -30.0) + 0.24 * cosine(2.0, 0.0) + 0.32 * cosine(3.0, 6.0)
        - 0.20 * cosine(4.0, -63.0);
    let spread = (mean_h - 275.0) / 25.0;
    let rotation = 60.0 * exp(-spread * spread);
    let off = (mean_l - 50.0) * (mean_l - 50.0);
    let sl = 1.0 + 0.015 * off / (20.0 + off).sqrt();
    let sc = 1.0 + 0.045 * mean_c;
    let sh = 1.0 + 0.015 * mean_c * t;
    let rt = -2.0 * seventh(mean_c) * sin(rotation.to_radians());
    let (l, c, h) = (dl / sl, dc / sc, big_dh / sh);
    (l * l + c * c + h * h + rt * c * h).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ciede2000_of_the_published_pairs() {
        for line in include_str!("../tests/data/ciede2000.csv").lines().skip(2) {
            let v: Vec<f64> = line
                .split(',')
                .map(|cell| cell.parse().expect("a number"))
                .collect();
            let got = delta_e_2000([v[0], v[1], v[2]], [v[3], v[4], v[5]]);
            let back = delta_e_2000([v[3], v[4], v[5]], [v[0], v[1], v[2]]);
            println!("{got:.4} expected {:.4}", v[6]);
            assert!((got - v[6]).abs() < 1e-4 && (got - back).abs() < 1e-9);
            assert!((got + 1e-3 - v[6]).abs() > 1e-4, "a fault would pass");
        }
    }

    #[test]
    fn white_stays_white_and_srgb_has_its_published_matrix() {
        for white in [[0.950_43, 1.0, 1.0888], [1.098_49, 1.0, 0.355_825]] {
            let rgb = apply(&xyz_to_linear_srgb(white), white);
            assert!(
                rgb.iter().all(|channel| (channel - 1.0).abs() < 1e-12),
                "{rgb:?}"
            );
        }
        let m = xyz_to_linear_srgb(xyz_of_chromaticity(SRGB_WHITE));
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
    fn the_clamp_keeps_what_is_inside_and_leads_the_rest_to_the_edge() {
        assert_eq!(clamp_chromaticity([0.2, 0.5, 1.7]), [0.2, 0.5, 1.7]);
        assert_eq!(clamp_chromaticity([-0.2, 0.1, 0.05]), [0.0; 3]);
        let clamped = clamp_chromaticity([-0.1, 0.5, 0.3]);
        assert_eq!(clamped[0], 0.0);
        assert!((clamped.iter().sum::<f32>() - 0.7).abs() < 1e-6);
        assert!(
            clamped[1] > clamped[2],
            "the order of channels, and with it the hue, holds"
        );
    }

    #[test]
    fn lab_of_white_and_of_grey() {
        let white = [0.9504, 1.0, 1.0888];
        assert!(lab(white, white)[0] - 100.0 < 1e-12);
        let grey = lab(white.map(|v| v * 0.184_186_5), white);
        assert!(
            (grey[0] - 50.0).abs() < 1e-4 && grey[1].abs() < 1e-9,
            "{grey:?}"
        );
    }
}
