//! The peer: cyclictest of rt-tests, which sleeps to absolute deadlines alone.

use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

use maulstick_rig::UserError;
use serde_json::Value;

use super::fault;
use super::histogram::Histogram;

/// Greatest counted lateness, µs, beyond all reported quantiles.
const MOST_US: u64 = 100_000;

/// Runs it for `ticks` ticks, a millisecond apart, with memory locked and SCHED_FIFO, priority 80.
///
/// # Errors
/// A [`UserError`] where it is not installed or fails.
pub(super) fn run(place: &Path, ticks: u64) -> Result<Histogram, UserError> {
    let json = place.join("cyclictest.json");
    let mut command = Command::new("cyclictest");
    command.args(["-q", "-m", "-p80", "-i1000"]);
    command.args(["-l", &ticks.to_string(), "-h", &MOST_US.to_string()]);
    command.arg(format!("--json={}", json.display()));
    let output = command.output().map_err(|error| match error.kind() {
        ErrorKind::NotFound => {
            UserError::failure("cyclictest, the peer of `lateness`, is not there")
                .help("install rt-tests: sudo apt-get install rt-tests")
        }
        _ => fault(format!("cyclictest cannot be started: {error}")),
    })?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(fault(format!("cyclictest failed: {}", said.trim())));
    }
    let text = std::fs::read_to_string(&json).map_err(|error| UserError::reading(&json, &error))?;
    read(&text, ticks).ok_or_else(|| fault("cyclictest's histogram cannot be read"))
}

/// The histogram of its first thread; ticks that it did not count come after all others.
fn read(text: &str, ticks: u64) -> Option<Histogram> {
    let report: Value = serde_json::from_str(text).ok()?;
    let mut histogram = Histogram::default();
    for (us, ticks) in report["thread"]["0"]["histogram"].as_object()? {
        histogram.add(us.parse().ok()?, ticks.as_u64()?);
    }
    histogram.add(MOST_US, ticks.saturating_sub(histogram.ticks()));
    Some(histogram)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_histogram_is_read_and_what_it_does_not_count_is_late() {
        let text = r#"{ "num_threads": 1, "thread": { "0": {
            "histogram": { "17": 2, "20": 5, "1192": 1 }, "cycles": 8, "min": 17 } } }"#;
        let mut expected = Histogram::default();
        for (us, ticks) in [(17, 2), (20, 5), (1192, 1), (MOST_US, 2)] {
            expected.add(us, ticks);
        }
        assert_eq!(read(text, 10), Some(expected.clone()));
        assert_ne!(read(text, 9), Some(expected), "a tick less would show");
        for wrong in ["", "{}", r#"{"thread":{"0":{"histogram":{"x":1}}}}"#] {
            assert_eq!(read(wrong, 10), None, "{wrong}");
        }
    }
}
