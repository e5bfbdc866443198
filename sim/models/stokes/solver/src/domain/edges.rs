//! Shares and slopes of edges.

use maulstick_num::wide;

use super::{Domain, LEAST_DISTANCE, TOUCHES};
use crate::grid::others;
use crate::runs::share;
use crate::stencil::Span;

/// The near and the far face beside an edge: masks of unknowns and of solids, and distances.
struct Pair<'a> {
    free: [&'a [f32]; 2],
    solid: [&'a [f32]; 2],
    near: [&'a [f32]; 2],
}

impl<'a> Pair<'a> {
    #[inline(always)]
    fn of(domain: &'a Domain, axis: usize, by: usize, span: &Span) -> Self {
        let (free, solid, near) = (&domain.free[axis], &domain.solid[axis], &domain.near[axis]);
        Self {
            free: [span.here(free), span.before(free, by)],
            solid: [span.here(solid), span.before(solid, by)],
            near: [span.here(near), span.before(near, by)],
        }
    }

    /// Distance between both velocities.
    #[inline(always)]
    fn distance(&self, i: usize) -> f32 {
        let [one, other] = [self.near[0][i], self.near[1][i]];
        let is_first = self.free[0][i] > 0.0;
        let paint = if is_first { one } else { other };
        let solid = if is_first { other } else { one };
        let behind = if solid < 0.0 { solid } else { 0.0 };
        let share = paint / (paint - behind);
        let share = if share > LEAST_DISTANCE {
            share
        } else {
            LEAST_DISTANCE
        };
        // The grid's own side is in the middle.
        let distance = if solid > TOUCHES { 0.5 } else { share };
        let is_wall = self.free[0][i] * self.solid[1][i] + self.free[1][i] * self.solid[0][i];
        if is_wall > 0.0 { distance } else { 1.0 }
    }

    /// Number of unknowns and of solids.
    #[inline(always)]
    fn count(&self, i: usize) -> [f32; 2] {
        [
            self.free[0][i] + self.free[1][i],
            self.solid[0][i] + self.solid[1][i],
        ]
    }
}

wide! {
    /// Shares and slopes of edges; the velocities along the first axis are neighbours along the second.
    fn edges_flat(share: &mut [f32], slope: [&mut [f32]; 2], domain: &Domain, fill: &[f32], axes: [usize; 2], span: Span) {
        let [a, b] = axes;
        let by = [1, span.row, span.plane];
        let (by_a, by_b) = (by[a], by[b]);
        let (first, second) = (Pair::of(domain, a, by_b, &span), Pair::of(domain, b, by_a, &span));
        let (here, low) = (span.here(fill), span.before(fill, by_a));
        let (lower, lowest) = (span.before(fill, by_b), span.before(fill, by_a + by_b));
        let [u_slope, v_slope] = slope;
        let (u_slope, v_slope) = (span.own(u_slope), span.own(v_slope));
        let share = span.own(share);
        for i in 0..share.len() {
            let [free, solid] = first.count(i);
            let [more_free, more_solid] = second.count(i);
            let (free, solid) = (free + more_free, solid + more_solid);
            let is_sheared = (free + solid > 3.5) & (free > 0.0);
            let one = if here[i] < 1.0 { here[i] } else { 1.0 };
            let two = if low[i] < 1.0 { low[i] } else { 1.0 };
            let three = if lower[i] < 1.0 { lower[i] } else { 1.0 };
            let four = if lowest[i] < 1.0 { lowest[i] } else { 1.0 };
            let mean = 0.25 * ((one + two) + (three + four));
            let mean = if solid > 0.0 { 1.0 } else { mean };
            let (u, v) = (first.distance(i), second.distance(i));
            share[i] = if is_sheared { mean * u * v } else { 0.0 };
            u_slope[i] = if is_sheared { 1.0 / u } else { 1.0 };
            v_slope[i] = if is_sheared { 1.0 / v } else { 1.0 };
        }
    }
}

impl Domain {
    /// Shares and slopes of edges.
    pub(super) fn find_edges(&mut self, fill: &[f32]) {
        let mut edges = [0, 1, 2].map(|edge| {
            let slope = std::mem::take(&mut self.slope[edge]);
            (edge, std::mem::take(&mut self.edge[edge]), slope)
        });
        let domain = &*self;
        share(domain.grid.len(), &mut edges, |(edge, share, slope)| {
            find(domain, fill, *edge, share, slope);
        });
        for (edge, share, slope) in edges {
            self.edge[edge] = share;
            self.slope[edge] = slope;
        }
    }
}

/// Shares and slopes of the edges along an axis.
fn find(domain: &Domain, fill: &[f32], edge: usize, share: &mut [f32], slope: &mut [Vec<f32>; 2]) {
    let grid = domain.grid;
    let axes = others(edge);
    let from = axes.iter().map(|axis| grid.stride(*axis)).sum::<usize>();
    share[..from].fill(0.0);
    for slope in &mut *slope {
        slope[..from].fill(1.0);
    }
    let span = Span::of(&grid, from..grid.len());
    let slopes = slope.each_mut().map(|slope| &mut slope[from..]);
    edges_flat(&mut share[from..], slopes, domain, fill, axes, span);
    grid.wrap(share);
    for slope in slope {
        grid.wrap(slope);
    }
}
