//! Flows with known answers between plane walls and under a plane surface.

mod common;

use std::f64::consts::PI;

use common::{BETWEEN, PERIODIC, conditions, full, worst};
use maulstick_num::{cos, sin};
use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Flow, Scheme};
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;

/// Duration of a step after which the flow is steady, s.
const LONG_S: f64 = 1e6;

/// Velocities along x of a channel of `cells` cells, under an acceleration of 1, from the lower wall on.
fn channel(cells: usize, scheme: Scheme, paint: Paint, steps: usize) -> Vec<f64> {
    let grid = Grid {
        cells: [4, cells, 4],
        ends: [PERIODIC, BETWEEN, PERIODIC],
    };
    let mut flow = Flow::new(&grid);
    flow.scheme = scheme;
    let solids = Solids::walls(&grid);
    for _ in 0..steps {
        flow.step(
            &full(&grid),
            &solids,
            &conditions(paint, LONG_S, [1.0, 0.0, 0.0]),
        );
    }
    let at = |y| f64::from(flow.velocity[0][grid.at([1, y, 1])]);
    (0..cells as isize).map(at).collect()
}

/// u = G/(2μ)·y(H − y) + Gh²/(8μ) at every node.
#[test]
fn plane_poiseuille_has_its_parabola() {
    for scheme in [Scheme::Unified, Scheme::Split] {
        for cells in [8, 16, 32] {
            let got = channel(cells, scheme, Paint::newtonian(1.0), 3);
            let off = |viscosity: f64| {
                let want = |node: usize| {
                    let y = node as f64 + 0.5;
                    (0.5 * y * (cells as f64 - y) + 0.125) / viscosity
                };
                worst(
                    got.iter()
                        .enumerate()
                        .map(|(node, got)| got / want(node) - 1.0),
                )
            };
            println!("{scheme:?}, {cells} cells: {:.1e}", off(1.0));
            let bound = if scheme == Scheme::Unified {
                1e-5
            } else {
                2e-5
            };
            assert!(off(1.0) < bound, "{}", off(1.0));
            assert!(off(1.0001) > bound, "another viscosity passes");
        }
    }
}

/// Nusselt's film, shear-free at the top: u = (G/μ)(Hy − y²/2) + Gh²/(8μ), for a surface anywhere in a cell; the
/// pressure is the weight above.
#[test]
fn a_film_is_exact_wherever_its_surface_lies_in_a_cell() {
    let ends = Ends::Sides([Side::NoSlip, Side::Slip]);
    let grid = Grid {
        cells: [4, 20, 4],
        ends: [PERIODIC, ends, PERIODIC],
    };
    for height in [8.0, 8.3, 11.5, 7.7, 15.9] {
        let mut flow = Flow::new(&grid);
        let solids = Solids::walls(&grid);
        let fill = |place| (height - grid.cell(place)[1] as f64).clamp(0.0, 1.0) as f32;
        let fill: Vec<f32> = (0..grid.len()).map(fill).collect();
        for _ in 0..3 {
            flow.step(
                &fill,
                &solids,
                &conditions(Paint::newtonian(1.0), LONG_S, [1.0, -1.0, 0.0]),
            );
        }
        let nodes = height as usize;
        let off = |height: f64| {
            let nodes = (0..nodes).map(|node| {
                let y = node as f64 + 0.5;
                let want = height * y - 0.5 * y * y + 0.125;
                let got = f64::from(flow.velocity[0][grid.at([1, node as isize, 1])]);
                (got - want) / (0.5 * height * height)
            });
            worst(nodes)
        };
        assert!(off(height) < 1e-5, "{height}: {}", off(height));
        assert!(off(height + 1e-3) > 1e-5, "another height passes");
        let bottom = f64::from(flow.pressure[grid.at([1, 0, 1])]);
        assert!((bottom - (height - 0.5)).abs() < 1e-4, "{height}: {bottom}");
    }
}

/// A canvas whose height is anywhere in a cell: the film over it flows as if the grid began there, to half the square
/// of the distance of the lowest velocity.
#[test]
fn a_film_knows_where_in_a_cell_its_canvas_lies() {
    let ends = Ends::Sides([Side::NoSlip, Side::Slip]);
    let grid = Grid {
        cells: [4, 16, 4],
        ends: [PERIODIC, ends, PERIODIC],
    };
    let top = 12.0;
    for (floor, lowest, bound) in [
        (0.2, 0, 1e-4),
        (0.4, 0, 1e-4),
        (0.7, 1, 1e-2),
        (1.6, 2, 1e-2),
    ] {
        let mut flow = Flow::new(&grid);
        let mut solids = Solids::walls(&grid);
        solids.add(&grid, |corner| corner[1] - floor as f32);
        let fill = |place| (top - grid.cell(place)[1] as f64).clamp(0.0, 1.0) as f32;
        let fill: Vec<f32> = (0..grid.len()).map(fill).collect();
        let paint = Paint::newtonian(1.0);
        for _ in 0..3 {
            flow.step(&fill, &solids, &conditions(paint, LONG_S, [1.0, 0.0, 0.0]));
        }
        let off = |floor: f64| {
            let height = top - floor;
            let nearest = f64::from(lowest) + 0.5 - floor;
            let nodes = (lowest..12).map(|node| {
                let y = f64::from(node) + 0.5 - floor;
                let want = height * y - 0.5 * y * y + 0.5 * nearest * nearest;
                let got = f64::from(flow.velocity[0][grid.at([1, node as isize, 1])]);
                (got - want) / (0.5 * height * height)
            });
            worst(nodes)
        };
        println!("canvas at {floor}: {:.1e}", off(floor));
        assert!(off(floor) < bound, "{floor}: {}", off(floor));
        assert!(off(floor + 0.1) > bound, "another canvas passes");
    }
}

