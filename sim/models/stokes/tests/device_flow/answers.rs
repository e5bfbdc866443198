//! Known answers on the device.

use maulstick_stokes::body::{Rod, voxelise};
use maulstick_stokes::domain::{Domain, LEAST_FILL, Solids};
use maulstick_stokes::flow::{Conditions, Effort, Flow};
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;
use maulstick_stokes_paint::device::{FlowState, GpuFlow, Tuning};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

use super::device;
use super::scenes::{WALLS, filled};
use super::unit;

const fn conditions(viscosity: f64, seconds: f64, pull: [f64; 3]) -> Conditions {
    Conditions {
        cell_m: 1.0,
        seconds,
        paint: Paint::newtonian(viscosity),
        pull,
    }
}

/// u = G/(2μ)·y(H − y) + Gh²/(8μ) at every node.
#[test]
fn plane_poiseuille_has_its_parabola() {
    const BOUND: f64 = 2e-5;
    for cells in [8, 16, 32] {
        let grid = Grid {
            cells: [4, cells, 4],
            ends: [Ends::Periodic, WALLS, Ends::Periodic],
        };
        let mut flow = GpuFlow::new(device(), &grid, Effort::default()).expect("made");
        let solids = Solids::walls(&grid);
        let fill = vec![1.0; grid.len()];
        for _ in 0..3 {
            flow.step(&fill, &solids, &conditions(1.0, 1e6, [1.0, 0.0, 0.0]))
                .expect("a step");
        }
        let state = flow.read().expect("read");
        let off = |viscosity: f64| {
            let node = |node: usize| {
                let y = node as f64 + 0.5;
                let want = (0.5 * y * (cells as f64 - y) + 0.125) / viscosity;
                let got = state.velocity[0][grid.at([1, node as isize, 1])];
                (f64::from(got) / want - 1.0).abs()
            };
            (0..cells).map(node).fold(0.0, f64::max)
        };
        println!("{cells} cells: {:.1e}", off(1.0));
        assert!(off(1.0) < BOUND, "{cells}: {}", off(1.0));
        assert!(off(1.0001) > BOUND, "another viscosity passes");
    }
}

/// A processor's flow with the device's velocities.
fn flow_of(grid: &Grid, state: &FlowState) -> Flow {
    let mut flow = Flow::new(grid);
    flow.velocity = state.velocity.clone();
    flow
}

/// A rod in a pool of cells, and their fill.
fn pool(cells: [usize; 3], x: f32) -> (Grid, Vec<f32>, Solids) {
    let grid = Grid::walled(cells);
    let [_, height, depth] = cells.map(|cells| cells as f32);
    let fill = filled(&grid, |_, _| (0.44 * depth).floor() + 0.3);
    let mut solids = Solids::walls(&grid);
    let rod = Rod {
        ends: [[x, 0.5 * height, 0.25 * depth], [x, 0.5 * height, depth]],
        radius: 2.0,
        velocity: [[0.025, 0.0, 0.0]; 2],
    };
    voxelise(&grid, &mut solids, &[rod]);
    (grid, fill, solids)
}

/// The outflow of a cell equals its inflow, to 1e-5 of the brush's speed.
#[test]
fn the_velocity_is_free_of_divergence() {
    for viscosity in [1e-6, 1e-2, 1e2] {
        let conditions = Conditions {
            cell_m: 2.5e-4,
            seconds: 0.01,
            paint: Paint::newtonian(viscosity),
            pull: [0.0; 3],
        };
        let divergence = |projections: usize| {
            let effort = Effort {
                steps: 8,
                projections,
            };
            let (grid, ..) = pool([24, 16, 12], 6.0);
            let mut flow = GpuFlow::new(device(), &grid, effort).expect("made");
            flow.relief = 0.0;
            let mut worst = 0.0f64;
            for step in 0..2u8 {
                let (grid, fill, solids) = pool([24, 16, 12], 6.0 + f32::from(step));
                flow.step(&fill, &solids, &conditions).expect("a step");
                let state = flow.read().expect("read");
                let domain = Domain::new(&grid, &fill, &solids, LEAST_FILL);
                let found = flow_of(&grid, &state).divergence(&domain, &solids);
                worst = if found <= worst { worst } else { found };
            }
            worst
        };
        let found = divergence(Effort::default().projections);
        println!("{viscosity} m²/s: {found:.1e}");
        assert!(found < 1e-5, "{viscosity}: {found:e}");
        if viscosity == 1e-2 {
            assert!(divergence(0) > 1e-5, "without projections it passes too");
        }
    }
}

