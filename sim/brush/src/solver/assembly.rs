//! Gaps, energies and their derivatives at a shape.
//!
//! Directions are unit vectors: with T_j a basis of the tangent plane at d_j, a small change is
//! δd_j = T_j·u_j. Gradient and Hessian are in the u_j, the curvature of the sphere included, so that
//! a Newton step on them converges quadratically.

use glam::{DMat3, DVec3};

use super::{Energy, Problem, Solver, Stop};
use crate::energy::crowd::crowd;
use crate::energy::damping::damping;
use crate::energy::spring::{Bend, bent, rest_after, spring, straight};
use crate::spine::{Spine, SpineShape};

impl Solver {
    /// Gaps, gradient and Hessian of the energy at `shape`.
    pub(super) fn evaluate(
        &mut self,
        problem: Problem<'_>,
        shape: &SpineShape,
        stops: &[Stop],
    ) -> Energy {
        let spine = problem.spine;
        let (n, size) = (spine.joints(), 2 * spine.joints());
        self.tangents.clear();
        self.tangents.extend(shape.directions.iter().map(|d| {
            let (s, t) = d.any_orthonormal_pair();
            [s, t]
        }));
        self.slopes.clear();
        self.slopes.resize(n, DVec3::ZERO);
        self.hessian.clear();
        self.hessian.resize(size * size, 0.0);
        shape.joints(spine, &mut self.ends);
        let mut energy = Energy {
            spring: self.add_springs(spine, shape),
            ..Energy::default()
        };
        if self.damped {
            energy.damping = self.add_damping(spine, shape);
        }
        self.add_outside(problem, stops, &mut energy);
        self.pull(spine);
        self.project(shape);
        self.constrain(spine, stops);
        energy
    }

    /// The bend of joint `i` between `before` and `d`.
    fn bend(&self, base: DVec3, i: usize, before: DVec3, d: DVec3) -> Bend {
        match self.rest.get(i) {
            Some(rest) => bent(base, *rest, before, d),
            None => straight(before, d),
        }
    }

    fn add_springs(&mut self, spine: &Spine, shape: &SpineShape) -> f64 {
        let (size, base) = (self.tangents.len() * 2, shape.base());
        let (mut value, mut before) = (0.0, base);
        for (i, d) in shape.directions.iter().enumerate() {
            let bend = self.bend(base, i, before, *d);
            let f = spring(spine.stiffness[i], bend.rest, *d);
            value += f.value;
            self.slopes[i] += bend.rest * f.first;
            let own = self.tangents[i].map(|t| t.dot(bend.rest));
            for a in 0..2 {
                for b in 0..2 {
                    self.hessian[(2 * i + a) * size + 2 * i + b] += f.second * own[a] * own[b];
                }
            }
            if i > 0 {
                self.slopes[i - 1] += bend.by_before * f.first;
                let other = self.tangents[i - 1].map(|t| t.dot(bend.by_before));
                for (a, ta) in self.tangents[i - 1].into_iter().enumerate() {
                    let p = 2 * (i - 1) + a;
                    for (b, tb) in self.tangents[i].into_iter().enumerate() {
                        let mixed = bend.bent.map_or(ta.dot(tb), |bent| tb.dot(bent.mixed * ta));
                        let value = f.second * other[a] * own[b] + f.first * mixed;
                        let q = 2 * i + b;
                        self.hessian[p * size + q] += value;
                        self.hessian[q * size + p] += value;
                    }
                    for (b, tb) in self.tangents[i - 1].into_iter().enumerate() {
                        let curved = bend.bent.map_or(0.0, |bent| ta.dot(bent.by_before * tb));
                        self.hessian[p * size + 2 * (i - 1) + b] +=
                            f.second * other[a] * other[b] + f.first * curved;
                    }
                }
            }
            before = *d;
        }
        value
    }

    /// Adds inner friction, which acts between neighbours: v = d_i − d_{i−1} − the chord before.
    fn add_damping(&mut self, spine: &Spine, shape: &SpineShape) -> f64 {
        let size = self.tangents.len() * 2;
        let mut value = 0.0;
        for i in 0..spine.joints() {
            let above = i.checked_sub(1);
            let start = above.map_or(shape.base(), |j| shape.directions[j]);
            let v = shape.directions[i] - start - self.chords[i];
            let f = damping(spine.damping[i], v);
            value += f.value;
            // Each segment that moves, with the sign of its part in v.
            let parts = [(Some(i), 1.0), (above, -1.0)];
            for (j, sign) in parts.into_iter().filter_map(|(j, sign)| Some((j?, sign))) {
                self.slopes[j] += f.torque * sign;
                for (a, ta) in self.tangents[j].into_iter().enumerate() {
                    let p = 2 * j + a;
                    for (k, other) in parts.into_iter().filter_map(|(k, sign)| Some((k?, sign))) {
                        for (b, tb) in self.tangents[k].into_iter().enumerate() {
                            let bent = f.across * ta.dot(tb) - f.along * v.dot(ta) * v.dot(tb);
                            self.hessian[p * size + 2 * k + b] += sign * other * bent;
                        }
                    }
                }
            }
        }
        value
    }

