//! Force and torque of a flow on a probe of whole cells: the stress tensor summed over the probe's faces (Baxter 2004,
//! eq. 8.9-8.20), in two and in three dimensions.
//!
//! With the outward normal n of a face, ghosts taken at the wall and a kinematic pressure p (m²/s²) that is multiplied
//! by ρ, the traction on the face toward +y between a cell of the probe and a cell of fluid is
//!
//! ```text
//! P_x = μ·(∂u/∂y + ∂v/∂x)    ∂u/∂y = 2·(u_fluid − u_wall)/Δy
//! P_y = −ρ·p + 2μ·∂v/∂y      ∂v/∂y = (v_next − v_face)/Δy
//! ```
//!
//! The printed normal points into the probe: with it drag would accelerate the hand.

/// Content of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Medium {
    /// Part of the probe.
    Probe,
    /// Cell filled with fluid.
    Fluid,
    /// Air or another solid, without effect on the probe.
    Other,
}

/// Staggered fields around a probe, in `D` dimensions.
pub trait StaggeredFields<const D: usize> {
    /// Cells along each axis.
    fn cells(&self) -> [usize; D];
    /// Side of a cell, m.
    fn cell_m(&self) -> f64;
    /// Content of a cell.
    fn medium(&self, cell: [usize; D]) -> Medium;
    /// Kinematic pressure in a cell, m²/s².
    fn pressure(&self, cell: [usize; D]) -> f64;
    /// Velocity along `axis` on the face of a cell toward the lower end of that axis, m/s. The index along `axis` goes
    /// up to the number of cells; faces within the probe have the probe's velocity.
    fn velocity(&self, axis: usize, face: [usize; D]) -> f64;
    /// Velocity of the probe's surface at a place, m and m/s.
    fn wall_velocity(&self, place: [f64; D]) -> [f64; D];
}

/// Properties of the fluid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluid {
    /// Density ρ, kg/m³.
    pub density_kg_m3: f64,
    /// Kinematic viscosity ν, m²/s.
    pub viscosity_m2_s: f64,
}

impl Fluid {
    /// Dynamic viscosity μ = ρν, Pa·s.
    #[must_use]
    pub fn dynamic_pa_s(&self) -> f64 {
        self.density_kg_m3 * self.viscosity_m2_s
    }
}

/// Stress on one face of the probe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceStress<const D: usize> {
    /// Middle of the face, m.
    pub middle_m: [f64; D],
    /// Unit normal, out of the probe into the fluid.
    pub normal: [f64; D],
    /// Pressure, Pa.
    pub pressure_pa: f64,
    /// Viscous part of σ·n, Pa.
    pub viscous_pa: [f64; D],
    /// Area of the face, m^(D−1).
    pub area: f64,
}

impl<const D: usize> FaceStress<D> {
    /// Force on the face, N (for D = 2, N per metre of depth).
    #[must_use]
    pub fn force(&self) -> [f64; D] {
        std::array::from_fn(|i| {
            self.area * (self.viscous_pa[i] - self.pressure_pa * self.normal[i])
        })
    }
}

/// Force and torque on a probe; for D = 2 per metre of depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench<const D: usize> {
    /// Force, N.
    pub force_n: [f64; D],
    /// Torque about a point, N·m; for D = 2 its third component alone.
    pub torque_n_m: [f64; 3],
}

impl<const D: usize> Wrench<D> {
    /// No force.
    pub const ZERO: Self = Self {
        force_n: [0.0; D],
        torque_n_m: [0.0; 3],
    };

    /// Adds a force that acts at `arm` from the point.
    pub fn add(&mut self, force: [f64; D], arm: [f64; D]) {
        for (sum, part) in self.force_n.iter_mut().zip(force) {
            *sum += part;
        }
        let of = |vector: [f64; D], i: usize| vector.get(i).copied().unwrap_or(0.0);
        for (i, sum) in self.torque_n_m.iter_mut().enumerate() {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            *sum += of(arm, j) * of(force, k) - of(arm, k) * of(force, j);
        }
    }

