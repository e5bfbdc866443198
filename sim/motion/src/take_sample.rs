//! A sample with its time, and the point of its brush.

use glam::{DVec2, DVec3};
use maulstick_num::geometry::Rigid;
use maulstick_types::stylus::{StylusPose, StylusSample};

use crate::MotionError;

/// A sample and when it was taken.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeSample {
    /// Since the take's start, ns.
    pub time_ns: u64,
    /// The sample.
    pub sample: StylusSample,
}

impl TakeSample {
    /// Point of the brush in the desk frame, m: of a pen its tip, of a 6-DOF stylus `head_m` below its ferrule along the
    /// bristles.
    #[must_use]
    pub fn point(&self, head_m: f64) -> [f64; 3] {
        point(&self.sample, head_m).to_array()
    }

    /// Depth of the press: of a pen its pressure, of a 6-DOF stylus the share of its head that is below the
    /// desk; 0 in the air, at most 1.
    #[must_use]
    pub fn press(&self, head_m: f64) -> f64 {
        match &self.sample.pose {
            _ if self.sample.in_air() => 0.0,
            StylusPose::Contact { pressure, .. } => *pressure,
            StylusPose::Ferrule { .. } => {
                let depth = -self.point(head_m)[2];
                (depth / head_m.max(1e-6)).clamp(0.0, 1.0)
            }
        }
    }
}

/// As [`TakeSample::point`].
pub(crate) fn point(sample: &StylusSample, head_m: f64) -> DVec3 {
    match &sample.pose {
        StylusPose::Contact { point_m, .. } => DVec3::from_array(*point_m),
        StylusPose::Ferrule { pose } => Rigid::from(pose).point(DVec3::NEG_Z * head_m),
    }
}

/// The sample with its brush shifted along the desk, m.
pub(crate) fn shifted(sample: &StylusSample, by: DVec2) -> StylusSample {
    let mut sample = sample.clone();
    let place = match &mut sample.pose {
        StylusPose::Contact { point_m, .. } => point_m,
        StylusPose::Ferrule { pose } => &mut pose.position_m,
    };
    place[0] += by.x;
    place[1] += by.y;
    sample
}

/// The motion, if each of its samples may be sent and its times rise.
pub(crate) fn checked(samples: Vec<TakeSample>) -> Result<Vec<TakeSample>, MotionError> {
    let start_ns = samples.first().map_or(0, |first| first.time_ns);
    let at_s = |time_ns: u64| time_ns.saturating_sub(start_ns) as f64 * 1e-9;
    for TakeSample { time_ns, sample } in &samples {
        if let Some(fault) = sample.fault() {
            let at_s = at_s(*time_ns);
            return Err(MotionError::Sample { at_s, fault });
        }
    }
    for pair in samples.windows(2) {
        if pair[1].time_ns <= pair[0].time_ns {
            let at_s = at_s(pair[1].time_ns);
            return Err(MotionError::Times { at_s });
        }
    }
    Ok(samples)
}
