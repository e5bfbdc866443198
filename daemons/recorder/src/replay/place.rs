//! A take replayed at another place: scaled, turned, its middle where it is asked for.

use std::path::Path;

use maulstick_device::{Take, held_brush};
use maulstick_motion::Placement;
use maulstick_motion::strokes::middle;
use maulstick_types::decode;
use maulstick_types::stylus::{StylusPose, StylusSample};

use crate::error::RecorderError;

/// Place of a take on the desk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TakePlace {
    /// Middle of its strokes, mm from the middle of the desk; `None` leaves it where it was.
    pub at_mm: Option<[f64; 2]>,
    /// Factor on its lengths, .01 to 100; pressures stay.
    pub scale: Option<f64>,
    /// Turn, counter-clockwise, degrees.
    pub turn_deg: Option<f64>,
    /// Length of the head that a 6-DOF stylus holds, m; `None` for that of the brush that the take embeds, else of the brush
    /// of a new rig.
    pub head_m: Option<f64>,
}

/// The place of a take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    placement: Placement,
    head_m: f64,
}

impl TakePlace {
    /// The place of the take in a file.
    pub(super) fn of(&self, path: &Path) -> Result<Place, RecorderError> {
        let take = Take::read(path)?;
        let head_m = self.head_m(&take, path)?;
        let from_m = middle(&take.samples, head_m);
        let placement = Placement {
            from_m,
            to_m: self.at_mm.map_or(from_m, |place| place.map(|mm| 1e-3 * mm)),
            scale: self.scale.unwrap_or(1.0),
            turn_rad: self.turn_deg.unwrap_or(0.0).to_radians(),
        };
        // Before the first stroke, not in its midst.
        placement
            .motion(&take.samples, head_m)
            .map_err(|fault| RecorderError::Place {
                fault,
                file: path.to_owned(),
            })?;
        Ok(Place { placement, head_m })
    }

    /// Length of the head, m; 0 where only pens are in the take, whose points are their own.
    fn head_m(&self, take: &Take, path: &Path) -> Result<f64, RecorderError> {
        let is_pen = |pose: &StylusPose| matches!(pose, StylusPose::Contact { .. });
        if take.samples.iter().all(|taken| is_pen(&taken.sample.pose)) {
            return Ok(0.0);
        }
        match self.head_m {
            Some(head_m) => Ok(head_m),
            None => Ok(held_brush(take, path)?.length_m()),
        }
    }
}

impl Place {
    /// The sample of a message there.
    pub(super) fn sample(&self, bytes: &[u8]) -> Result<StylusSample, RecorderError> {
        let (_, sample) =
            decode::<StylusSample>(bytes).map_err(|error| RecorderError::Unreadable {
                what: "a sample cannot be read".to_owned(),
                error: error.into(),
                file: None,
            })?;
        Ok(self.placement.sample(&sample, self.head_m))
    }
}
