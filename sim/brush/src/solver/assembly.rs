//! Gaps, energies and their derivatives at a shape.
//!
//! Directions are unit vectors: with T_j a basis of the tangent plane at d_j, a small change is δd_j = T_j·u_j.
//! Gradient and Hessian are in the u_j, the curvature of the sphere included, so that a Newton step on them converges
//! quadratically.
//!
//! Every trial of the line search calls [`look`](Solver::look); only the next step calls
//! [`assemble`](Solver::assemble).

use glam::{DMat2, DMat3, DVec2, DVec3};

use super::{ContactConstraint, Damper, Energy, Model, Problem, Solver, Tangents};
use crate::energy::damping::damping;
use crate::energy::neighbour_repulsion::neighbour_repulsion;
use crate::energy::spring::{bent, rest_after, spring, straight};
use crate::spine::{Spine, SpineShape};

impl Solver {
    /// Energy, its derivatives in space, and gaps at `shape`.
    pub(super) fn look(
        &mut self,
        problem: Problem<'_>,
        shape: &SpineShape,
        constraints: &[ContactConstraint],
    ) -> Energy {
        let spine = problem.spine;
        shape.joints(spine, &mut self.point.ends);
        self.point.slopes.clear();
        self.point.slopes.resize(spine.joints(), DVec3::ZERO);
        let mut energy = Energy {
            spring: self.look_at_springs(spine, shape),
            ..Energy::default()
        };
        if self.damped {
            energy.damping = self.look_at_dampers(problem, shape);
        }
        let slopes = self.point.slopes.iter_mut();
        for ((slope, bond), d) in slopes.zip(problem.bonds).zip(&shape.directions) {
            energy.bond += bond.value(*d);
            *slope += bond.slope();
        }
        self.look_outside(problem, constraints, &mut energy);
        let point = &mut self.point;
        point.gaps.clear();
        let ends = &point.ends;
        let gaps = constraints
            .iter()
            .map(|constraint| constraint.half_space.gap(ends[constraint.joint]));
        point.gaps.extend(gaps);
        // A force on the end of a segment acts on all segments above it too.
        let mut force = DVec3::ZERO;
        let segments = point.slopes.iter_mut().zip(&point.pulls);
        for ((slope, pull), length) in segments.zip(&spine.lengths_m).rev() {
            force += pull.0;
            *slope += force * *length;
        }
        energy
    }

    fn look_at_springs(&mut self, spine: &Spine, shape: &SpineShape) -> f64 {
        let (point, base) = (&mut self.point, shape.base());
        let (mut value, mut before) = (0.0, base);
        point.bends.clear();
        for (i, d) in shape.directions.iter().enumerate() {
            let (rest, by_before) = match self.rest.get(i) {
                None => (before, *d),
                Some(rest) if i == 0 => (rest_after(base, *rest, before), DVec3::ZERO),
                Some(rest) => {
                    let bend = bent(base, *rest, before, *d);
                    (bend.rest, bend.by_before)
                }
            };
            let f = spring(spine.stiffness[i], rest, *d);
            value += f.value;
            point.slopes[i] += rest * f.first;
            if i > 0 {
                point.slopes[i - 1] += by_before * f.first;
            }
            point.bends.push(f);
            before = *d;
        }
        value
    }

    /// Inner friction, which draws each segment to its anchor.
    fn look_at_dampers(&mut self, problem: Problem<'_>, shape: &SpineShape) -> f64 {
        let (spine, factor) = (problem.spine, problem.settings.damping);
        let point = &mut self.point;
        let (mut value, mut before) = (0.0, shape.base());
        point.dampers.clear();
        for (i, d) in shape.directions.iter().enumerate() {
            let turn = &self.turns[i];
            let anchor = *turn * before;
            let f = damping(factor * spine.damping[i], *d, anchor);
            let by_before = turn.transpose() * *d;
            value += f.value;
            point.slopes[i] += anchor * f.first;
            if i > 0 {
                point.slopes[i - 1] += by_before * f.first;
            }
            point.dampers.push(Damper {
                energy: f,
                anchor,
                by_before,
            });
            before = *d;
        }
        value
    }

