//! Spines as smooth curves.

use glam::DVec3;

use super::STATIONS;
use crate::spine::{Spine, SpineShape};

/// Points of a spine at the stations, from its root to its point.
pub type Curve = [DVec3; STATIONS];

/// A smooth curve through the joints (Catmull and Rom 1974) at the stations.
#[must_use]
pub fn curve(spine: &Spine, shape: &SpineShape) -> Curve {
    let joints = spine.joints();
    let knot = |i: usize| {
        if i == 0 {
            shape.root
        } else {
            shape.joint(spine, i - 1)
        }
    };
    std::array::from_fn(|station| {
        let place = station as f64 / (STATIONS - 1) as f64 * joints as f64;
        let i = (place as usize).min(joints - 1);
        let t = place - i as f64;
        let (b, c) = (knot(i), knot(i + 1));
        let a = if i == 0 {
            b - shape.base() * spine.lengths_m[0]
        } else {
            knot(i - 1)
        };
        let d = if i + 2 <= joints {
            knot(i + 2)
        } else {
            c + (c - b)
        };
        let (t2, t3) = (t * t, t * t * t);
        (b * 2.0
            + (c - a) * t
            + (a * 2.0 - b * 5.0 + c * 4.0 - d) * t2
            + (b * 3.0 - a - c * 3.0 + d) * t3)
            * 0.5
    })
}

/// The mean of curves and its tangent at each station; the first is that of the ferrule, `base`.
#[must_use]
pub fn middle(curves: &[Curve], base: DVec3) -> (Curve, Curve) {
    let mut mean = [DVec3::ZERO; STATIONS];
    for curve in curves {
        mean.iter_mut().zip(curve).for_each(|(sum, p)| *sum += *p);
    }
    let count = curves.len().max(1) as f64;
    mean.iter_mut().for_each(|sum| *sum /= count);
    let tangents = std::array::from_fn(|station| {
        if station == 0 {
            return base;
        }
        let ahead = mean[(station + 1).min(STATIONS - 1)];
        (ahead - mean[station - 1]).normalize_or(base)
    });
    (mean, tangents)
}
