//! Moves, turns or zooms a surface.

use serde::de::{Deserialize, Deserializer, Error};

use crate::Pose;
use crate::edits::{Form, StepForm};
use crate::limits::FARTHEST_M;
use crate::scene::CANVAS;
use crate::values::{ValueError, Zoom};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Move, turn or zoom a surface
    pub struct Place {
        /// The surface.
        pub surface: u32,
        /// Surface frame to desk frame; within reach.
        #[serde(deserialize_with = "near")]
        pub pose: Pose,
        /// Desk lengths per surface length.
        pub zoom: Zoom,
    }
}

impl Place {
    /// Puts a surface there.
    ///
    /// # Errors
    /// [`ValueError`] for a pose that is none or out of reach, and for a zoom out of range.
    pub fn new(surface: u32, pose: Pose, zoom: f64) -> Result<Self, ValueError> {
        let near = |metres: &f64| metres.abs() <= FARTHEST_M;
        match pose.is_valid() && pose.position_m.iter().all(near) {
            true => Ok(Self {
                surface,
                pose,
                zoom: Zoom::new(zoom)?,
            }),
            false => Err(ValueError::Pose),
        }
    }
}

fn near<'de, D: Deserializer<'de>>(from: D) -> Result<Pose, D::Error> {
    let pose = Pose::deserialize(from)?;
    let placed = Place::new(CANVAS, pose, 1.0).map_err(D::Error::custom)?;
    Ok(placed.pose)
}

impl Form for Place {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static str> = None;

    fn example() -> Result<Self, ValueError> {
        Self::new(CANVAS, Pose::IDENTITY, 2.0)
    }
}