    /// Forces on the ends of segments: friction and neighbours.
    fn look_outside(
        &mut self,
        problem: Problem<'_>,
        constraints: &[ContactConstraint],
        energy: &mut Energy,
    ) {
        let point = &mut self.point;
        point.pulls.clear();
        let none = (DVec3::ZERO, DMat3::ZERO);
        point.pulls.resize(point.ends.len(), none);
        for constraint in constraints {
            if let Some(f) = constraint.friction(point.ends[constraint.joint], problem.settings) {
                energy.friction += f.value;
                let pull = &mut point.pulls[constraint.joint];
                *pull = (pull.0 + f.force, pull.1 + f.hessian);
            }
        }
        for other in problem.neighbours {
            let way = point.ends[other.joint] - other.at;
            if let Some(f) =
                neighbour_repulsion(problem.settings.repulsion_n_m, way, other.at_rest_m)
            {
                energy.repulsion += f.value;
                let pull = &mut point.pulls[other.joint];
                *pull = (pull.0 + f.force, pull.1 + f.hessian);
            }
        }
    }

    /// ‖∇L‖∞ of L = E − Σλ_i·gap_i with the current multipliers: the longest of the segments' gradients in their
    /// tangent planes, N·m.
    pub(super) fn residual(
        &mut self,
        spine: &Spine,
        shape: &SpineShape,
        constraints: &[ContactConstraint],
    ) -> f64 {
        let point = &mut self.point;
        point.lagrangian.clear();
        point.lagrangian.resize(spine.joints(), DVec3::ZERO);
        for (constraint, push) in constraints.iter().zip(&self.multipliers) {
            point.lagrangian[constraint.joint] -= constraint.half_space.normal * *push;
        }
        let (mut pushes, mut worst) = (DVec3::ZERO, 0.0);
        for (j, slope) in point.slopes.iter().enumerate().rev() {
            pushes += point.lagrangian[j];
            let gradient = *slope + pushes * spine.lengths_m[j];
            let d = shape.directions[j];
            let across = gradient - d * gradient.dot(d);
            worst = f64::max(worst, across.length());
            point.lagrangian[j] = gradient;
        }
        worst
    }

    /// Quadratic model at the shape of the last [`look`](Solver::look).
    pub(super) fn assemble(&mut self, spine: &Spine, shape: &SpineShape) {
        let (model, point) = (&mut self.model, &self.point);
        let n = spine.joints();
        model.tangents.clear();
        let pairs = shape.directions.iter().map(|d| d.any_orthonormal_pair());
        model.tangents.extend(pairs.map(|(s, t)| Tangents(s, t)));
        model.gradient.clear();
        let segments = model.tangents.iter().zip(&point.slopes);
        let gradient = segments.map(|(tangents, slope)| tangents.of(*slope));
        model.gradient.extend(gradient);
        model.hessian.clear();
        model.hessian.resize(n * n, DMat2::ZERO);
        // The sphere's curvature, with that of the constraints.
        for (j, d) in shape.directions.iter().enumerate() {
            let curved = -point.lagrangian[j].dot(*d);
            model.hessian[j * n + j] = DMat2::from_diagonal(DVec2::splat(curved));
        }
        self.assemble_springs(shape);
        if self.damped {
            self.assemble_dampers();
        }
        self.assemble_pulls(spine);
    }