/// A row of vortices decays by 1/(1 + νΔt·λ) a step, λ·h² of the lattice.
#[test]
fn taylor_green_vortices_decay_as_the_lattice_says() {
    let cells = 32;
    let grid = Grid {
        cells: [cells, cells, 1],
        ends: [PERIODIC; 3],
    };
    let k = 2.0 * PI / cells as f64;
    // 1.99358273 for a side of 2π.
    let lambda = 1.993_582_73 * k * k;
    for scheme in [Scheme::Unified, Scheme::Split] {
        let mut flow = Flow::new(&grid);
        flow.scheme = scheme;
        for place in grid.places() {
            let [x, y, _] = grid.cell(place).map(|at| at as f64);
            flow.velocity[0][place] = (cos(k * x) * sin(k * (y + 0.5))) as f32;
            flow.velocity[1][place] = -(sin(k * (x + 0.5)) * cos(k * y)) as f32;
        }
        let start = flow.velocity[0].clone();
        for _ in 0..100 {
            let conditions = conditions(Paint::newtonian(1.0), 0.5, [0.0; 3]);
            flow.step(&full(&grid), &Solids::walls(&grid), &conditions);
        }
        let off = |lambda: f64| {
            let decay = (0..100).fold(1.0, |left, _| left / (1.0 + 0.5 * lambda));
            let pairs = grid
                .places()
                .map(|place| [flow.velocity[0][place], start[place]]);
            worst(pairs.map(|[u, start]| f64::from(u) / decay - f64::from(start)))
        };
        assert!(off(lambda) < 1e-4, "{scheme:?}: {}", off(lambda));
        assert!(off(1.0001 * lambda) > 1e-4, "another eigenvalue passes");
    }
}

/// Stokes' first problem: a plate that starts to move; erfc(y/2√νt).
#[test]
fn a_plate_drags_paint_as_stokes_has_it() {
    let cells = 256;
    let grid = Grid {
        cells: [1, cells, 1],
        ends: [PERIODIC, BETWEEN, PERIODIC],
    };
    for scheme in [Scheme::Unified, Scheme::Split] {
        let mut flow = Flow::new(&grid);
        flow.scheme = scheme;
        let mut solids = Solids::walls(&grid);
        for place in 0..grid.len() {
            if grid.cell(place)[1] < 0 {
                solids.velocity[0][place] = 1.0;
            }
        }
        // √νt is 32 cells.
        for _ in 0..400 {
            let conditions = conditions(Paint::newtonian(1.0), 1024.0 / 400.0, [0.0; 3]);
            flow.step(&full(&grid), &solids, &conditions);
        }
        for (y, want) in [(32, 0.479_500), (64, 0.157_299)] {
            let around = [y - 1, y].map(|y| f64::from(flow.velocity[0][grid.at([0, y, 0])]));
            let got = 0.5 * (around[0] + around[1]);
            println!("{scheme:?} at {y}: {got:.6}, {want}");
            assert!((got / want - 1.0).abs() < 5e-3, "{got} {want}");
        }
    }
}

/// A Bingham fluid in a channel: a plug of width 2τ_y/G moves at G(a − τ_y/G)²/2μ, with a half the width.
#[test]
fn a_plug_moves_as_bingham_has_it() {
    let cells = 64;
    let half = 0.5 * cells as f64;
    let plug = 16.0;
    let paint = Paint {
        yields: plug,
        ..Paint::newtonian(1.0)
    };
    let got = channel(cells, Scheme::Unified, paint, 60);
    let off = |plug: f64| {
        let nodes = got.iter().enumerate().map(|(node, got)| {
            let from_middle = (node as f64 + 0.5 - half).abs().max(plug);
            let sheared = half - from_middle;
            let want = 0.5 * (half - plug) * (half - plug)
                - 0.5 * (from_middle - plug) * (from_middle - plug);
            assert!(sheared >= 0.0);
            (got - want) / (0.5 * (half - plug) * (half - plug))
        });
        worst(nodes)
    };
    println!("plug: {:.2e}", off(plug));
    assert!(off(plug) < 0.01, "{}", off(plug));
    assert!(off(plug + 0.2) > 0.01, "another yield stress passes");
}
