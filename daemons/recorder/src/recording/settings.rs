//! Settings of a recorder.

use std::time::Duration;

/// Number of files into which the time that is kept is divided.
pub(super) const FILES: u32 = 5;
/// Shortest time of which the newest files are kept: each needs time for its painting.
pub const LEAST_LAST: Duration = Duration::from_secs(10);
/// Number of files in a quota.
const QUOTA_FILES: u64 = 8;
/// Longest wait at the end for a copy of a painting, of which the last records may have to be done again.
const LONGEST_COPY: Duration = Duration::from_secs(3600);

/// Division of a recording into files, and which of them are kept.
#[derive(Clone, Copy, Debug, Default)]
pub struct Division {
    /// Most bytes of a file's messages, before they are compressed.
    pub most_bytes: Option<u64>,
    /// Longest time of a file.
    pub after: Option<Duration>,
    /// Time of which the newest files are kept.
    pub last: Option<Duration>,
    /// Most bytes of all files.
    pub quota_bytes: Option<u64>,
}

impl Division {
    pub(super) fn most_of_a_file(&self) -> Option<u64> {
        let of_quota = self.quota_bytes.map(|quota| quota / QUOTA_FILES);
        self.most_bytes.into_iter().chain(of_quota).min()
    }

    pub(super) fn time_of_a_file(&self) -> Option<Duration> {
        self.after.or(self.last.map(|last| last / FILES))
    }
}

/// Settings of a recorder.
#[derive(Clone, Debug)]
pub struct RecorderSettings {
    /// Topics, as a pattern.
    pub topic: String,
    /// Length of the recording, if it has an end of its own.
    pub length: Option<Duration>,
    /// Its files.
    pub division: Division,
    /// Most messages a second of each topic that are written as JSON too; 0 for none.
    pub json_hz: u32,
    /// Longest wait at the end for a copy of the painting that is being made.
    pub longest_wait: Duration,
}

impl Default for RecorderSettings {
    fn default() -> Self {
        Self {
            topic: "**".to_owned(),
            length: None,
            division: Division::default(),
            json_hz: 20,
            longest_wait: LONGEST_COPY,
        }
    }
}