    fn assemble_springs(&mut self, shape: &SpineShape) {
        let base = shape.base();
        let mut before = base;
        for (i, d) in shape.directions.iter().enumerate() {
            let bend = match self.rest.get(i) {
                Some(rest) => bent(base, *rest, before, *d),
                None => straight(before, *d),
            };
            let f = self.point.bends[i];
            let here = self.model.tangents[i];
            let own = here.of(bend.rest);
            self.model.add(i, i, outer(own * f.second, own));
            if i > 0 {
                let above = self.model.tangents[i - 1];
                let other = above.of(bend.by_before);
                let mut mixed = outer(other * f.second, own);
                let mut curved = outer(other * f.second, other);
                match &bend.bent {
                    None => mixed += product(above, here.0, here.1) * f.first,
                    Some(bent) => {
                        let turned = bent.mixed.transpose();
                        mixed += product(above, turned * here.0, turned * here.1) * f.first;
                        let by_before = bent.by_before * f.first;
                        curved += product(above, by_before * above.0, by_before * above.1);
                    }
                }
                self.model.add(i - 1, i, mixed);
                self.model.add(i - 1, i - 1, curved);
            }
            before = *d;
        }
    }

    fn assemble_dampers(&mut self) {
        for (i, damper) in self.point.dampers.iter().enumerate() {
            let f = damper.energy;
            let here = self.model.tangents[i];
            let own = here.of(damper.anchor);
            self.model.add(i, i, outer(own * f.second, own));
            if i > 0 {
                let above = self.model.tangents[i - 1];
                let other = above.of(damper.by_before) * f.second;
                let back = self.turns[i].transpose();
                let turned = product(above, back * here.0, back * here.1) * f.first;
                self.model.add(i - 1, i, outer(other, own) + turned);
                let curved = outer(other, above.of(damper.by_before));
                self.model.add(i - 1, i - 1, curved);
            }
        }
    }

    /// A force on the end of a segment couples all segments above it.
    fn assemble_pulls(&mut self, spine: &Spine) {
        let mut stiffness = DMat3::ZERO;
        let mut acts = false;
        for (j, (_, own)) in self.point.pulls.iter().enumerate().rev() {
            if *own != DMat3::ZERO {
                acts = true;
                stiffness += *own;
            }
            if !acts {
                continue;
            }
            let scaled = stiffness * spine.lengths_m[j];
            let here = self.model.tangents[j];
            let (s, t) = (scaled * here.0, scaled * here.1);
            for k in 0..=j {
                let above = self.model.tangents[k];
                let block = product(above, s, t) * spine.lengths_m[k];
                self.model.add(k, j, block);
            }
        }
    }
}

/// a·bᵀ.
fn outer(a: DVec2, b: DVec2) -> DMat2 {
    DMat2::from_cols(a * b.x, a * b.y)
}

/// The components of two vectors in the tangent plane, one per column.
fn product(tangents: Tangents, s: DVec3, t: DVec3) -> DMat2 {
    DMat2::from_cols(tangents.of(s), tangents.of(t))
}

