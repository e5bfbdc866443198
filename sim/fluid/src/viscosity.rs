//! Implicit viscosity of the velocities along one axis: backward Euler on the faces across it.

use crate::five_point::FivePoint;
use crate::geometry::Geometry;

/// A link between a face of the fluid and one that a solid holds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolidLink {
    /// The face of the fluid.
    pub(crate) outer: usize,
    /// The face within the solid.
    pub(crate) inner: usize,
    /// Axis along which it lies.
    pub(crate) along: usize,
}

/// The equations of the faces across an axis, and the links to solids among them.
pub(crate) struct Diffusion<'a> {
    geometry: &'a Geometry,
    axis: usize,
    /// Number of faces along x and y.
    faces: [usize; 2],
    /// Viscosity times step by the square of a cell.
    rate: f64,
    pub(crate) system: FivePoint,
    pub(crate) right_side: Vec<f64>,
    pub(crate) solid_links: Vec<SolidLink>,
}

impl<'a> Diffusion<'a> {
    /// The masses of the open faces, and their momenta; faces that a solid holds take its velocity.
    pub(crate) fn new(
        geometry: &'a Geometry,
        axis: usize,
        faces: [usize; 2],
        rate: f64,
        values: &mut [f64],
    ) -> Self {
        let mut system = FivePoint::new(faces[0], faces[1]);
        let mut right_side = vec![0.0; values.len()];
        for (at, value) in values.iter_mut().enumerate() {
            if geometry.is_fixed(axis, at) {
                *value = geometry.rigid[axis][at];
            } else {
                let mass = 1.0 - geometry.solid[axis][at];
                system.diagonal[at] = mass;
                right_side[at] = mass * *value;
            }
        }
        Self {
            geometry,
            axis,
            faces,
            rate,
            system,
            right_side,
            solid_links: Vec::new(),
        }
    }

    /// Adds the walls of the grid: beside a row of faces they are half a cell away, and stand.
    pub(crate) fn add_walls(&mut self) {
        let [width, _] = self.faces;
        let beside = 1 - self.axis;
        for at in 0..self.right_side.len() {
            let place = [at % width, at / width][beside];
            let is_outermost = place == 0 || place + 1 == self.faces[beside];
            if !self.geometry.is_fixed(self.axis, at) && is_outermost {
                self.system.diagonal[at] += 2.0 * self.rate;
            }
        }
    }

    /// Adds the stress between neighbours along x and y.
    pub(crate) fn add_links(&mut self, values: &[f64]) {
        let [width, _] = self.faces;
        for along in 0..2 {
            let stride = [1, width][along];
            for at in 0..values.len() {
                if [at % width, at / width][along] + 1 < self.faces[along] {
                    self.add_link(along, [at, at + stride], values);
                }
            }
        }
    }

    fn add_link(&mut self, along: usize, [at, next]: [usize; 2], values: &[f64]) {
        let (geometry, axis) = (self.geometry, self.axis);
        let (system, right_side) = (&mut self.system, &mut self.right_side);
        let rigid = &geometry.rigid[axis];
        let coupling = geometry.links[axis][along][at];
        // The solid's own motion does not strain it.
        let own_motion = self.rate * (coupling - 1.0) * (rigid[next] - rigid[at]);
        let coupling = self.rate * coupling;
        let [outer, inner] = match (geometry.is_fixed(axis, at), geometry.is_fixed(axis, next)) {
            (true, true) => return,
            (false, false) => {
                system.diagonal[at] += coupling;
                system.diagonal[next] += coupling;
                right_side[at] -= own_motion;
                right_side[next] += own_motion;
                let row = match along {
                    0 => &mut system.right,
                    _ => &mut system.up,
                };
                row[at] = coupling;
                return;
            }
            (false, true) => {
                system.diagonal[at] += coupling;
                right_side[at] += coupling * values[next] - own_motion;
                [at, next]
            }
            (true, false) => {
                system.diagonal[next] += coupling;
                right_side[next] += coupling * values[at] + own_motion;
                [next, at]
            }
        };
        self.solid_links.push(SolidLink {
            outer,
            inner,
            along,
        });
    }
}
