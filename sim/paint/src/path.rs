//! Motion cut into steps of at most one cell.
//!
//! Motion adds up until the fastest point in contact has gone one cell, whatever the rate of
//! samples; what is left over goes into the next motion.

use crate::head::{HeadPose, HeadShape, Waypoint};

/// Cuts the motion of one brush on one surface.
#[derive(Debug)]
pub struct PathStepper {
    at: Waypoint,
    here: HeadPose,
    stepped: HeadPose,
    left_over: f64,
    cell_m: f64,
}

/// The head before and after one step.
#[derive(Clone, Copy, Debug)]
pub struct Sweep<'a> {
    /// Where it was at the step before.
    pub from: &'a HeadPose,
    /// Where it is now.
    pub to: &'a HeadPose,
}

impl PathStepper {
    /// A path that begins at `at`, on a surface with cells of `cell_m`.
    #[must_use]
    pub fn begin(shape: &HeadShape, at: Waypoint, cell_m: f64) -> Self {
        let mut here = HeadPose::default();
        shape.pose(&at, cell_m, &mut here);
        Self {
            at,
            stepped: here.clone(),
            here,
            left_over: 0.0,
            cell_m,
        }
    }

    /// Moves on to `to` and calls `step` for each whole cell on the way.
    pub fn advance(&mut self, shape: &HeadShape, to: Waypoint, mut step: impl FnMut(Sweep<'_>)) {
        let mut next = HeadPose::default();
        shape.pose(&to, self.cell_m, &mut next);
        let motion = self.here.motion(&next);
        let whole = self.left_over + motion;
        let mut pose = HeadPose::default();
        let mut cells = 1.0;
        while cells <= whole {
            let t = (cells - self.left_over) / motion;
            shape.pose(&self.at.toward(&to, t), self.cell_m, &mut pose);
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

    /// The head at its newest pose.
    #[must_use]
    pub fn head(&self) -> &HeadPose {
        &self.here
    }
}

#[cfg(test)]
mod tests {
    use maulstick_brush::BrushFile;
    use maulstick_types::Pose;
    use maulstick_types::brush::Solve;
    use proptest::prelude::*;

    use super::*;

    fn waypoint(x: f64) -> Waypoint {
        Waypoint::of(&Solve {
            event_ns: 0,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose {
                position_m: [x, 0.1, 0.01],
                ..Pose::IDENTITY
            },
            angles_rad: vec![[0.0, 0.4]; 3],
            contacts: Vec::new(),
        })
    }

    proptest! {
        /// However a motion of 10.4 cells is cut into samples, it is ten steps of one cell.
        #[test]
        fn steps_do_not_depend_on_samples(cuts in prop::collection::vec(0.0..1.0f64, 0..30)) {
            let shape = HeadShape::of(&BrushFile::library("round").expect("round"));
            let mut cuts = cuts;
            cuts.sort_by(f64::total_cmp);
            cuts.push(1.0);
            let mut path = PathStepper::begin(&shape, waypoint(0.1), 2.5e-4);
            let mut steps = Vec::new();
            for cut in cuts {
                path.advance(&shape, waypoint(0.1 + cut * 10.4 * 2.5e-4), |sweep| {
                    steps.push(sweep.from.motion(sweep.to));
                });
            }
            prop_assert_eq!(steps.len(), 10);
            prop_assert!(steps.iter().all(|cells| (cells - 1.0).abs() < 1e-3), "{:?}", steps);
        }
    }
}