impl Model {
    /// Adds a block: row segment `k`, column segment `j` ≥ `k`.
    fn add(&mut self, k: usize, j: usize, block: DMat2) {
        self.hessian[k * self.gradient.len() + j] += block;
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::rotation;

    use super::super::{HalfSpace, Neighbour, Settings};
    use super::*;
    use crate::energy::bond::Bond;
    use crate::energy::friction::Anisotropy;

    /// A bent, damped spine that is dragged over the surface beside another one.
    fn scene() -> (
        Spine,
        SpineShape,
        Vec<ContactConstraint>,
        [Neighbour; 1],
        Settings,
    ) {
        let rest = [0.1, 0.3, 0.6, 0.8]
            .map(|a| DVec3::new(maulstick_num::sin(a), 0.0, -maulstick_num::cos(a)));
        let spine = Spine::uniform(0.9, 4, 1.0).resting(&rest).damped(0.2);
        let frame = rotation(DVec3::new(0.6, 0.8, 0.0), 0.5);
        let mut shape = SpineShape::at_rest(DVec3::new(0.1, -0.2, 0.6), frame, &spine);
        for (i, d) in shape.directions.iter_mut().enumerate() {
            *d = (*d + DVec3::new(0.2, 0.3 - 0.1 * i as f64, 0.25)).normalize();
        }
        let mut constraints = ContactConstraint::on_surface(4);
        constraints.push(ContactConstraint::new(
            3,
            HalfSpace {
                normal: DVec3::X,
                offset_m: -0.4,
            },
        ));
        for (i, constraint) in constraints.iter_mut().enumerate().skip(2) {
            constraint.update_preferred(&spine, &shape);
            constraint.force_n = 0.4 + 0.2 * i as f64;
            constraint.anchor =
                Some(shape.joint(&spine, constraint.joint) + DVec3::new(-0.03, 0.02, 0.01));
        }
        let neighbour = Neighbour {
            joint: 2,
            at: shape.joint(&spine, 2) + DVec3::new(0.02, 0.03, -0.01),
            at_rest_m: 0.06,
        };
        let settings = Settings {
            anisotropy: Anisotropy {
                share: 0.4,
                focus: 2.0,
                preferred: DVec3::ZERO,
            },
            epsilon_m: 1e-2,
            repulsion_n_m: 3.0,
            ..Settings::for_length(0.9)
        };
        (spine, shape, constraints, [neighbour], settings)
    }

    #[test]
    fn the_hessian_is_the_derivative_of_the_lagrangians_gradient() {
        let (spine, shape, constraints, neighbours, settings) = scene();
        let bonds = [0.2, 0.4, 0.5, 0.9].map(|a| Bond {
            toward: DVec3::new(0.0, maulstick_num::sin(a), -maulstick_num::cos(a)),
            stiffness: 0.7,
        });
        let problem = Problem {
            spine: &spine,
            neighbours: &neighbours,
            bonds: &bonds,
            settings: &settings,
        };
        let mut solver = Solver::default();
        solver.begin(
            &spine,
            &SpineShape::at_rest(shape.root, shape.frame, &spine),
        );
        solver.multipliers = vec![0.0, 0.3, 0.0, 0.5, 0.2];
        let energy = solver.look(problem, &shape, &constraints);
        assert!(energy.friction > 0.0 && energy.damping > 0.0 && energy.repulsion > 0.0);
        assert!(energy.bond > 0.0);
        solver.residual(&spine, &shape, &constraints);
        solver.assemble(&spine, &shape);
        let (tangents, hessian) = (solver.model.tangents.clone(), solver.model.hessian.clone());
        let along = |solver: &mut Solver, q: usize, h: f64| -> Vec<f64> {
            let mut moved = shape.clone();
            let d = &mut moved.directions[q / 2];
            *d = (*d + tangents[q / 2].vector(DVec2::AXES[q % 2]) * h).normalize();
            solver.look(problem, &moved, &constraints);
            solver.residual(&spine, &moved, &constraints);
            // The gradient along tangents that are transported along the path.
            let parts = tangents.iter().zip(&shape.directions).enumerate();
            let parts = parts.flat_map(|(j, (tangents, d))| {
                let turn = maulstick_num::geometry::shortest_arc(*d, moved.directions[j]);
                let lagrangian = turn.conjugate() * solver.point.lagrangian[j];
                tangents.of(lagrangian).to_array()
            });
            parts.collect()
        };
        let (size, h) = (8, 1e-5);
        let entry = |p: usize, q: usize| hessian[(p / 2) * 4 + q / 2].col(q % 2)[p % 2];
        let scale = (0..size).fold(0.0, |most: f64, p| most.max(entry(p, p).abs()));
        for q in 0..size {
            let (up, down) = (along(&mut solver, q, h), along(&mut solver, q, -h));
            for p in 0..=q {
                let numeric = (up[p] - down[p]) / (2.0 * h);
                let analytic = entry(p, q);
                assert!(
                    (numeric - analytic).abs() < 1e-6 * scale,
                    "{p} {q}: {numeric} {analytic}"
                );
                assert!(
                    (numeric - analytic - 1e-5 * scale).abs() > 1e-6 * scale,
                    "a fault would pass"
                );
            }
        }
    }
}
