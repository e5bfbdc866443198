//! The pressure's Poisson equation.
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::multigrid::Multigrid;
use maulstick_stokes::stencil::Stencil;

/// A box of paint, or a rough pool between a rough floor and open air.
fn pool(n: usize, rough: bool) -> (Grid, Stencil, Vec<f32>) {
    let grid = Grid::walled([n; 3]);
    let mut s = Stencil::new(&grid);
    let size = n as f64;
    let kind = |p: usize| -> u8 {
        let [x, y, z] = grid.cell(p).map(|c| (c as f64 + 0.5) / size);
        if [x, y, z].iter().any(|c| *c < 0.0 || *c > 1.0) { return if z > 1.0 {1} else {0}; }
        if !rough { return 2; }
        let w = |a: f64| maulstick_num::sin(a);
        let floor = 0.15 + 0.05 * w(9.0 * x) * w(13.0 * y) ;
        let top = 0.7 + 0.08 * w(14.0 * x + 3.0) * w(11.0 * y);
        let b = (x-0.5)*(x-0.5)+(y-0.4)*(y-0.4)+(z-0.6)*(z-0.6);
        if z < floor || b < 0.03 { 0 } else if z > top { 1 } else { 2 }
    };
    let r = grid.range();
    let kinds: Vec<u8> = (0..grid.len()).map(|p| if r.contains(&p) || p < r.start {kind(p)} else {1}).collect();
    let mut b = grid.field();
    for p in 0..grid.len() {
        s.active[p] = f32::from(kinds[p] == 2);
        s.known[p] = f32::from(kinds[p] >= 1);
        for a in 0..3 { let st = grid.stride(a); if p >= st {
            let (k,l) = (kinds[p], kinds[p-st]);
            if (k==2 || l==2) && k>0 && l>0 { s.links[a][p] = 1.0; }
        }}
        if kinds[p]==2 { b[p] = ((p as u32).wrapping_mul(2654435761) >> 8) as f32 / 8e6 - 1.0; }
    }
    s.finish(&grid);
    (grid, s, b)
}
#[test]
fn tenfold() {
    for rough in [false, true] {
        for n in [16, 32, 64, 128] {
            let (grid, s, b) = pool(n, rough);
            let mut mg = Multigrid::new(&grid, s, None);
            let mut x = grid.field();
            let t = std::time::Instant::now();
            let norms = mg.solve(&b, &mut x, 10);
            let dt = t.elapsed().as_secs_f64();
            let rel: Vec<String> = norms.iter().map(|n| format!("{:.1e}", n / norms[0])).collect();
            println!("{rough} {n}: {:.1} ms {}", dt*100.0, rel.join(" "));
        }
    }
    let _ = (Ends::Periodic, Side::Slip);
}
