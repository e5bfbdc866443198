//! `[record]`: a recording of each run.

use std::path::PathBuf;
use std::time::Duration;

use maulstick_types::values::seconds_in;
use serde::{Deserialize, Serialize};

/// Shortest and longest time of which the newest files are kept, s.
const LAST_S: std::ops::RangeInclusive<f64> = 10.0..=1e7;

/// `[record]`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordSection {
    /// Folder of the recordings; it is made if it is absent.
    pub folder: PathBuf,
    /// Most of all recordings of the rig in that folder, MB; without it all are kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quota_mb: Option<u64>,
    /// Newest part of a run that is kept: `30s`, `5m`, `2h`; without it all of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last: Option<String>,
}

/// A text that is not a time, or one out of range.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("last = '{0}'")]
pub struct LastError(pub String);

impl RecordSection {
    /// Time of a run that is kept, if not all of it.
    ///
    /// # Errors
    /// [`LastError`].
    pub fn last(&self) -> Result<Option<Duration>, LastError> {
        let Some(text) = &self.last else {
            return Ok(None);
        };
        let last = seconds_in(text.trim()).filter(|last| LAST_S.contains(last));
        match last {
            Some(seconds) => Ok(Some(Duration::from_secs_f64(seconds))),
            None => Err(LastError(text.clone())),
        }
    }

    /// Checks the values: the key of a wrong one, the error, and advice.
    pub(super) fn check(&self) -> Result<(), (&'static str, String, &'static str)> {
        if self.folder.as_os_str().is_empty() {
            let what = "folder = ''".to_owned();
            return Err((
                "folder",
                what,
                "give a folder, which is made if it is absent",
            ));
        }
        if self.quota_mb == Some(0) {
            let help = "choose 1 MB or more, or leave it out to keep all";
            return Err(("quota_mb", "quota_mb = 0".to_owned(), help));
        }
        self.last().map(drop).map_err(|error| {
            (
                "last",
                error.to_string(),
                "write times as 30s, 5m or 2h: 10 s to 10,000,000 s",
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::UserError;
    use crate::config::{DEFAULT, RigConfig};

    fn parse(lines: &str) -> Result<RecordSection, UserError> {
        let config = RigConfig::parse(&format!("{DEFAULT}\n[record]\n{lines}\n"), "rig.toml");
        Ok(config?.record.expect("a section"))
    }

    #[test]
    fn a_recording_has_a_folder_and_bounds() {
        assert_eq!(RigConfig::default().record, None);
        let section = parse("folder = \"r\"\nquota_mb = 500\nlast = \"5m\"").expect("valid");
        assert_eq!(section.last(), Ok(Some(Duration::from_secs(300))));
        assert_eq!(section.quota_mb, Some(500));
        for (last, seconds) in [("10s", 10), (" 1.5 h", 5400), ("1m", 60)] {
            let section = parse(&format!("folder = \"r\"\nlast = \"{last}\"")).expect(last);
            assert_eq!(section.last(), Ok(Some(Duration::from_secs(seconds))));
        }
    }

    #[test]
    fn a_wrong_value_gets_its_line() {
        let first = DEFAULT.lines().count() + 3;
        for (lines, line) in [
            ("folder = \"\"", 0),
            ("quota_mb = 5", -1),
            ("folder = \"r\"\nquota_mb = 0", 1),
            ("folder = \"r\"\nquota_mb = -1", 1),
            ("folder = \"r\"\nlast = \"5\"", 1),
            ("folder = \"r\"\nlast = \"9s\"", 1),
            ("folder = \"r\"\nlast = \"nanm\"", 1),
            ("folder = \"r\"\nlast = \"é\"", 1),
            ("folder = \"r\"\nlast = \"-5m\"", 1),
            ("folder = \"r\"\nquota = 5", 1),
        ] {
            let fault = parse(lines).expect_err(lines);
            let place = format!("rig.toml:{}", first as i64 + line);
            assert_eq!(fault.place, Some(place), "{fault}");
        }
    }
}
