//! CIE Lab and CIEDE2000.

use maulstick_num::{atan2, cos, exp, powf, sin};

use super::matrix::Matrix;

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
    let [sl, sc, sh, rt] = scales([mean_l, mean_c, mean_h]);
    let (l, c, h) = (dl / sl, dc / sc, big_dh / sh);
    (l * l + c * c + h * h + rt * c * h).sqrt()
}

/// S_L, S_C, S_H and R_T at a mean lightness, chroma and hue in degrees.
fn scales([mean_l, mean_c, mean_h]: [f64; 3]) -> [f64; 4] {
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
    [sl, sc, sh, rt]
}

/// √(C⁷/(C⁷ + 25⁷)).
fn seventh(c: f64) -> f64 {
    let c7 = powf(c, 7.0);
    (c7 / (c7 + 6_103_515_625.0)).sqrt()
}

/// The matrix W with which CIEDE2000 between `here` and a nearby colour in Lab is the length of W·(difference): of
/// lightness, of chroma, of hue.
#[must_use]
pub fn delta_e_2000_near(here: [f64; 3]) -> Matrix {
    let [l, a, b] = here;
    let stretch = 1.0 + 0.5 * (1.0 - seventh((a * a + b * b).sqrt()));
    let chroma = (a * stretch * a * stretch + b * b).sqrt();
    // Around grey chroma and hue are equivalent.
    let (cosine, sine) = if chroma > 0.0 {
        (a * stretch / chroma, b / chroma)
    } else {
        (1.0, 0.0)
    };
    let hue = if chroma > 0.0 {
        atan2(sine, cosine).to_degrees().rem_euclid(360.0)
    } else {
        0.0
    };
    let [sl, sc, sh, rt] = scales([l, chroma, hue]);
    let along = [0.0, cosine * stretch / sc, sine / sc];
    let across = [0.0, -sine * stretch / sh, cosine / sh];
    // c² + h² + R_T·c·h as a sum of squares; |R_T| < 2.
    let rest = (1.0 - 0.25 * rt * rt).sqrt();
    [
        [1.0 / sl, 0.0, 0.0],
        [0, 1, 2].map(|i| along[i] + 0.5 * rt * across[i]),
        across.map(|value| rest * value),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ciede2000_of_the_published_pairs() {
        for line in include_str!("../../tests/data/ciede2000.csv")
            .lines()
            .skip(2)
        {
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
    fn near_a_colour_the_difference_is_a_length() {
        use super::super::matrix::apply;
        for here in [
            [50.0, 2.0, -3.0],
            [30.0, 20.0, -70.0],
            [80.0, -40.0, 60.0],
            [25.0, 0.0, 0.0],
        ] {
            let near = delta_e_2000_near(here);
            for off in [[1e-3, 0.0, 0.0], [0.0, 1e-3, 5e-4], [3e-4, -7e-4, 9e-4]] {
                let there = [0, 1, 2].map(|i| here[i] + off[i]);
                let exact = delta_e_2000(here, there);
                let seen = apply(&near, off);
                let length = (seen[0] * seen[0] + seen[1] * seen[1] + seen[2] * seen[2]).sqrt();
                println!("{here:?}: {length:e} for {exact:e}");
                assert!((length - exact).abs() < 2e-3 * exact);
                assert!(
                    (1.01 * length - exact).abs() > 2e-3 * exact,
                    "a fault would pass"
                );
            }
        }
    }

    #[test]
    fn lab_of_white_and_of_grey() {
        let white = [0.9504, 1.0, 1.0888];
        assert!((lab(white, white)[0] - 100.0).abs() < 1e-12);
        let grey = lab(white.map(|v| v * 0.184_186_5), white);
        assert!(
            (grey[0] - 50.0).abs() < 1e-4 && grey[1].abs() < 1e-9,
            "{grey:?}"
        );
    }
}
