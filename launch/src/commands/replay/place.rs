//! A take replayed at another place: scaled, turned, its middle where it is asked for.

use std::path::Path;

use clap::Args;
use maulstick_device::Take;
use maulstick_motion::Placement;
use maulstick_motion::strokes::middle;
use maulstick_rig::UserError;
use maulstick_types::decode;
use maulstick_types::stylus::StylusSample;

use crate::commands::motion::{HeadOptions, parse_place, refused};

/// Where a take is put.
#[derive(Args, Clone, Copy, Debug)]
pub(super) struct PlaceOptions {
    /// Put the middle of a take's strokes here, mm from the middle of the desk [default: where it was]
    #[arg(long, value_name = "X,Y", value_parser = parse_place, allow_hyphen_values = true)]
    at: Option<[f64; 2]>,
    /// Scale a take by this, .01 to 100; pressures stay [default: 1]
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true)]
    scale: Option<f64>,
    /// Turn a take by this, degrees, counter-clockwise [default: 0]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    turn: Option<f64>,
    #[command(flatten)]
    head: HeadOptions,
}

/// The place of a take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    placement: Placement,
    head_m: f64,
}

impl PlaceOptions {
    /// True if a take is put elsewhere.
    pub(super) fn is_given(&self) -> bool {
        self.at.is_some() || self.scale.is_some() || self.turn.is_some()
    }

    /// The place of the take in a file; `None` if it stays where it was.
    pub(super) fn of(&self, path: &Path) -> Result<Option<Place>, UserError> {
        if !self.is_given() {
            return Ok(None);
        }
        let take = Take::read(path)?;
        let head_m = self.head.length_m(&take, path)?;
        let from_m = middle(&take.samples, head_m);
        let placement = Placement {
            from_m,
            to_m: self.at.map_or(from_m, |place| place.map(|mm| 1e-3 * mm)),
            scale: self.scale.unwrap_or(1.0),
            turn_rad: self.turn.unwrap_or(0.0).to_radians(),
        };
        // Before the first stroke, not in its midst.
        placement
            .motion(&take.samples, head_m)
            .map_err(refused(path))?;
        Ok(Some(Place { placement, head_m }))
    }
}

impl Place {
    /// The sample of a message there.
    pub(super) fn sample(&self, bytes: &[u8]) -> Result<StylusSample, UserError> {
        let (_, sample) = decode::<StylusSample>(bytes).map_err(|error| {
            UserError::usage(format!("a sample cannot be read: {error}"))
                .help("play it with the version of Maulstick that recorded it")
        })?;
        Ok(self.placement.sample(&sample, self.head_m))
    }
}
