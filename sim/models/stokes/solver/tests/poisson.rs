//! Conjugate gradients with multigrid on the pressure's equation.

mod common;

use common::pools::{Pool, pool};
use maulstick_stokes::multigrid::Multigrid;

/// In a box and in a pool with a rough floor, a ball and waves, on 32, 64 and 128 cells a side, the residual falls
/// tenfold every two iterations.
#[test]
fn the_residual_falls_tenfold_every_two_iterations_on_every_grid() {
    for kind in [Pool::Box, Pool::Rough] {
        for cells in [32, 64, 128] {
            let (grid, stencil, b) = pool(cells, kind);
            let mut x = grid.field();
            let norms = Multigrid::new(&grid, stencil, None).solve(&b, &mut x, 8);
            let falls: f64 = norms[0] / norms[8];
            println!("{kind:?}, {cells} cells a side: {falls:.1e} in 8 iterations");
            assert!(falls > 1e4, "{kind:?} {cells}: {falls}");
        }
    }
}

/// Rounds of f32 bring the residual in f64 down to 1e-8, which one round does not.
#[test]
fn rounds_reach_what_single_precision_does_not() {
    let (grid, stencil, b) = pool(32, Pool::Rough);
    let mut multigrid = Multigrid::new(&grid, stencil, None);
    let b: Vec<f64> = b.into_iter().map(f64::from).collect();
    let left = |rounds: usize, multigrid: &mut Multigrid| {
        multigrid.refine(&b, &mut vec![0.0; grid.len()], 1e-8, rounds)
    };
    assert!(left(1, &mut multigrid) > 1e-8);
    assert!(left(6, &mut multigrid) <= 1e-8);
}