    /// The wrench of some faces about a point, m.
    #[must_use]
    pub fn of(faces: impl IntoIterator<Item = FaceStress<D>>, about_m: [f64; D]) -> Self {
        let mut wrench = Self::ZERO;
        for face in faces {
            let arm = std::array::from_fn(|i| face.middle_m[i] - about_m[i]);
            wrench.add(face.force(), arm);
        }
        wrench
    }
}

/// Stresses on all faces between a cell of the probe and one of fluid, in the order of the probe's cells.
#[must_use]
pub fn face_stresses<const D: usize>(
    fields: &impl StaggeredFields<D>,
    fluid: Fluid,
) -> Vec<FaceStress<D>> {
    let cells = fields.cells();
    let mut all = Vec::new();
    let mut cell = [0; D];
    for _ in 0..cells.iter().product() {
        if fields.medium(cell) == Medium::Probe {
            for axis in 0..D {
                for side in [Side::Lower, Side::Upper] {
                    let next = neighbour(cell, axis, side, cells);
                    if let Some(next) = next
                        && fields.medium(next) == Medium::Fluid
                    {
                        all.push(face_stress(fields, fluid, next, axis, side));
                    }
                }
            }
        }
        for axis in 0..D {
            cell[axis] += 1;
            if cell[axis] < cells[axis] {
                break;
            }
            cell[axis] = 0;
        }
    }
    all
}

/// Side of a cell along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Lower,
    Upper,
}

fn neighbour<const D: usize>(
    mut cell: [usize; D],
    axis: usize,
    side: Side,
    cells: [usize; D],
) -> Option<[usize; D]> {
    cell[axis] = match side {
        Side::Lower => cell[axis].checked_sub(1)?,
        Side::Upper => cell[axis] + 1,
    };
    (cell[axis] < cells[axis]).then_some(cell)
}

/// Stress on the probe's face toward `cell`, which lies on `side` of the probe along `axis`.
fn face_stress<const D: usize>(
    fields: &impl StaggeredFields<D>,
    fluid: Fluid,
    cell: [usize; D],
    axis: usize,
    side: Side,
) -> FaceStress<D> {
    let (h, mu, cells) = (fields.cell_m(), fluid.dynamic_pa_s(), fields.cells());
    let up = |mut index: [usize; D], axis: usize| {
        index[axis] += 1;
        index
    };
    // The wall's face and the one on the other side of the cell.
    let (sign, wall, far) = match side {
        Side::Upper => (1.0, cell, up(cell, axis)),
        Side::Lower => (-1.0, up(cell, axis), cell),
    };
    let middle_m: [f64; D] = std::array::from_fn(|i| {
        let place = wall[i] as f64;
        h * if i == axis { place } else { place + 0.5 }
    });
    let at_wall = fields.wall_velocity(middle_m);
    let normal_velocity = |face| fields.velocity(axis, face);
    let stretching = sign * (normal_velocity(far) - normal_velocity(wall)) / h;
    let viscous_pa = std::array::from_fn(|i| {
        if i == axis {
            return sign * 2.0 * mu * stretching;
        }
        let beside = 0.5 * (fields.velocity(i, cell) + fields.velocity(i, up(cell, i)));
        let across = sign * 2.0 * (beside - at_wall[i]) / h;
        let mut below = wall;
        let mut above = wall;
        below[i] = wall[i].saturating_sub(1);
        above[i] = (wall[i] + 1).min(cells[i] - 1);
        let span = (above[i] - below[i]).max(1) as f64 * h;
        let along = (normal_velocity(above) - normal_velocity(below)) / span;
        sign * mu * (across + along)
    });
    let mut normal = [0.0; D];
    normal[axis] = sign;
    FaceStress {
        middle_m,
        normal,
        pressure_pa: fluid.density_kg_m3 * fields.pressure(cell),
        viscous_pa,
        area: (1..D).fold(1.0, |area, _| area * h),
    }
}

#[cfg(test)]
mod tests;
