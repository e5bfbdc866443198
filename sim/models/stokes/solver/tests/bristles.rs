//! Bristles as a porous body (Brinkman 1949): a film of thickness t on a wall, through which bristles of permeability K
//! move at U, has u(z) = U·(1 − cosh((t − z)/√K)/cosh(t/√K)).

use maulstick_num::exp;
use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Effort, Flow};
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;

/// Thickness of the film, cells.
const FILM: usize = 16;
/// Speed of the bristles, m/s.
const SPEED: f32 = 0.1;

/// Largest error relative to the speed of the bristles, with their resistance multiplied by `share`.
fn error(root_k: f64, share: f32) -> f64 {
    let periodic = Ends::Periodic;
    let grid = Grid {
        cells: [8, 8, FILM + 4],
        ends: [periodic, periodic, Ends::Sides([Side::NoSlip; 2])],
    };
    let mut solids = Solids::walls(&grid);
    let resistance = share / (root_k * root_k) as f32;
    // The wall rests.
    for place in grid.places() {
        solids.velocity[0][place] = SPEED;
    }
    solids.resistance = Some(std::array::from_fn(|_| vec![resistance; grid.len()]));
    let mut fill = grid.field();
    for place in grid.places() {
        fill[place] = f32::from(grid.cell(place)[2] < FILM as isize);
    }
    let mut flow = Flow::new(&grid);
    flow.effort = Effort {
        steps: 24,
        projections: 8,
    };
    let conditions = Conditions {
        cell_m: 1e-4,
        seconds: 10.0,
        paint: Paint::newtonian(1e-2),
        pull: [0.0, 0.0, -9.81],
    };
    flow.step(&fill, &solids, &conditions);
    let answer = |z: f64| {
        let (t, z) = (FILM as f64 / root_k, z / root_k);
        1.0 - (exp(t - z) + exp(z - t)) / (exp(t) + exp(-t))
    };
    let off = (0..FILM as isize).map(|z| {
        let u = f64::from(flow.velocity[0][grid.at([3, 4, z])] / SPEED);
        (u - answer(z as f64 + 0.5)).abs()
    });
    off.fold(0.0, f64::max)
}

#[test]
fn paint_follows_bristles_as_far_as_the_wall_lets_it() {
    for root_k in [4.0, 8.0, 30.0] {
        let error = error(root_k, 1.0);
        assert!(error < 0.01, "√K of {root_k} cells: {error}");
    }
    // First order or better in cells by √K.
    let [coarse, fine] = [2.0, 4.0].map(|root_k| error(root_k, 1.0));
    assert!(fine < 0.5 * coarse, "{coarse} {fine}");
}

#[test]
fn bristles_of_twice_the_permeability_are_found_out() {
    for root_k in [2.0, 4.0, 8.0, 30.0] {
        let error = error(root_k, 0.5);
        assert!(error > 0.02, "√K of {root_k} cells: {error}");
    }
}
