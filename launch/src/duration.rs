//! Times as a painter writes them.

use maulstick_painting::clock::TICKS_A_SECOND;
use maulstick_types::command::DRYING_TICKS;

/// Units and how many seconds they have.
const UNITS: [(&str, f64); 6] = [
    ("ms", 1e-3),
    ("s", 1.0),
    ("min", 60.0),
    ("m", 60.0),
    ("h", 3600.0),
    ("d", 86_400.0),
];

/// Reads a time such as `90s`, `20min`, `2h`, in ticks of 1/60 s: one at least, a year at most.
///
/// # Errors
/// The error, in words.
pub fn ticks_in(text: &str) -> Result<u32, String> {
    let wrong = || format!("'{text}' is no time; give one such as 90s, 20min or 2h, up to 365d");
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = &text[digits.len()..];
    let seconds = UNITS.iter().find(|(name, _)| *name == unit);
    let (_, seconds) = seconds.ok_or_else(wrong)?;
    let count: f64 = digits.trim().parse().map_err(|_| wrong())?;
    let ticks = (count * seconds * f64::from(TICKS_A_SECOND)).round();
    let range = f64::from(*DRYING_TICKS.start())..=f64::from(*DRYING_TICKS.end());
    match range.contains(&ticks) {
        true => Ok(ticks as u32),
        false => Err(wrong()),
    }
}

/// Duration of so many ticks, ns.
#[must_use]
pub fn time_ns(ticks: u32) -> u64 {
    u64::from(ticks) * 1_000_000_000 / u64::from(TICKS_A_SECOND)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_or_refused() {
        let good = [
            ("90s", 5400),
            ("1.5 min", 5400),
            ("2h", 432_000),
            ("50ms", 3),
            ("1m", 3600),
        ];
        for (text, ticks) in good {
            assert_eq!(ticks_in(text), Ok(ticks), "{text}");
        }
        for text in [
            "", "90", "s", "-1s", "0s", "NaNs", "infs", "2y", "366d", "1e99d",
        ] {
            assert!(
                ticks_in(text).is_err_and(|what| what.contains("90s")),
                "{text}"
            );
        }
    }
}
