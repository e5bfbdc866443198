//! A motion in a mirror.

use glam::DQuat;
use maulstick_num::geometry::canonical;
use maulstick_types::stylus::{StylusPose, StylusSample};

use crate::MotionError;
use crate::take_sample::{TakeSample, checked};

/// Axis of a mirror.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mirror {
    /// Left and right: x changes its sign.
    X,
    /// Above and below: y changes its sign.
    Y,
}

impl Mirror {
    /// The axis whose sign changes.
    const fn axis(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
        }
    }

    /// A sample in the mirror, whose line goes through `about`, m.
    ///
    /// A rotation R of the handle becomes M·R·B: M is the mirror, and B mirrors the brush in the plane of its broad
    /// side, a symmetry of each head of the library, including slanted ones. So its mark is the mirror image.
    #[must_use]
    pub fn sample(self, sample: &StylusSample, about: [f64; 2]) -> StylusSample {
        let mut sample = sample.clone();
        let axis = self.axis();
        let place = |metres: &mut f64| *metres = 2.0 * about[axis] - *metres;
        match &mut sample.pose {
            StylusPose::Contact {
                point_m,
                tilt_rad,
                twist_rad,
                ..
            } => {
                place(&mut point_m[axis]);
                tilt_rad[axis] = -tilt_rad[axis];
                *twist_rad = match self {
                    // M·B is half a turn about the axis of the handle.
                    Self::X => std::f64::consts::PI - *twist_rad,
                    Self::Y => -*twist_rad,
                };
            }
            StylusPose::Ferrule { pose } => {
                place(&mut pose.position_m[axis]);
                let [x, y, z, w] = pose.orientation;
                let mirrored = match self {
                    Self::X => {
                        DQuat::from_xyzw(x, -y, -z, w) * DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0)
                    }
                    Self::Y => DQuat::from_xyzw(-x, y, -z, w),
                };
                pose.orientation = canonical(mirrored).to_array();
            }
        }
        sample.velocity_m_s[axis] = -sample.velocity_m_s[axis];
        sample.force_n[axis] = -sample.force_n[axis];
        sample
    }
}

/// A motion in a mirror whose line goes through `about`, m.
///
/// # Errors
/// [`MotionError::Sample`] where it would leave the desk.
pub fn mirrored(
    samples: &[TakeSample],
    mirror: Mirror,
    about: [f64; 2],
) -> Result<Vec<TakeSample>, MotionError> {
    let in_it = samples.iter().map(|taken| TakeSample {
        time_ns: taken.time_ns,
        sample: mirror.sample(&taken.sample, about),
    });
    checked(in_it.collect())
}
