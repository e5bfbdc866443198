//! Times of the wall clock as text.

use jiff::Timestamp;

/// A time, ms since 1970, in UTC, as RFC 3339 has it, to the millisecond.
pub(super) fn utc(time_ms: u64) -> String {
    written(time_ms, "%Y-%m-%dT%H:%M:%S%.3fZ")
}

/// The same for people, to the second.
pub(super) fn utc_seconds(time_ms: u64) -> String {
    written(time_ms, "%Y-%m-%d %H:%M:%S UTC")
}

/// A time in a form; a year beyond 9999 is that of the last moment before it.
fn written(time_ms: u64, form: &str) -> String {
    let ms = i64::try_from(time_ms).unwrap_or(i64::MAX);
    let time = Timestamp::from_millisecond(ms).unwrap_or(Timestamp::MAX);
    time.strftime(form).to_string()
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
        assert!(utc(u64::MAX).starts_with("9999"));
    }
}
