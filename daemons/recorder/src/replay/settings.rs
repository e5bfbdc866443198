//! Settings of a player.

use std::collections::BTreeMap;
use std::path::PathBuf;

use maulstick_device::player::Rate;
use maulstick_rig::NodeHandle;

use super::place::TakePlace;
use crate::error::RecorderError;
use crate::work::StopRequest;

/// Settings of a player.
#[derive(Clone, Debug)]
pub struct ReplaySettings {
    /// Recording, or take.
    pub recording: PathBuf,
    /// Rate.
    pub rate: Rate,
    /// Beginning of what is played, s after that of the recording.
    pub start_s: f64,
    /// End of what is played, s after the beginning of the recording; `None` plays to its end.
    pub end_s: Option<f64>,
    /// True if it begins anew at the end.
    pub repeats: bool,
    /// True if it begins paused.
    pub paused: bool,
    /// Patterns of the topics whose messages are sent again; where there are none a session is painted again, and of any
    /// other recording the samples of the hands are sent.
    pub topics: Vec<String>,
    /// Topics that are sent under another name, by the recorded one.
    pub renamed: BTreeMap<String, String>,
    /// Device as which samples of a stylus are sent.
    pub device: Option<String>,
    /// Device whose hand the recorded contact models move.
    pub drive: Option<String>,
    /// Guidance of a hand along the recorded strokes; nothing is played then.
    pub guide: Option<GuideSettings>,
    /// Place of a take on the desk; `None` leaves it where it was.
    pub place: Option<TakePlace>,
    /// Painting to write, in which a session is painted again; `None` names it after the recording.
    pub document: Option<PathBuf>,
    /// True if the current painting may go although it is in memory only.
    pub forget: bool,
}

/// Guidance of a hand.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideSettings {
    /// Device that the hand holds.
    pub device: String,
    /// Strength, 0 to 1.
    pub strength: f64,
}

impl ReplaySettings {
    /// Settings that play all of a recording, or a take, at the pace at which it was recorded.
    #[must_use]
    pub fn new(recording: impl Into<PathBuf>) -> Self {
        Self {
            recording: recording.into(),
            rate: Rate::Times(1.0),
            start_s: 0.0,
            end_s: None,
            repeats: false,
            paused: false,
            topics: Vec::new(),
            renamed: BTreeMap::new(),
            device: None,
            drive: None,
            guide: None,
            place: None,
            document: None,
            forget: false,
        }
    }

    /// Beginning and end of what is played of a recording of this length, ns.
    pub(super) fn range_ns(&self, length_ns: u64) -> Result<[u64; 2], RecorderError> {
        let length_s = length_ns as f64 * 1e-9;
        let end_s = self.end_s.unwrap_or(length_s);
        let start_s = self.start_s;
        if !(start_s >= 0.0 && start_s < end_s && start_s < length_s) {
            return Err(RecorderError::Start {
                start: start_s.to_string(),
                length: format!("{length_s:.1}"),
                file: self.recording.clone(),
            });
        }
        Ok([
            (start_s * 1e9) as u64,
            ((end_s * 1e9) as u64).min(length_ns),
        ])
    }

    /// True if messages are sent again, whatever the recording holds.
    pub(super) fn sends(&self) -> bool {
        !self.topics.is_empty()
            || self.device.is_some()
            || self.drive.is_some()
            || self.place.is_some()
    }
}

/// Call of a player.
pub(super) struct Call {
    pub(super) settings: ReplaySettings,
    pub(super) rig: String,
    pub(super) request: StopRequest,
}

impl Call {
    /// Joins the rig.
    pub(super) fn join(&self) -> Result<NodeHandle, RecorderError> {
        self.request.clone().join(&self.rig, "replay")
    }
}
