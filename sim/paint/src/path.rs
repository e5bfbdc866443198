//! Motion cut into steps of at most one cell.
//!
//! The brush is solved about once a cell of its way, whatever the rate of samples; a motion whose
//! strips go farther is cut into even parts. Strips that stand still make no step: their motion adds
//! up from where they stepped last.

use maulstick_brush::{Head, HeadPose};

use crate::head::{Scale, Waypoint, motion};
use crate::model::Sweep;

/// A shorter motion waits for the next, cells.
const STILL: f64 = 0.02;
/// A longer motion is no motion of a hand: nothing is painted on its way, cells.
const LEAP: f64 = 8192.0;
/// A motion longer than one cell by less than this is still one step.
const ROUNDING: f64 = 1e-6;

/// Cuts the motion of one brush on one surface.
#[derive(Debug)]
pub struct PathStepper {
    at: Waypoint,
    stepped: HeadPose,
    scale: Scale,
}

impl PathStepper {
    /// A path that begins at `at`.
    #[must_use]
    pub fn begin(head: &Head, at: Waypoint, scale: Scale) -> Self {
        let mut stepped = HeadPose::default();
        at.pose(head, scale, &mut stepped);
        Self { at, stepped, scale }
    }

    /// Where it is.
    #[must_use]
    pub fn at(&self) -> &Waypoint {
        &self.at
    }

    /// How the brush's lengths are seen.
    #[must_use]
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Moves on to `to` and calls `step` for each step on the way.
    pub fn advance(&mut self, head: &Head, to: Waypoint, mut step: impl FnMut(Sweep<'_>)) {
        let mut next = HeadPose::default();
        to.pose(head, self.scale, &mut next);
        let motion = motion(&self.stepped, &next);
        if motion < STILL {
            return;
        }
        if motion > LEAP {
            *self = Self::begin(head, to, self.scale);
            return;
        }
        let parts = (motion - ROUNDING).ceil().max(1.0) as u64;
        for part in 1..parts {
            let t = part as f64 / parts as f64;
            let mut pose = HeadPose::default();
            self.at.toward(&to, t).pose(head, self.scale, &mut pose);
            step(Sweep {
                from: &self.stepped,
                to: &pose,
            });
            self.stepped = pose;
        }
        step(Sweep {
            from: &self.stepped,
            to: &next,
        });
        (self.at, self.stepped) = (to, next);
    }
}

#[cfg(test)]
mod tests {
    use maulstick_brush::BrushFile;
    use maulstick_types::Pose;
    use maulstick_types::brush::Solve;
    use proptest::prelude::*;

    use super::*;

    const SCALE: Scale = Scale {
        cell_m: 2.5e-4,
        zoom: 1.0,
    };

    fn waypoint(x: f64) -> Waypoint {
        let solve = Solve {
            event_ns: 0,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose {
                position_m: [x, 0.1, 0.01],
                ..Pose::IDENTITY
            },
            zoom: 1.0,
            angles_rad: vec![[0.0, 0.4]; 21],
            contacts: Vec::new(),
        };
        Waypoint::of(&solve, SCALE, 1.0)
    }

    proptest! {
        /// However a motion of 10.4 cells is cut, its steps are at most a cell and make up the whole.
        #[test]
        fn steps_are_at_most_a_cell_and_make_up_the_motion(
            cuts in prop::collection::vec(0.0..1.0f64, 0..30),
        ) {
            let head = Head::of(&BrushFile::library("round").expect("round"));
            let mut cuts = cuts;
            cuts.sort_by(f64::total_cmp);
            cuts.push(1.0);
            let mut path = PathStepper::begin(&head, waypoint(0.1), SCALE);
            let mut steps = Vec::new();
            for cut in cuts {
                path.advance(&head, waypoint(0.1 + cut * 10.4 * 2.5e-4), |sweep| {
                    steps.push(motion(sweep.from, sweep.to));
                });
            }
            let whole: f64 = steps.iter().sum();
            prop_assert!((whole - 10.4).abs() < STILL + 1e-3, "{whole}");
            prop_assert!(steps.iter().all(|cells| *cells < 1.001), "{:?}", steps);
        }
    }
}
