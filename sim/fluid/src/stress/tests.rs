//! Flows with a known stress: plane Couette and Poiseuille flow, still fluid under pressure, in two and three
//! dimensions; and the misprints, which must fail.

use super::*;

/// Fields given by formulas, sampled at the places of a staggered grid.
struct Formula<const D: usize> {
    cells: [usize; D],
    cell_m: f64,
    medium: fn([usize; D]) -> Medium,
    pressure: fn([f64; D]) -> f64,
    velocity: fn([f64; D]) -> [f64; D],
    wall: fn([f64; D]) -> [f64; D],
}

impl<const D: usize> StaggeredFields<D> for Formula<D> {
    fn cells(&self) -> [usize; D] {
        self.cells
    }
    fn cell_m(&self) -> f64 {
        self.cell_m
    }
    fn medium(&self, cell: [usize; D]) -> Medium {
        (self.medium)(cell)
    }
    fn pressure(&self, cell: [usize; D]) -> f64 {
        (self.pressure)(std::array::from_fn(|i| {
            self.cell_m * (cell[i] as f64 + 0.5)
        }))
    }
    fn velocity(&self, axis: usize, face: [usize; D]) -> f64 {
        let place = std::array::from_fn(|i| {
            let whole = face[i] as f64;
            self.cell_m * if i == axis { whole } else { whole + 0.5 }
        });
        (self.velocity)(place)[axis]
    }
    fn wall_velocity(&self, place: [f64; D]) -> [f64; D] {
        (self.wall)(place)
    }
}

const FLUID: Fluid = Fluid {
    density_kg_m3: 1200.0,
    viscosity_m2_s: 3e-3,
};
const MU: f64 = 3.6;

/// A wall of the two lowest rows of 8 × 8 cells of 10 mm, its top at 20 mm.
fn wall_2d(velocity: fn([f64; 2]) -> [f64; 2], pressure: fn([f64; 2]) -> f64) -> Formula<2> {
    Formula {
        cells: [8, 8],
        cell_m: 0.01,
        medium: |[_, j]| match j {
            0 | 1 => Medium::Probe,
            _ => Medium::Fluid,
        },
        pressure,
        velocity,
        wall: |_| [0.0; 2],
    }
}

/// The wrench with a fault applied to each face.
fn faulty<const D: usize>(fields: &Formula<D>, fault: impl Fn(&mut FaceStress<D>)) -> Wrench<D> {
    let mut faces = face_stresses(fields, FLUID);
    faces.iter_mut().for_each(fault);
    Wrench::of(faces, [0.0; D])
}

fn close<const D: usize>(wrench: Wrench<D>, force: [f64; D]) -> bool {
    println!("{wrench:?}, expected {force:?}");
    (0..D).all(|i| (wrench.force_n[i] - force[i]).abs() < 1e-9)
}

#[test]
fn the_shear_of_plane_couette_flow_is_exact() {
    // u = γ(y − 20 mm), γ = 50/s: μγ on 80 mm of wall, and 7 m²/s² of pressure.
    let couette = wall_2d(|[_, y]| [50.0 * (y - 0.02).max(0.0), 0.0], |_| 7.0);
    let expected = [MU * 50.0 * 0.08, -1200.0 * 7.0 * 0.08];
    assert!(close(faulty(&couette, |_| {}), expected));
    // Seeded faults: the printed normal, and an unscaled kinematic pressure.
    let inward = faulty(&couette, |face| {
        face.normal = face.normal.map(|n| -n);
        face.viscous_pa = face.viscous_pa.map(|p| -p);
    });
    assert!(!close(inward, expected));
    assert!(!close(
        faulty(&couette, |face| face.pressure_pa /= 1200.0),
        expected
    ));
    // The printed eq. 8.18 has ∂v/∂y in the place of the shear: it finds none.
    let printed = faulty(&couette, |face| {
        face.viscous_pa[0] = face.viscous_pa[1] / 2.0
    });
    assert!(!close(printed, expected));
}

