//! Gaps, energies and their derivatives at a shape.

use glam::DVec2;

use super::{Energy, Settings, Solver, Touch};
use crate::energy::{damping, friction, spring};
use crate::spine::{Spine, SpineShape};

impl Solver {
    /// Gaps, gradient and Hessian of the energy at `shape`.
    pub(super) fn evaluate(
        &mut self,
        spine: &Spine,
        shape: &SpineShape,
        touches: &[Touch],
        settings: &Settings,
    ) -> Energy {
        let n = spine.joints();
        let size = 2 * n;
        self.tangents.clear();
        self.tangents.extend(shape.directions.iter().map(|d| {
            let (s, t) = d.any_orthonormal_pair();
            [s, t]
        }));
        self.gradient.clear();
        self.gradient.resize(size, 0.0);
        self.hessian.clear();
        self.hessian.resize(size * size, 0.0);
        self.rows.clear();
        self.gap.clear();
        let mut energy = Energy::default();
        let mut height = shape.root.z;
        for (i, d) in shape.directions.iter().enumerate() {
            let above = if i == 0 {
                shape.base
            } else {
                shape.directions[i - 1]
            };
            let f = spring(spine.stiffness[i], above, *d);
            energy.spring += f.value;
            let own = self.tangents[i].map(|t| t.dot(above));
            self.add_spring(2 * i, own, f, above.dot(*d));
            if i > 0 {
                let other = self.tangents[i - 1].map(|t| t.dot(*d));
                self.add_spring(2 * (i - 1), other, f, above.dot(*d));
                for (a, ta) in self.tangents[i - 1].into_iter().enumerate() {
                    for (b, tb) in self.tangents[i].into_iter().enumerate() {
                        let value = f.second * other[a] * own[b] + f.first * ta.dot(tb);
                        let (p, q) = (2 * (i - 1) + a, 2 * i + b);
                        self.hessian[p * size + q] += value;
                        self.hessian[q * size + p] += value;
                    }
                }
            }
            height += spine.lengths_m[i] * d.z;
            self.gap.push(height);
            self.rows
                .extend(self.tangents[i].map(|t| spine.lengths_m[i] * t.z));
        }
        energy.friction = self.add_friction(spine, shape, touches, settings);
        if self.damped {
            energy.damping = self.add_damping(spine, shape);
        }
        energy
    }

    /// Adds inner friction, which acts between neighbours: v = d_i − d_{i−1} − the chord before.
    fn add_damping(&mut self, spine: &Spine, shape: &SpineShape) -> f64 {
        let size = self.gradient.len();
        let mut value = 0.0;
        for i in 0..spine.joints() {
            let above = i.checked_sub(1);
            let start = above.map_or(shape.base, |j| shape.directions[j]);
            let v = shape.directions[i] - start - self.chords[i];
            let f = damping(spine.damping[i], v);
            value += f.value;
            // Each segment that moves, with the sign of its part in v.
            let parts = [(Some(i), 1.0), (above, -1.0)];
            for (j, sign) in parts.into_iter().filter_map(|(j, sign)| Some((j?, sign))) {
                let curved = sign * f.torque.dot(shape.directions[j]);
                for (a, ta) in self.tangents[j].into_iter().enumerate() {
                    let p = 2 * j + a;
                    self.gradient[p] += sign * f.torque.dot(ta);
                    self.hessian[p * size + p] -= curved;
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

    /// Adds f(c) with δc = own·u to the gradient and Hessian of one segment.
    pub(super) fn add_spring(
        &mut self,
        at: usize,
        own: [f64; 2],
        f: crate::energy::OfCosine,
        cosine: f64,
    ) {
        let size = self.gradient.len();
        for a in 0..2 {
            self.gradient[at + a] += f.first * own[a];
            self.hessian[(at + a) * size + at + a] -= f.first * cosine;
            for b in 0..2 {
                self.hessian[(at + a) * size + at + b] += f.second * own[a] * own[b];
            }
        }
    }

    /// Adds friction, which acts on the ends of segments and so on all segments above them.
    pub(super) fn add_friction(
        &mut self,
        spine: &Spine,
        shape: &SpineShape,
        touches: &[Touch],
        settings: &Settings,
    ) -> f64 {
        let size = self.gradient.len();
        let mut value = 0.0;
        let (mut force, mut stiffness) = (DVec2::ZERO, [DVec2::ZERO; 2]);
        for j in (0..spine.joints()).rev() {
            if let Some(anchor) = touches[j].anchor {
                let slip = shape.joint(spine, j).truncate() - anchor;
                let f = friction(
                    settings.friction * touches[j].force_n,
                    slip,
                    settings.epsilon_m,
                );
                value += f.value;
                force += f.force;
                stiffness = [stiffness[0] + f.hessian[0], stiffness[1] + f.hessian[1]];
            }
            let length = spine.lengths_m[j];
            let pull = force.extend(0.0);
            for (a, ta) in self.tangents[j].into_iter().enumerate() {
                let p = 2 * j + a;
                self.gradient[p] += length * ta.dot(pull);
                self.hessian[p * size + p] -= length * shape.directions[j].dot(pull);
                let along = stiffness[0] * ta.x + stiffness[1] * ta.y;
                // Contacts at or below j move with every segment k ≤ j.
                for k in 0..=j {
                    for (b, tb) in self.tangents[k].into_iter().enumerate() {
                        let q = 2 * k + b;
                        let coupling = length * spine.lengths_m[k] * along.dot(tb.truncate());
                        self.hessian[p * size + q] += coupling;
                        if k < j {
                            self.hessian[q * size + p] += coupling;
                        }
                    }
                }
            }
        }
        value
    }

    /// Adds the curvature of the constraints: −Σλ_i·∇²gap_i.
    pub(super) fn curvature(&mut self, spine: &Spine, shape: &SpineShape) {
        let size = self.gradient.len();
        self.model.clear();
        self.model.extend_from_slice(&self.hessian);
        let mut below = 0.0;
        for j in (0..spine.joints()).rev() {
            below += self.multipliers[j];
            let value = below * spine.lengths_m[j] * shape.directions[j].z;
            self.model[2 * j * size + 2 * j] += value;
            self.model[(2 * j + 1) * size + 2 * j + 1] += value;
        }
    }

    /// Energy and gaps of the trial.
    pub(super) fn value(
        &mut self,
        spine: &Spine,
        shape: &SpineShape,
        touches: &[Touch],
        settings: &Settings,
    ) -> Energy {
        let mut energy = Energy::default();
        self.trial_gap.clear();
        let (mut above, mut p) = (shape.base, shape.root);
        for (i, d) in self.trial.iter().enumerate() {
            energy.spring += spring(spine.stiffness[i], above, *d).value;
            if self.damped {
                let v = *d - above - self.chords[i];
                energy.damping += damping(spine.damping[i], v).value;
            }
            p += *d * spine.lengths_m[i];
            self.trial_gap.push(p.z);
            if let Some(anchor) = touches[i].anchor {
                let weight = settings.friction * touches[i].force_n;
                energy.friction +=
                    friction(weight, p.truncate() - anchor, settings.epsilon_m).value;
            }
            above = *d;
        }
        energy
    }
}
