//! A motion scaled, turned and moved on the surface.

use glam::{DVec2, DVec3};
use maulstick_num::atan2;
use maulstick_num::geometry::{Rigid, canonical, rotation};
use maulstick_num::sin_cos;
use maulstick_types::stylus::{StylusPose, StylusSample};

use crate::MotionError;
use crate::error::within;
use crate::take_sample::{TakeSample, checked, point, shifted};

/// Factors by which a motion is scaled.
pub const SCALES: std::ops::RangeInclusive<f64> = 0.01..=100.0;
/// Range of displacements of a motion, m.
const FAR_M: std::ops::RangeInclusive<f64> = -10.0..=10.0;
/// Range of rotations, rad.
const TURNS: std::ops::RangeInclusive<f64> = -100.0..=100.0;
/// Steepest tilt of a pen, rad: within the bound of a sample.
const STEEPEST_RAD: f64 = 1.483_529;

/// A place for a motion: scaled and turned about `from_m`, which comes to `to_m`. Heights above the surface, pressures
/// and the lean of the handle against its path stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// A point of the motion, m.
    pub from_m: [f64; 2],
    /// Target place on the desk, m.
    pub to_m: [f64; 2],
    /// Factor on lengths along the surface.
    pub scale: f64,
    /// Turn, counter-clockwise, rad.
    pub turn_rad: f64,
}

impl Placement {
    /// Identity placement.
    pub const HERE: Self = Self {
        from_m: [0.0; 2],
        to_m: [0.0; 2],
        scale: 1.0,
        turn_rad: 0.0,
    };

    /// Moved by this, m.
    #[must_use]
    pub fn moved(by: [f64; 2]) -> Self {
        Self {
            to_m: by,
            ..Self::HERE
        }
    }

    /// Scaled about a point, m.
    #[must_use]
    pub fn scaled(about: [f64; 2], scale: f64) -> Self {
        Self {
            from_m: about,
            to_m: about,
            scale,
            ..Self::HERE
        }
    }

    /// Turned about a point, m, counter-clockwise by `turn_rad`.
    #[must_use]
    pub fn turned(about: [f64; 2], turn_rad: f64) -> Self {
        Self {
            from_m: about,
            to_m: about,
            turn_rad,
            ..Self::HERE
        }
    }

    /// Sees that its numbers are finite and in range.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`].
    pub fn check(&self) -> Result<(), MotionError> {
        within("a scale of", self.scale, SCALES)?;
        within("a turn of", self.turn_rad, TURNS)?;
        let places = [self.from_m, self.to_m];
        places
            .iter()
            .flatten()
            .try_for_each(|metres| within("a place at", *metres, FAR_M))
    }

    /// The image of a direction or a difference.
    fn vector(&self, v: DVec2) -> DVec2 {
        self.rotate(v) * self.scale
    }

    fn rotate(&self, v: DVec2) -> DVec2 {
        match self.turn_rad {
            0.0 => v,
            turn => {
                let (s, c) = sin_cos(turn);
                DVec2::new(c * v.x - s * v.y, s * v.x + c * v.y)
            }
        }
    }

    /// The image of a point on the surface, m.
    #[must_use]
    pub fn point(&self, at: [f64; 2]) -> [f64; 2] {
        let [from, to] = [self.from_m, self.to_m].map(DVec2::from_array);
        (to + self.vector(DVec2::from_array(at) - from)).to_array()
    }

    /// A placed sample. `head_m` is the length of the head of a 6-DOF stylus, m: its point is scaled and moved,
    /// whatever the lean of the handle.
    #[must_use]
    pub fn sample(&self, sample: &StylusSample, head_m: f64) -> StylusSample {
        let mut turned = sample.clone();
        if self.turn_rad != 0.0 {
            self.turn_handle(&mut turned);
        }
        let to = self.point(point(sample, head_m).truncate().to_array());
        let by = DVec2::from_array(to) - point(&turned, head_m).truncate();
        let mut placed = shifted(&turned, by);
        let velocity = DVec3::from_array(sample.velocity_m_s);
        let along = self.vector(velocity.truncate());
        placed.velocity_m_s = along.extend(velocity.z).to_array();
        let force = DVec3::from_array(sample.force_n);
        placed.force_n = self.rotate(force.truncate()).extend(force.z).to_array();
        placed
    }

    /// Turns the handle about the surface's normal.
    fn turn_handle(&self, sample: &mut StylusSample) {
        match &mut sample.pose {
            StylusPose::Contact {
                tilt_rad,
                twist_rad,
                ..
            } => {
                let slope = |angle: f64| {
                    let (s, c) = sin_cos(angle);
                    s / c
                };
                let axis = self.rotate(DVec2::from_array(tilt_rad.map(slope)));
                // Two steep tilts may become one that is steeper than a sample may have.
                let tilt = |slope: f64| atan2(slope, 1.0).clamp(-STEEPEST_RAD, STEEPEST_RAD);
                *tilt_rad = axis.to_array().map(tilt);
                *twist_rad += self.turn_rad;
            }
            StylusPose::Ferrule { pose } => {
                let turned = rotation(DVec3::Z, self.turn_rad) * Rigid::from(&*pose).rotation;
                pose.orientation = canonical(turned).to_array();
            }
        }
    }

    /// A placed motion.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`]; [`MotionError::Sample`] where it would leave the desk.
    pub fn motion(
        &self,
        samples: &[TakeSample],
        head_m: f64,
    ) -> Result<Vec<TakeSample>, MotionError> {
        self.check()?;
        let placed = samples.iter().map(|taken| TakeSample {
            time_ns: taken.time_ns,
            sample: self.sample(&taken.sample, head_m),
        });
        checked(placed.collect())
    }
}