/// Volume deficit, before and after each of eight conjugate gradients with multigrid.
fn falls(cells: [usize; 3], fault: Option<(&'static str, f64)>) -> Vec<f32> {
    let (grid, fill, solids) = pool(cells, 0.3 * cells[0] as f32);
    let tuning = Tuning {
        fault,
        ..Tuning::default()
    };
    let effort = Effort {
        steps: 0,
        projections: 8,
    };
    let mut flow = GpuFlow::tuned(device(), &grid, effort, &tuning).expect("made");
    let conditions = Conditions {
        cell_m: 2.5e-4,
        seconds: 0.01,
        paint: Paint::newtonian(1e-2),
        pull: [0.0; 3],
    };
    flow.step(&fill, &solids, &conditions).expect("a step");
    flow.read().expect("read").lacking
}

#[test]
fn the_residual_falls_tenfold_every_two_iterations_on_every_grid() {
    let needed = |cells: [usize; 3]| {
        let norms = falls(cells, None);
        println!("{cells:?}: {norms:?}");
        assert!(norms[6] < 1e-3 * norms[0], "{cells:?}: {norms:?}");
        norms.iter().position(|norm| *norm < 1e-4 * norms[0])
    };
    let [coarse, medium, fine] = [[12, 12, 8], [24, 24, 16], [48, 48, 24]].map(needed);
    let [coarse, medium, fine] = [coarse, medium, fine].map(|count| count.expect("it falls"));
    let most = coarse.min(medium).min(fine) + 1;
    assert!([coarse, medium, fine].iter().all(|count| *count <= most));
    let faulty = falls([12, 12, 8], Some(("fault_smoothing", 3.0)));
    assert!(
        faulty[6] > 1e-3 * faulty[0],
        "a smoother that steps too far passes"
    );
}

#[test]
fn energy_never_grows_whatever_the_step() {
    let grid = Grid {
        cells: [12; 3],
        ends: [WALLS, Ends::Periodic, Ends::Sides([Side::NoSlip; 2])],
    };
    let mut flow = GpuFlow::new(device(), &grid, Effort::default()).expect("made");
    for (top, tau) in [1e-3, 0.1, 10.0, 1e3]
        .into_iter()
        .flat_map(|tau| [(12.0, tau), (7.4, tau)])
    {
        let fill = filled(&grid, |_, _| top);
        let mut random = Pcg64::seed_from_u64(7);
        let mut velocity: [Vec<f32>; 3] = std::array::from_fn(|_| grid.field());
        for u in velocity.iter_mut().flatten() {
            *u = unit(&mut random) as f32 - 0.5;
        }
        let first: f64 = velocity.iter().flatten().map(|u| f64::from(u * u)).sum();
        flow.write(&velocity, &grid.field()).expect("written");
        let solids = Solids::walls(&grid);
        let domain = Domain::new(&grid, &fill, &solids, LEAST_FILL);
        let mut before = f64::INFINITY;
        for step in 0..4 {
            flow.step(&fill, &solids, &conditions(1.0, tau, [0.0; 3]))
                .expect("a step");
            let state = flow.read().expect("read");
            let energy = flow_of(&grid, &state).energy(&domain);
            // Below that is rounding.
            assert!(
                energy <= before * (1.0 + 1e-6) + 1e-12 * first,
                "τ = {tau}, step {step}: {before:e} to {energy:e}"
            );
            before = energy;
        }
    }
}
