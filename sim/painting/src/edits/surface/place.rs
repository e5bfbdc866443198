//! Moves, turns or zooms a surface.

use maulstick_types::scene::CANVAS;
use maulstick_types::values::{ValueError, Zoom, check_reach};
use maulstick_types::{EditFields, Pose};
use serde::de::{Deserialize, Deserializer, Error};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, words};
use crate::error::EditError;
use crate::painting::Painting;

/// Move, turn or zoom a surface
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Place {
    /// The surface.
    pub surface: u32,
    /// Surface frame to desk frame; within reach.
    #[serde(deserialize_with = "near")]
    pub pose: Pose,
    /// Desk lengths per surface length.
    pub zoom: Zoom,
}

impl Place {
    /// Places a surface.
    ///
    /// # Errors
    /// [`ValueError`] for a pose that is invalid or out of reach, and for a zoom out of range.
    pub fn new(surface: u32, pose: Pose, zoom: f64) -> Result<Self, ValueError> {
        check_reach(&pose)?;
        let zoom = Zoom::new(zoom)?;
        Ok(Self {
            surface,
            pose,
            zoom,
        })
    }
}

fn near<'de, D: Deserializer<'de>>(from: D) -> Result<Pose, D::Error> {
    let pose = Pose::deserialize(from)?;
    check_reach(&pose).map_err(D::Error::custom)?;
    Ok(pose)
}

impl EditFields for Place {
    const NAME: &'static str = "place";
}

impl Form for Place {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static [&'static str]> = None;

    fn example() -> Result<Self, ValueError> {
        Self::new(CANVAS, Pose::IDENTITY, 2.0)
    }
}

impl PaintingEdit for Place {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let zoom = self.zoom.get();
        Place::new(self.surface, self.pose.clone(), zoom)?;
        let desk = &mut painting.bench.desk;
        desk.change_surface(self.surface, |own| {
            (own.pose, own.zoom) = (self.pose.clone(), zoom);
        })?;
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        let zoom = words::number(self.zoom.get());
        let surface = words::surface(self.surface);
        format!("move the {surface}, magnified {zoom} times")
    }
}
