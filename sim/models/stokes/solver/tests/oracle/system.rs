//! A basin of paint as one dense system of linear equations.
//!
//! A step minimises a sum of squares: of the change of each velocity, weighted by the mass of its face, and of each
//! rate of strain, weighted by the strained paint; every cell's inflow must equal its outflow. No constant and no code
//! is shared with the solver.

/// Fault that a comparison with the basin has to find.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    /// Shear is the gradient of one velocity alone.
    WithoutCrossTerm,
    /// Walls are a whole cell away.
    FullWalls,
    /// Air holds the velocities beside it.
    SurfaceSticks,
    /// Normal stress without its factor of two.
    HalfNormal,
}

/// A basin between walls, of which the one at x = 0 moves.
pub(crate) struct Basin {
    pub cells: [usize; 3],
    /// Fill of the cells, x fastest.
    pub fill: Vec<f64>,
    /// Velocity of the moving wall.
    pub lid: [f64; 3],
    /// Velocity of each [face](Self::face) before.
    pub before: Vec<f64>,
    /// Viscosity by the square of a cell and the step.
    pub tau: f64,
    /// Velocity added by the body force in a step.
    pub pull: [f64; 3],
}

/// Unknowns and their values: velocities, then pressures.
pub(crate) struct Solution {
    pub faces: Vec<(usize, [usize; 3])>,
    pub wet: Vec<[usize; 3]>,
    pub values: Vec<f64>,
}

/// A velocity in a sum: an unknown, a number, or absent.
#[derive(Clone, Copy, PartialEq)]
enum Velocity {
    Unknown(usize),
    Wall(f64),
    Air,
}

impl Basin {
    /// Number of the lower face of a cell across an axis.
    pub(crate) fn face(&self, axis: usize, cell: [usize; 3]) -> usize {
        let [x, y, z] = cell;
        let [nx, ny, nz] = self.cells.map(|cells| cells + 1);
        x + nx * (y + ny * (z + nz * axis))
    }

    fn filled(&self, cell: [isize; 3]) -> Option<f64> {
        let inside = (0..3).all(|a| cell[a] >= 0 && cell[a] < self.cells[a] as isize);
        let [x, y, z] = cell.map(|at| at.max(0) as usize);
        inside.then(|| self.fill[x + self.cells[0] * (y + self.cells[1] * z)])
    }

    /// A cell has a pressure from a fill of a tenth on.
    fn is_wet(&self, cell: [isize; 3]) -> bool {
        self.filled(cell).is_some_and(|fill| fill >= 0.1)
    }

    fn all_cells(&self) -> Vec<[isize; 3]> {
        let [nx, ny, nz] = self.cells.map(|cells| cells as isize);
        let mut all = Vec::new();
        for z in 0..nz {
            for y in 0..ny {
                all.extend((0..nx).map(|x| [x, y, z]));
            }
        }
        all
    }

    /// The step, by elimination.
    pub(crate) fn solve(&self, fault: Option<Fault>) -> Solution {
        let mut faces = Vec::new();
        for axis in 0..3 {
            for cell in self.all_cells() {
                let mut before = cell;
                before[axis] -= 1;
                if cell[axis] > 0 && (self.is_wet(cell) || self.is_wet(before)) {
                    faces.push((axis, cell.map(|at| at as usize)));
                }
            }
        }
        let wet: Vec<[usize; 3]> = (self.all_cells().into_iter())
            .filter(|cell| self.is_wet(*cell))
            .map(|cell| cell.map(|at| at as usize))
            .collect();
        let size = faces.len() + wet.len();
        let mut system = vec![vec![0.0; size + 1]; size];
        let velocity = |axis: usize, cell: [isize; 3]| {
            let at = cell.map(|at| at.max(0) as usize);
            let found = faces
                .iter()
                .position(|face| cell.iter().all(|at| *at >= 0) && *face == (axis, at));
            let beyond = (0..3).any(|a| {
                cell[a] < 0 || cell[a] >= self.cells[a] as isize || a == axis && cell[a] == 0
            });
            match found {
                Some(number) => Velocity::Unknown(number),
                None if beyond => Velocity::Wall(if cell[0] < 0 { self.lid[axis] } else { 0.0 }),
                None => Velocity::Air,
            }
        };
        self.add_inertia(&faces, &mut system);
        self.add_strains(&velocity, fault, &mut system);
        for (number, cell) in wet.iter().enumerate() {
            let row = faces.len() + number;
            for axis in 0..3 {
                let mut above = cell.map(|at| at as isize);
                for sign in [-1.0, 1.0] {
                    match velocity(axis, above) {
                        Velocity::Unknown(column) => {
                            system[row][column] += sign;
                            system[column][row] -= sign;
                        }
                        Velocity::Wall(u) => system[row][size] -= sign * u,
                        Velocity::Air => {}
                    }
                    above[axis] += 1;
                }
            }
        }
        Solution {
            faces,
            wet,
            values: eliminate(system),
        }
    }

    fn add_inertia(&self, faces: &[(usize, [usize; 3])], system: &mut [Vec<f64>]) {
        let last = system.len();
        for (number, (axis, cell)) in faces.iter().enumerate() {
            let cell_here = cell.map(|at| at as isize);
            let mut before = cell_here;
            before[*axis] -= 1;
            let paint = |cell| {
                self.filled(cell)
                    .filter(|_| self.is_wet(cell))
                    .unwrap_or(0.0)
            };
            let mass = (0.5 * (paint(cell_here) + paint(before))).max(0.05);
            let u = self.before[self.face(*axis, *cell)] + self.pull[*axis];
            system[number][number] += mass;
            system[number][last] += mass * u;
        }
    }