#[test]
fn the_pressure_and_shear_of_plane_poiseuille_flow_are_those_of_the_channel() {
    // u = G·s(w − s)/2ν over s = y − 20 mm in a channel w = 60 mm wide, p = −G·x, G = 2 m/s². The wall shear is
    // ρGw/2; half a cell from the wall u/s falls short by (h/2)/w.
    let flow = |[_, y]: [f64; 2]| {
        let s: f64 = y - 0.02;
        [
            if s > 0.0 {
                2.0 * s * (0.06 - s) / (2.0 * 3e-3)
            } else {
                0.0
            },
            0.0,
        ]
    };
    let poiseuille = wall_2d(flow, |[x, _]| -2.0 * x);
    let shear = 1200.0 * 2.0 * 0.06 / 2.0 * 0.08 * (1.0 - 0.005 / 0.06);
    let pressure = 1200.0 * 2.0 * 0.08 * 0.08 / 2.0;
    assert!(close(faulty(&poiseuille, |_| {}), [shear, pressure]));
    // The printed pressure term, −p_x·n_x, has a gradient in the place of p.
    let gradient = faulty(&poiseuille, |face| face.pressure_pa = 1200.0 * -2.0);
    assert!(!close(gradient, [shear, pressure]));
}

#[test]
fn a_solid_that_turns_with_its_fluid_feels_no_viscous_force() {
    let turning = Formula {
        cells: [9, 9, 9],
        cell_m: 0.01,
        medium: |cell| {
            if cell.iter().all(|i| (3..6).contains(i)) {
                Medium::Probe
            } else {
                Medium::Fluid
            }
        },
        pressure: |_| 0.0,
        // Ω about the middle at 45 mm.
        velocity: |[x, y, z]| {
            let [x, y, z] = [x, y, z].map(|it: f64| it - 0.045);
            [2.0 * z - 3.0 * y, 3.0 * x - z, y - 2.0 * x]
        },
        wall: |[x, y, z]| {
            let [x, y, z] = [x, y, z].map(|it: f64| it - 0.045);
            [2.0 * z - 3.0 * y, 3.0 * x - z, y - 2.0 * x]
        },
    };
    let wrench = Wrench::of(face_stresses(&turning, FLUID), [0.045; 3]);
    println!("{wrench:?}");
    let most = wrench.force_n.iter().chain(&wrench.torque_n_m);
    assert!(most.into_iter().all(|part| part.abs() < 1e-12));
    // A solid that stands in it is turned on.
    let standing = Formula {
        wall: |_| [0.0; 3],
        ..turning
    };
    let turned = Wrench::of(face_stresses(&standing, FLUID), [0.045; 3]).torque_n_m;
    assert!(
        turned
            .iter()
            .zip([1.0, 2.0, 3.0])
            .all(|(t, axis)| t / axis > 1e-5),
        "{turned:?}"
    );
}

#[test]
fn a_cube_in_a_pressure_gradient_floats_and_air_does_not_press() {
    let cube = |top: Medium| Formula {
        cells: [8, 8, 8],
        cell_m: 0.01,
        medium: match top {
            Medium::Fluid => |[i, j, k]: [usize; 3]| match [i, j, k] {
                [2..5, 2..5, 2..5] => Medium::Probe,
                _ => Medium::Fluid,
            },
            _ => |[i, j, k]: [usize; 3]| match [i, j, k] {
                [2..5, 2..5, 2..5] => Medium::Probe,
                [.., k] if k >= 5 => Medium::Other,
                _ => Medium::Fluid,
            },
        },
        pressure: |[_, _, z]| 9.81 * (1.0 - z),
        velocity: |_| [0.0; 3],
        wall: |_| [0.0; 3],
    };
    // Archimedes: the pressure rises by half a cell beyond each face.
    let weight = 1200.0 * 9.81 * 0.03 * 0.03 * 0.04;
    let floats = Wrench::of(face_stresses(&cube(Medium::Fluid), FLUID), [0.0; 3]);
    assert!(close(floats, [0.0, 0.0, weight]));
    let lifted = Wrench::of(face_stresses(&cube(Medium::Other), FLUID), [0.0; 3]);
    let below = 1200.0 * 9.81 * (1.0 - 0.015) * 0.03 * 0.03;
    assert!(close(lifted, [0.0, 0.0, below]));
}
