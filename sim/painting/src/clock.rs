//! Ticks of a painting, and the dryings that they drive.

use maulstick_types::Region;
pub use maulstick_types::values::TICKS_A_SECOND;
use serde::{Deserialize, Serialize};

/// Most rounds of a drying, and the fewest ticks of one.
const ROUNDS: u32 = 32;
const ROUND_TICKS: u32 = 30;
/// Number of ticks after its last contact for which a brush counts as painting, .2 s: contacts less than 150 ms apart
/// are one stroke.
const LIFTED_TICKS: u32 = 12;
/// Ticks for which a brush in contact counts as painting although no state arrives.
const STILL_TICKS: u32 = 120;

/// A drying in progress.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drying {
    /// The surface.
    pub surface: u32,
    /// The part of it; all if absent.
    pub region: Option<Region>,
    /// Name for its layer; its number if empty.
    pub name: String,
    /// Number of its layer, once something has dried into it.
    pub layer: Option<u32>,
    /// Duration, ticks.
    pub ticks: u32,
    /// Ticks elapsed.
    pub elapsed: u32,
    /// Ticks elapsed when its newest round began.
    pub reached: u32,
    /// The round that is not done.
    pub round: Option<Round>,
}

/// A walk over the tiles of a drying: each dries by the share of the time from `from` to the end that
/// had gone by at `to`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Round {
    /// First tick.
    pub from: u32,
    /// Last tick.
    pub to: u32,
    /// Index of the next tile, row after row from the bottom.
    pub next: u32,
}

impl Drying {
    /// The round that is due now.
    pub(crate) fn due(&self) -> Option<Round> {
        let least = (self.ticks / ROUNDS).max(ROUND_TICKS);
        let is_due = self.elapsed >= self.ticks || self.elapsed - self.reached >= least;
        let next = Round {
            from: self.reached,
            to: self.elapsed,
            next: 0,
        };
        self.round.or_else(|| is_due.then_some(next))
    }

    /// The share of a film that dries in a round.
    pub(crate) fn share(&self, round: Round) -> f32 {
        match self.ticks.saturating_sub(round.from) {
            0 => 1.0,
            left => ((round.to - round.from) as f32 / left as f32).min(1.0),
        }
    }
}

/// Progress of the dryings, as a document saves it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Ticks since the painting began.
    pub ticks: u64,
    /// Ticks since a brush was last in contact.
    pub quiet: u32,
    /// Dryings in progress, at most one a surface.
    pub dryings: Vec<Drying>,
}

impl Clock {
    /// Advances by a tick. Returns the rounds that are due, by surface: none while a brush paints, so that no tile
    /// dries under it, and no stroke is split.
    pub(crate) fn tick(&mut self, in_contact: bool) -> Vec<(u32, Round)> {
        self.ticks += 1;
        self.quiet = self.quiet.saturating_add(1);
        for drying in &mut self.dryings {
            drying.elapsed = (drying.elapsed + 1).min(drying.ticks);
        }
        let patience = if in_contact {
            STILL_TICKS
        } else {
            LIFTED_TICKS
        };
        if self.quiet < patience {
            return Vec::new();
        }
        let dryings = self.dryings.iter();
        let due = dryings.filter_map(|drying| Some((drying.surface, drying.due()?)));
        due.collect()
    }

    /// Ends the drying of a surface, or of all surfaces: paint that is still wet stays wet. True if any ended.
    pub(crate) fn stop(&mut self, surface: Option<u32>) -> bool {
        let count = self.dryings.len();
        let stays = |drying: &Drying| surface.is_some_and(|surface| drying.surface != surface);
        self.dryings.retain(stays);
        self.dryings.len() < count
    }
}