    fn add_strains(
        &self,
        velocity: &impl Fn(usize, [isize; 3]) -> Velocity,
        fault: Option<Fault>,
        system: &mut [Vec<f64>],
    ) {
        for cell in self.all_cells() {
            if self.is_wet(cell) {
                self.add_normal_strains(cell, velocity, fault, system);
            }
        }
        let [nx, ny, nz] = self.cells.map(|cells| cells as isize);
        for z in 0..=nz {
            for (y, x) in (0..=ny).flat_map(|y| (0..=nx).map(move |x| (y, x))) {
                for axes in [[0, 1], [0, 2], [1, 2]] {
                    self.add_shear([x, y, z], axes, velocity, fault, system);
                }
            }
        }
    }

    /// The gradients of a cell's velocities along their own axes.
    fn add_normal_strains(
        &self,
        cell: [isize; 3],
        velocity: &impl Fn(usize, [isize; 3]) -> Velocity,
        fault: Option<Fault>,
        system: &mut [Vec<f64>],
    ) {
        let factor = if fault == Some(Fault::HalfNormal) {
            1.0
        } else {
            2.0
        };
        let weight = factor * self.tau * self.filled(cell).unwrap_or(0.0);
        for axis in 0..3 {
            let terms = [
                (velocity(axis, step(cell, axis, 1)), 1.0),
                (velocity(axis, cell), -1.0),
            ];
            add_square(system, weight, &terms);
        }
    }

    /// The shear in the plane of two axes, on the edge at a cell's lower corner.
    fn add_shear(
        &self,
        cell: [isize; 3],
        [a, b]: [usize; 2],
        velocity: &impl Fn(usize, [isize; 3]) -> Velocity,
        fault: Option<Fault>,
        system: &mut [Vec<f64>],
    ) {
        let pairs = [
            [velocity(a, cell), velocity(a, step(cell, b, -1))],
            [velocity(b, cell), velocity(b, step(cell, a, -1))],
        ];
        let is_wall = |u: &Velocity| matches!(u, Velocity::Wall(_));
        let is_free = pairs.iter().flatten().any(|u| *u == Velocity::Air);
        if is_free && fault != Some(Fault::SurfaceSticks) {
            return;
        }
        let near = if fault == Some(Fault::FullWalls) {
            1.0
        } else {
            0.5
        };
        let distance = pairs.map(|[one, other]| {
            if is_wall(&one) == is_wall(&other) {
                1.0
            } else {
                near
            }
        });
        let corners = [
            cell,
            step(cell, a, -1),
            step(cell, b, -1),
            step(step(cell, a, -1), b, -1),
        ];
        let paint: f64 = corners.iter().filter_map(|cell| self.filled(*cell)).sum();
        let share = if pairs.iter().flatten().any(is_wall) {
            1.0
        } else {
            0.25 * paint
        };
        let mut terms = Vec::new();
        for (which, [one, other]) in pairs.into_iter().enumerate() {
            if which == 0 || fault != Some(Fault::WithoutCrossTerm) {
                terms.extend([
                    (one, 1.0 / distance[which]),
                    (other, -1.0 / distance[which]),
                ]);
            }
        }
        add_square(system, self.tau * share * distance[0] * distance[1], &terms);
    }
}

/// The cell that is `by` cells farther along an axis.
fn step(mut cell: [isize; 3], axis: usize, by: isize) -> [isize; 3] {
    cell[axis] += by;
    cell
}

/// Adds half of a weight times the square of a sum to the objective.
fn add_square(system: &mut [Vec<f64>], weight: f64, terms: &[(Velocity, f64)]) {
    let last = system.len();
    for (row, by) in terms {
        let Velocity::Unknown(row) = row else {
            continue;
        };
        for (column, other) in terms {
            match column {
                Velocity::Unknown(column) => system[*row][*column] += weight * by * other,
                Velocity::Wall(u) => system[*row][last] -= weight * by * other * u,
                Velocity::Air => {}
            }
        }
    }
}

/// Gauss' elimination with the largest pivot of a column.
fn eliminate(mut system: Vec<Vec<f64>>) -> Vec<f64> {
    let size = system.len();
    for column in 0..size {
        let largest = |a: &usize, b: &usize| {
            system[*a][column]
                .abs()
                .total_cmp(&system[*b][column].abs())
        };
        let pivot = (column..size).max_by(largest).expect("a row");
        system.swap(column, pivot);
        let (above, below) = system.split_at_mut(column + 1);
        let top = &above[column];
        for row in below.iter_mut().filter(|row| row[column] != 0.0) {
            let factor = row[column] / top[column];
            for (value, top) in row.iter_mut().zip(top).skip(column) {
                *value -= factor * top;
            }
        }
    }
    let mut values = vec![0.0; size];
    for row in (0..size).rev() {
        let known: f64 = (row + 1..size)
            .map(|column| system[row][column] * values[column])
            .sum();
        values[row] = (system[row][size] - known) / system[row][row];
    }
    values
}
