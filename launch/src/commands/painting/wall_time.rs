//! Times of the wall clock as text.

/// Milliseconds of a day.
const DAY_MS: u64 = 86_400_000;

/// A time, ms since 1970, in UTC, as RFC 3339 has it, to the millisecond.
pub(super) fn utc(time_ms: u64) -> String {
    let [year, month, day] = date(time_ms / DAY_MS);
    let ms = time_ms % DAY_MS;
    let [hour, minute] = [ms / 3_600_000, ms / 60_000 % 60];
    let seconds = ms as f64 % 6e4 / 1e3;
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{seconds:06.3}Z")
}

/// The same for people, to the second.
pub(super) fn utc_seconds(time_ms: u64) -> String {
    let text = utc(time_ms);
    format!("{} UTC", text.replace('T', " ").get(..19).unwrap_or(&text))
}

/// Year, month and day of a day since 1970 (Hinnant, "chrono-compatible low-level date algorithms", `civil_from_days`).
fn date(day: u64) -> [u64; 3] {
    let day = day + 719_468;
    let (era, of_era) = (day / 146_097, day % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let from_march = (5 * of_year + 2) / 153;
    let month = if from_march < 10 {
        from_march + 3
    } else {
        from_march - 9
    };
    let year = era * 400 + year + u64::from(month <= 2);
    [year, month, of_year - (153 * from_march + 2) / 5 + 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_those_of_the_calendar() {
        for (time_ms, text) in [
            (0, "1970-01-01T00:00:00.000Z"),
            (951_782_399_999, "2000-02-28T23:59:59.999Z"),
            (951_782_400_000, "2000-02-29T00:00:00.000Z"),
            (1_735_689_599_000, "2024-12-31T23:59:59.000Z"),
            (4_107_542_400_000, "2100-03-01T00:00:00.000Z"),
        ] {
            assert_eq!(utc(time_ms), text);
        }
        assert_eq!(utc_seconds(951_782_399_999), "2000-02-28 23:59:59 UTC");
    }
}