    /// What acts on the ends of segments: friction and neighbours.
    fn add_outside(&mut self, problem: Problem<'_>, stops: &[Stop], energy: &mut Energy) {
        self.pulls.clear();
        self.pulls
            .resize(self.ends.len(), (DVec3::ZERO, DMat3::ZERO));
        for stop in stops {
            if let Some(f) = stop.friction(self.ends[stop.joint], problem.settings) {
                energy.friction += f.value;
                let pull = &mut self.pulls[stop.joint];
                *pull = (pull.0 + f.force, pull.1 + f.hessian);
            }
        }
        for other in problem.neighbours {
            let way = self.ends[other.joint] - other.at;
            if let Some(f) = crowd(problem.settings.crowd_n_m, way, other.at_rest_m) {
                energy.crowd += f.value;
                let pull = &mut self.pulls[other.joint];
                *pull = (pull.0 + f.force, pull.1 + f.hessian);
            }
        }
    }

    /// Hands what acts on the end of a segment to all segments above it.
    fn pull(&mut self, spine: &Spine) {
        let size = self.tangents.len() * 2;
        let (mut force, mut stiffness) = (DVec3::ZERO, DMat3::ZERO);
        let mut acts = false;
        for j in (0..self.pulls.len()).rev() {
            let (own_force, own_stiffness) = self.pulls[j];
            if own_stiffness != DMat3::ZERO {
                acts = true;
                force += own_force;
                stiffness += own_stiffness;
            }
            if !acts {
                continue;
            }
            let length = spine.lengths_m[j];
            self.slopes[j] += force * length;
            for (a, ta) in self.tangents[j].into_iter().enumerate() {
                let p = 2 * j + a;
                let along = stiffness * (ta * length);
                for k in 0..=j {
                    for (b, tb) in self.tangents[k].into_iter().enumerate() {
                        let q = 2 * k + b;
                        let coupling = spine.lengths_m[k] * along.dot(tb);
                        self.hessian[p * size + q] += coupling;
                        if k < j {
                            self.hessian[q * size + p] += coupling;
                        }
                    }
                }
            }
        }
    }

    /// The gradient on the sphere, and the sphere's curvature in the Hessian.
    fn project(&mut self, shape: &SpineShape) {
        let size = self.tangents.len() * 2;
        self.gradient.clear();
        for (j, slope) in self.slopes.iter().enumerate() {
            let curved = slope.dot(shape.directions[j]);
            for (a, t) in self.tangents[j].iter().enumerate() {
                self.gradient.push(slope.dot(*t));
                self.hessian[(2 * j + a) * size + 2 * j + a] -= curved;
            }
        }
    }

    /// The gaps and their derivatives.
    fn constrain(&mut self, spine: &Spine, stops: &[Stop]) {
        let size = self.tangents.len() * 2;
        self.gap.clear();
        self.rows.clear();
        self.rows.resize(stops.len() * size, 0.0);
        for (stop, row) in stops.iter().zip(self.rows.chunks_exact_mut(size)) {
            self.gap.push(stop.wall.gap(self.ends[stop.joint]));
            let below = self.tangents.iter().zip(&spine.lengths_m);
            for (j, (tangents, length)) in below.enumerate().take(stop.joint + 1) {
                row[2 * j] = length * tangents[0].dot(stop.wall.normal);
                row[2 * j + 1] = length * tangents[1].dot(stop.wall.normal);
            }
        }
    }

    /// Adds the curvature of the constraints: −Σλ_i·∇²gap_i.
    pub(super) fn curvature(&mut self, spine: &Spine, shape: &SpineShape, stops: &[Stop]) {
        let size = self.tangents.len() * 2;
        self.model.clear();
        self.model.extend_from_slice(&self.hessian);
        for (stop, force) in stops.iter().zip(&self.multipliers) {
            if *force == 0.0 {
                continue;
            }
            for j in 0..=stop.joint {
                let lies = shape.directions[j].dot(stop.wall.normal);
                let value = force * spine.lengths_m[j] * lies;
                self.model[2 * j * size + 2 * j] += value;
                self.model[(2 * j + 1) * size + 2 * j + 1] += value;
            }
        }
    }

    /// Energy and gaps of the trial.
    pub(super) fn value(
        &mut self,
        problem: Problem<'_>,
        shape: &SpineShape,
        stops: &[Stop],
    ) -> Energy {
        let spine = problem.spine;
        let mut energy = Energy::default();
        place(shape.root, &self.trial, spine, &mut self.trial_ends);
        let base = shape.base();
        let mut above = base;
        for (i, d) in self.trial.iter().enumerate() {
            let rest = match self.rest.get(i) {
                Some(rest) => rest_after(base, *rest, above),
                None => above,
            };
            energy.spring += spring(spine.stiffness[i], rest, *d).value;
            if self.damped {
                let v = *d - above - self.chords[i];
                energy.damping += damping(spine.damping[i], v).value;
            }
            above = *d;
        }
        self.trial_gap.clear();
        for stop in stops {
            let p = self.trial_ends[stop.joint];
            self.trial_gap.push(stop.wall.gap(p));
            if let Some(f) = stop.friction(p, problem.settings) {
                energy.friction += f.value;
            }
        }
        for other in problem.neighbours {
            let way = self.trial_ends[other.joint] - other.at;
            if let Some(f) = crowd(problem.settings.crowd_n_m, way, other.at_rest_m) {
                energy.crowd += f.value;
            }
        }
        energy
    }
}

/// The ends of segments.
fn place(root: DVec3, directions: &[DVec3], spine: &Spine, into: &mut Vec<DVec3>) {
    into.clear();
    let mut p = root;
    for (d, length) in directions.iter().zip(&spine.lengths_m) {
        p += *d * *length;
        into.push(p);
    }
}
