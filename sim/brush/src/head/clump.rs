//! Clumps: wet strips that come together toward the point.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{Head, STATIONS, place_along, rest_point, smoothstep};
use crate::file::BrushFile;

impl Head {
    /// The offsets that bring strips together in clumps: each toward the mean of the strips nearest to the same seed,
    /// increasing toward the point.
    pub(super) fn clump(&mut self, file: &BrushFile, roots: &[DVec2]) {
        let clumps = file.strips.clumps.min(self.strips);
        if clumps == 0 || self.clumping == [0.0; 2] {
            return;
        }
        // Every n-th element of an even sequence is an even sequence; a line is in order.
        let half = DVec2::new(file.radius_m(0.0), file.half_thickness_m(0.0));
        let seed = |clump: usize| roots[clump * self.strips / clumps] * half;
        let distance = |clump: usize, root: DVec2| (seed(clump) - root * half).length_squared();
        let member: Vec<usize> = roots
            .iter()
            .map(|root| {
                let near =
                    |a: &usize, b: &usize| distance(*a, *root).total_cmp(&distance(*b, *root));
                (0..clumps).min_by(near).unwrap_or(0)
            })
            .collect();
        let mut planes = [const { Vec::new() }; 3];
        for station in 0..STATIONS {
            let points: Vec<DVec3> = roots
                .iter()
                .map(|root| rest_point(file, *root, station))
                .collect();
            let mut sums = vec![(DVec3::ZERO, 0.0); clumps];
            for (point, clump) in points.iter().zip(&member) {
                sums[*clump] = (sums[*clump].0 + *point, sums[*clump].1 + 1.0);
            }
            let share = smoothstep(place_along(station));
            for (point, clump) in points.iter().zip(&member) {
                let (sum, count) = sums[*clump];
                let off = (sum / f64::max(count, 1.0) - *point) * share;
                for (plane, value) in planes.iter_mut().zip([off.x, off.y, 0.0]) {
                    plane.push(value as f32);
                }
            }
        }
        self.clumped = Some(Arc::new(planes));
    }
}
