//! Known forces on bodies in paint, and energy.

mod common;

use std::f64::consts::PI;

use common::{BETWEEN, PERIODIC, conditions, full};
use maulstick_num::powf;
use maulstick_stokes::domain::{Domain, Solids};
use maulstick_stokes::flow::{Effort, Flow, Scheme};
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

/// Drag on each sphere of a simple cubic array, divided by Stokes' 6πμaU, with U the mean velocity of the whole volume.
fn drag(cells: usize, volume_fraction: f64) -> f64 {
    let grid = Grid {
        cells: [cells; 3],
        ends: [PERIODIC; 3],
    };
    let mut flow = Flow::new(&grid);
    flow.effort = Effort {
        steps: 40,
        projections: 6,
    };
    let mut solids = Solids::walls(&grid);
    let side = cells as f64;
    let radius = side * powf(0.75 * volume_fraction / PI, 1.0 / 3.0);
    solids.add(&grid, |corner| {
        let squares = corner.map(|at| (f64::from(at) - 0.5 * side) * (f64::from(at) - 0.5 * side));
        (squares.iter().sum::<f64>().sqrt() - radius) as f32
    });
    let conditions = conditions(Paint::newtonian(1.0), 1e8, [1.0, 0.0, 0.0]);
    let domain = flow.step(&full(&grid), &solids, &conditions);
    let through = |place| f64::from(flow.velocity[0][place] * domain.area[0][place]);
    let mean = grid.places().map(through).sum::<f64>() / (side * side * side);
    side * side * side / (6.0 * PI * radius * mean)
}

/// Zick and Homsy (1982), table 2: 4.292 at a volume fraction of .125. The series of Sangani and Acrivos (1982) gives 4.289.
#[test]
fn a_sphere_in_an_array_drags_as_zick_and_homsy_have_it() {
    let [coarse, medium, fine] = [16, 32, 64].map(|cells| drag(cells, 0.125) / 4.292 - 1.0);
    println!("off by {coarse:.4}, {medium:.4}, {fine:.4}");
    assert!(fine.abs() < 0.03, "{fine}");
    // First order or better.
    assert!(medium.abs() < 0.55 * coarse.abs() && fine.abs() < 0.55 * medium.abs());
    let other = drag(64, 0.14) / 4.292 - 1.0;
    assert!(other.abs() > 0.03, "a larger sphere passes");
}

/// Force on a disc that comes down on another, divided by 3πμR⁴V/(2h³): a quarter of it, above the plane of symmetry.
fn squeeze(half_gap: usize, radius: f64) -> f64 {
    let cells = radius as usize + 3;
    let [symmetric, disc] = [[Side::Slip, Side::Slip], [Side::Slip, Side::NoSlip]].map(Ends::Sides);
    let grid = Grid {
        cells: [cells, cells, half_gap],
        ends: [symmetric, symmetric, disc],
    };
    let from_middle = |place: usize| {
        let [x, y, _] = grid.cell(place).map(|at| at as f64 + 0.5);
        (x * x + y * y).sqrt()
    };
    let mut solids = Solids::walls(&grid);
    for place in 0..grid.len() {
        if grid.cell(place)[2] == half_gap as isize && from_middle(place) < radius + 0.4 {
            solids.velocity[2][place] = -0.5;
        }
    }
    let fill = |place| (radius + 0.5 - from_middle(place)).clamp(0.0, 1.0) as f32;
    let fill: Vec<f32> = (0..grid.len()).map(fill).collect();
    let mut flow = Flow::new(&grid);
    flow.effort.steps = 40;
    flow.step(
        &fill,
        &solids,
        &conditions(Paint::newtonian(1.0), 1e8, [0.0; 3]),
    );
    let cells = cells as isize;
    let top = half_gap as isize;
    let under = grid.block([0, 0, top - 1], [cells, cells, top]);
    let force = 4.0
        * under
            .map(|place| f64::from(flow.pressure[place]))
            .sum::<f64>();
    let gap = 2.0 * half_gap as f64;
    force / (3.0 * PI * radius * radius * radius * radius / (2.0 * gap * gap * gap))
}

#[test]
fn a_squeezed_film_pushes_as_reynolds_has_it() {
    let force = squeeze(6, 180.0);
    println!("force by Reynolds': {force:.4}");
    assert!((force - 1.0).abs() < 0.02, "{force}");
}

/// Sum of the squares of all velocities of paint.
fn squares(flow: &Flow, domain: &Domain) -> f64 {
    let pairs = flow
        .velocity
        .iter()
        .flatten()
        .zip(domain.free.iter().flatten());
    pairs
        .map(|(u, free)| f64::from(u * free) * f64::from(*u))
        .sum()
}

#[test]
fn energy_never_grows_whatever_the_step() {
    for scheme in [Scheme::Unified, Scheme::Split] {
        for (top, tau) in [1e-3, 0.1, 10.0, 1e3]
            .into_iter()
            .flat_map(|tau| [(12.0, tau), (7.4, tau)])
        {
            let grid = Grid {
                cells: [12; 3],
                ends: [BETWEEN, PERIODIC, BETWEEN],
            };
            let fill = |place| (top - grid.cell(place)[2] as f64).clamp(0.0, 1.0) as f32;
            let fill: Vec<f32> = (0..grid.len()).map(fill).collect();
            let mut flow = Flow::new(&grid);
            flow.scheme = scheme;
            let mut random = Pcg32::new(7, 11);
            for u in flow.velocity.iter_mut().flatten() {
                *u = random.next_u32() as f32 / u32::MAX as f32 - 0.5;
            }
            let solids = Solids::walls(&grid);
            let mut before = f64::INFINITY;
            let all = flow.velocity.iter().flatten();
            let first: f64 = all.map(|u| f64::from(u * u)).sum();
            for step in 0..30 {
                let conditions = conditions(Paint::newtonian(1.0), tau, [0.0; 3]);
                let domain = flow.step(&fill, &solids, &conditions);
                let energy = match scheme {
                    Scheme::Unified => flow.energy(&domain),
                    // Its cells are either paint or not.
                    Scheme::Split => squares(&flow, &domain),
                };
                // Below that is rounding.
                assert!(
                    energy <= before * (1.0 + 1e-6) + 1e-12 * first,
                    "{scheme:?}, τ = {tau}, step {step}: {before:e} to {energy:e}"
                );
                before = energy;
            }
        }
    }
}
