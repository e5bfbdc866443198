//! Events of a recorder in words, in lines of JSON, and in the log of the rig.

use maulstick_recorder::{Continuation, CopyTrouble, FileSummary, RecorderEvent};
use maulstick_rig::UserError;
use serde_json::{Value, json};

use crate::commands::{print_json_line, say};

/// Form in which the events of a recorder are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LogFormat {
    Words,
    /// Lines of JSON for programs.
    Json,
    /// The log of the rig.
    Log,
}

impl LogFormat {
    /// Shows an event.
    ///
    /// # Errors
    /// A [`UserError`] where nothing can be printed.
    pub(crate) fn show(self, event: &RecorderEvent) -> Result<(), UserError> {
        let is_full = matches!(
            event,
            RecorderEvent::Continued {
                cause: Continuation::Full,
                ..
            }
        );
        match (self, event) {
            (Self::Json, _) => print_json_line(&in_json(event))?,
            (Self::Words, RecorderEvent::PaintingAttached { .. }) => {}
            (Self::Words, _) if is_full => {}
            (Self::Words, RecorderEvent::Begun { .. }) => {
                say!("{}; Ctrl-C ends it", in_words(event));
            }
            (Self::Words, _) => say!("{}", in_words(event)),
            (Self::Log, RecorderEvent::PaintingAttached { .. } | RecorderEvent::FileEnded(_)) => {
                tracing::debug!("{}", in_words(event))
            }
            (Self::Log, _) if is_full => tracing::debug!("{}", in_words(event)),
            (Self::Log, _) => tracing::info!("{}", in_words(event)),
        }
        Ok(())
    }
}

fn trouble_in_words(trouble: &CopyTrouble) -> String {
    match trouble {
        CopyTrouble::InMemory => "a painting in memory only cannot be copied".to_owned(),
        CopyTrouble::Failed(error) => error.to_string(),
    }
}

fn in_words(event: &RecorderEvent) -> String {
    match event {
        RecorderEvent::Begun { file }
        | RecorderEvent::Continued {
            file,
            cause: Continuation::Full,
        } => format!("recording into {}", file.display()),
        RecorderEvent::Continued {
            file,
            cause: Continuation::JournalBroke,
        } => format!(
            "the painting's journal was interrupted: the paint node restarted, or messages were lost; the recording continues in {}",
            file.display()
        ),
        RecorderEvent::PaintingAttached { file } => format!("{} has the painting", file.display()),
        RecorderEvent::PaintingUnavailable(trouble) => format!(
            "without the painting, {}: until it is recorded, nothing can be painted again from this recording",
            trouble_in_words(trouble)
        ),
        RecorderEvent::FileEnded(FileSummary {
            file,
            messages,
            seconds,
            bytes,
            lost,
            dropped,
            lacks_painting,
        }) => {
            let lack = if *lacks_painting {
                "; without the painting, so it cannot be painted again"
            } else {
                ""
            };
            format!(
                "{}: {messages} messages in {seconds:.1} s, {:.1} MB; {lost} lost, {dropped} dropped here{lack}",
                file.display(),
                *bytes as f64 * 1e-6,
            )
        }
    }
}

fn in_json(event: &RecorderEvent) -> Value {
    match event {
        RecorderEvent::Begun { file }
        | RecorderEvent::Continued {
            file,
            cause: Continuation::Full,
        } => json!({ "recording": file }),
        RecorderEvent::Continued {
            file,
            cause: Continuation::JournalBroke,
        } => json!({ "recording": file, "broke_off": true }),
        RecorderEvent::PaintingAttached { file } => json!({ "has_painting": file }),
        RecorderEvent::PaintingUnavailable(trouble) => {
            json!({ "lacks_painting": trouble_in_words(trouble) })
        }
        RecorderEvent::FileEnded(summary) => json!({
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
