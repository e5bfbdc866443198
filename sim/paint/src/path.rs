//! Motion cut into steps of at most one cell.
//!
//! Motion adds up until the fastest point in contact has gone one cell, whatever the rate of
//! samples; what is left over goes into the next motion.

use maulstick_brush::{Head, HeadPose};

use crate::head::{Scale, Waypoint, motion};
use crate::model::Sweep;

/// Cuts the motion of one brush on one surface.
#[derive(Debug)]
pub struct PathStepper {
    at: Waypoint,
    here: HeadPose,
    stepped: HeadPose,
    left_over: f64,
    scale: Scale,
}

impl PathStepper {
    /// A path that begins at `at`.
    #[must_use]
    pub fn begin(head: &Head, at: Waypoint, scale: Scale) -> Self {
        let mut here = HeadPose::default();
        at.pose(head, scale, &mut here);
        Self {
            at,
            stepped: here.clone(),
            here,
            left_over: 0.0,
            scale,
        }
    }

    /// How the brush's lengths are seen.
    #[must_use]
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Moves on to `to` and calls `step` for each whole cell on the way.
    pub fn advance(&mut self, head: &Head, to: Waypoint, mut step: impl FnMut(Sweep<'_>)) {
        let mut next = HeadPose::default();
        to.pose(head, self.scale, &mut next);
        let motion = motion(&self.here, &next);
        let whole = self.left_over + motion;
        let mut pose = HeadPose::default();
        let mut cells = 1.0;
        while cells <= whole {
            let t = (cells - self.left_over) / motion;
            self.at.toward(&to, t).pose(head, self.scale, &mut pose);
            step(Sweep {
                from: &self.stepped,
                to: &pose,
            });
            std::mem::swap(&mut self.stepped, &mut pose);
            cells += 1.0;
        }
        self.left_over = whole - (cells - 1.0);
        self.at = to;
        self.here = next;
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
            angles_rad: vec![[0.0, 0.4]; 21],
            contacts: Vec::new(),
        };
        Waypoint::of(&solve, SCALE)
    }

    proptest! {
        /// However a motion of 10.4 cells is cut into samples, it is ten steps of one cell.
        #[test]
        fn steps_do_not_depend_on_samples(cuts in prop::collection::vec(0.0..1.0f64, 0..30)) {
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
            prop_assert_eq!(steps.len(), 10);
            prop_assert!(steps.iter().all(|cells| (cells - 1.0).abs() < 1e-3), "{:?}", steps);
        }
    }
}
