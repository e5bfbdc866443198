//! A fit as a paint file, which [`maulstick_optics::PaintLibrary::parse`] reads.

use std::fmt::Write as _;

use maulstick_optics::Paint;
use maulstick_optics::paints::WHITE_S_PER_M;
use maulstick_optics::spectrum::{SAMPLES, wavelength};

use crate::fit::Fit;

/// Text of the file. K and S are in units of [`WHITE_S_PER_M`], six digits: the white's S is 1 where only ratios were
/// measured, and otherwise that of the drawdowns, so that films of the painting are as thick as those.
#[must_use]
pub fn paint_file(fit: &Fit) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let mut line = |words: std::fmt::Arguments<'_>| {
        text.write_fmt(words).ok();
        text.push('\n');
    };
    line(format_args!(
        "# Kubelka-Munk absorption K and scattering S of paints, in units of {WHITE_S_PER_M} per metre."
    ));
    line(format_args!("# reference white: {}", fit.white));
    match fit.white_s_per_m {
        Some(s) => line(format_args!(
            "# white S per m: {s:.0} (mean over the spectrum, from drawdowns)"
        )),
        None => line(format_args!(
            "# white S per m: {WHITE_S_PER_M} (taken; no drawdowns were measured)"
        )),
    }
    line(format_args!(
        "# residuals of {} samples: mean ΔE00 {:.2}, worst {:.2}",
        fit.residuals.len(),
        fit.mean(),
        fit.worst()
    ));
    let grid: Vec<String> = (0..SAMPLES).map(|i| format!("{}", wavelength(i))).collect();
    line(format_args!(
        "paint,colour_index,source,quantity,{}",
        grid.join(",")
    ));
    for paint in &fit.paints {
        for (quantity, values) in [("K", &paint.k), ("S", &paint.s)] {
            let Paint {
                name,
                colour_index,
                source,
                ..
            } = paint;
            let cells: Vec<String> = values.0.iter().map(|v| digits(v / WHITE_S_PER_M)).collect();
            line(format_args!(
                "{name},{colour_index},{source},{quantity},{}",
                cells.join(",")
            ));
        }
    }
    text
}

/// Six significant digits.
fn digits(value: f64) -> String {
    let rounded = format!("{value:.5e}");
    rounded
        .parse::<f64>()
        .map_or(rounded, |value| value.to_string())
}

#[cfg(test)]
mod tests {
    #[test]
    fn six_digits_are_kept_over_all_decades() {
        let digits = super::digits;
        assert_eq!(digits(1.0), "1");
        assert_eq!(digits(0.123_456_789), "0.123457");
        assert_eq!(digits(3.377_243_1e-6), "0.00000337724");
        assert_eq!(digits(12.345_678_9), "12.3457");
    }
}
