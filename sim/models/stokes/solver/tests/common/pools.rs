//! Pools with pressure.

use maulstick_num::sin;
use maulstick_stokes::grid::Grid;
use maulstick_stokes::stencil::Stencil;

/// Shape of a pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pool {
    /// In a box that is open at the top.
    Box,
    /// Over a rough floor, round a ball, under waves.
    Rough,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Cell {
    Solid,
    Air,
    Paint,
}

/// The pressure's equation in a pool of `cells` cells a side, with a right-hand side of noise.
pub fn pool(cells: usize, pool: Pool) -> (Grid, Stencil, Vec<f32>) {
    let grid = Grid::walled([cells; 3]);
    let kind = |place: usize| {
        let [x, y, z] = grid.cell(place).map(|at| (at as f64 + 0.5) / cells as f64);
        if [x, y, z].iter().any(|at| !(0.0..=1.0).contains(at)) {
            return if z > 1.0 { Cell::Air } else { Cell::Solid };
        }
        let floor = 0.15 + 0.05 * sin(9.0 * x) * sin(13.0 * y);
        let top = 0.7 + 0.08 * sin(14.0 * x + 3.0) * sin(11.0 * y);
        let ball = [x - 0.5, y - 0.4, z - 0.6]
            .iter()
            .map(|d| d * d)
            .sum::<f64>();
        match pool {
            Pool::Rough if z < floor || ball < 0.03 => Cell::Solid,
            Pool::Rough if z > top => Cell::Air,
            Pool::Box | Pool::Rough => Cell::Paint,
        }
    };
    let kinds: Vec<Cell> = (0..grid.len()).map(kind).collect();
    let mut stencil = Stencil::new(&grid);
    let mut b = grid.field();
    for place in 0..grid.len() {
        stencil.active[place] = f32::from(kinds[place] == Cell::Paint);
        stencil.known[place] = f32::from(kinds[place] != Cell::Solid);
        for axis in 0..3 {
            let Some(before) = place.checked_sub(grid.stride(axis)) else {
                continue;
            };
            let two = [kinds[place], kinds[before]];
            if two.contains(&Cell::Paint) && !two.contains(&Cell::Solid) {
                stencil.links[axis][place] = 1.0;
            }
        }
        if kinds[place] == Cell::Paint {
            b[place] = ((place as u32).wrapping_mul(2_654_435_761) >> 8) as f32 / 8e6 - 1.0;
        }
    }
    stencil.finish(&grid);
    (grid, stencil, b)
}
