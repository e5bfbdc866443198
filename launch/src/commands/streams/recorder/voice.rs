//! What a recorder says, to people, to programs, and in the log of the rig.

use std::path::Path;

use maulstick_rig::UserError;
use serde_json::{Value, json};

use crate::commands::{print_json_line, say};

/// How a recorder says what it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Voice {
    /// Lines for people.
    Words,
    /// Lines of JSON for programs.
    Json,
    /// The log of the rig.
    Log,
}

/// What happens to a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RecorderNews<'a> {
    /// The recording begins.
    Begun {
        /// The first file.
        file: &'a Path,
    },
    /// It goes on in another file.
    GoesOn {
        /// The file.
        file: &'a Path,
    },
    /// It goes on in another file, for the journal of the painting broke off.
    BreaksOff {
        /// The file.
        file: &'a Path,
    },
    /// The painting as it was at a file's beginning is in that file.
    HasPainting {
        /// The file.
        file: &'a Path,
    },
    /// The painting cannot be copied at present.
    LacksPainting {
        /// The reason.
        why: &'a str,
    },
    /// A file has ended.
    Ended(Summary<'a>),
}

/// What a file holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Summary<'a> {
    /// The file.
    pub file: &'a Path,
    /// Number of its messages.
    pub messages: u64,
    /// Its length, s.
    pub seconds: f64,
    /// Its size, bytes.
    pub bytes: u64,
    /// Messages that were lost on the way.
    pub lost: u64,
    /// Messages that the recorder was too slow for.
    pub dropped: u64,
    /// True if it has the journal of a painting, but not the painting.
    pub lacks_painting: bool,
}

impl Voice {
    /// Says it.
    ///
    /// # Errors
    /// A [`UserError`] where nothing can be printed.
    pub(super) fn say(self, news: &RecorderNews<'_>) -> Result<(), UserError> {
        match self {
            Self::Json => print_json_line(&news.in_json())?,
            Self::Words => match news {
                RecorderNews::HasPainting { .. } | RecorderNews::GoesOn { .. } => {}
                RecorderNews::Begun { .. } => say!("{}; Ctrl-C ends it", news.in_words()),
                _ => say!("{}", news.in_words()),
            },
            Self::Log => match news {
                RecorderNews::Begun { .. }
                | RecorderNews::BreaksOff { .. }
                | RecorderNews::LacksPainting { .. } => {
                    tracing::info!("{}", news.in_words());
                }
                _ => tracing::debug!("{}", news.in_words()),
            },
        }
        Ok(())
    }
}

impl RecorderNews<'_> {
    fn in_words(&self) -> String {
        match self {
            Self::Begun { file } | Self::GoesOn { file } => {
                format!("recording into {}", file.display())
            }
            Self::BreaksOff { file } => format!(
                "the painting's journal broke off: the paint node began anew, or messages were lost; recording into {}",
                file.display()
            ),
            Self::HasPainting { file } => format!("{} has the painting", file.display()),
            Self::LacksPainting { why } => format!(
                "without the painting, {why}: until it is there, nothing can be painted again from this recording"
            ),
            Self::Ended(Summary {
                file,
                messages,
                seconds,
                bytes,
                lost,
                dropped,
                lacks_painting,
            }) => format!(
                "{}: {messages} messages in {seconds:.1} s, {:.1} MB; {lost} lost, {dropped} dropped here{}",
                file.display(),
                *bytes as f64 * 1e-6,
                match lacks_painting {
                    true => "; without the painting, so it cannot be painted again",
                    false => "",
                }
            ),
        }
    }

    fn in_json(&self) -> Value {
        match self {
            Self::Begun { file } | Self::GoesOn { file } => json!({ "recording": file }),
            Self::BreaksOff { file } => json!({ "recording": file, "broke_off": true }),
            Self::HasPainting { file } => json!({ "has_painting": file }),
            Self::LacksPainting { why } => json!({ "lacks_painting": why }),
            Self::Ended(summary) => json!({
                "ended": summary.file,
                "messages": summary.messages,
                "seconds": summary.seconds,
                "bytes": summary.bytes,
                "lost": summary.lost,
                "dropped": summary.dropped,
                "without_painting": summary.lacks_painting,
            }),
        }
    }
}
