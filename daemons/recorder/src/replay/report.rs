//! Reports of a player.

use std::path::PathBuf;

use maulstick_device::player::Rate;

/// Report of a player.
#[derive(Clone, Debug, PartialEq)]
pub enum ReplayReport {
    /// Where it is, five times a second and after each order.
    Position(Position),
    /// Progress of a guided hand, as often.
    Guiding(Guiding),
    /// The rig goes over to the painting in which a session is painted again.
    Opening {
        /// Its file.
        painting: PathBuf,
    },
    /// The rig has gone over to it.
    Painting {
        /// Its file.
        painting: PathBuf,
    },
}

/// Position of a player.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Time since the beginning of the recording, s.
    pub position_s: f64,
    /// Its length, or the end of what is played, s.
    pub length_s: f64,
    /// Rate.
    pub rate: Rate,
    /// True while it stands still.
    pub paused: bool,
}

/// Progress of a guided hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guiding {
    /// When the recorded hand was where the hand is now, s; `None` between strokes.
    pub position_s: Option<f64>,
    /// Number of strokes.
    pub strokes: usize,
    /// Number of strokes that are traced.
    pub traced: usize,
    /// Strength, 0 to 1.
    pub strength: f64,
    /// True while the hand is let go.
    pub paused: bool,
}
