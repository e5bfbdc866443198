use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::domain::*;
use maulstick_stokes::flow::*;
use maulstick_stokes::rheology::Paint;
use std::f64::consts::PI;
fn cond(nu: f64, dt: f64, pull: [f64;3]) -> Conditions { Conditions { cell_m: 1.0, seconds: dt, paint: Paint::newtonian(nu), pull } }
const P: Ends = Ends::Periodic;
const W: Ends = Ends::Sides([Side::NoSlip; 2]);

#[test]
fn poiseuille() {
    for scheme in [Scheme::Unified, Scheme::Split] {
    for n in [8usize, 16, 32] {
        let grid = Grid { cells: [4, n, 4], ends: [P, W, P] };
        let mut flow = Flow::new(&grid); flow.scheme = scheme;
        let solids = Solids::walls(&grid);
        let fill = vec![1.0; grid.len()];
        for _ in 0..3 { flow.step(&fill, &solids, &cond(1.0, 1e6, [1.0, 0.0, 0.0])); }
        let h = n as f64;
        let mut worst: f64 = 0.0;
        for j in 0..n { let y = j as f64 + 0.5; let want = 0.5*y*(h-y) + 0.125; let got = f64::from(flow.velocity[0][grid.at([1, j as isize, 1])]);
          worst = worst.max((got/want-1.0).abs()); }
        println!("{scheme:?} {n} worst {worst:.1e}");
    }}
}
#[test]
fn nusselt() {
    for top in [8.0, 8.3, 7.7, 15.6] {
        let grid = Grid { cells: [4, 16, 4], ends: [P, Ends::Sides([Side::NoSlip, Side::Slip]), P] };
        let mut flow = Flow::new(&grid);
        let solids = Solids::walls(&grid);
        let fill: Vec<f32> = (0..grid.len()).map(|p| (top - grid.cell(p)[1] as f64).clamp(0.0, 1.0) as f32).collect();
        for _ in 0..3 { flow.step(&fill, &solids, &cond(1.0, 1e6, [1.0, -1.0, 0.0])); }
        let mut worst: f64 = 0.0;
        for j in 0..(top as usize) { let y = j as f64 + 0.5; let want = top*y - 0.5*y*y + 0.125; let got = f64::from(flow.velocity[0][grid.at([1, j as isize, 1])]);
          worst = worst.max((got-want).abs()/(0.5*top*top)); }
        let p = flow.pressure[grid.at([1,0,1])];
        println!("film {top} worst {worst:.1e} p {p} want {}", top-0.5);
    }
}
#[test]
fn taylor_green() {
    for scheme in [Scheme::Unified, Scheme::Split] {
    let n = 32;
    let grid = Grid { cells: [n, n, 1], ends: [P, P, P] };
    let mut flow = Flow::new(&grid); flow.scheme = scheme;
    let k = 2.0*PI/n as f64;
    for p in grid.places() { let c = grid.cell(p).map(|c| c as f64);
        flow.velocity[0][p] = (maulstick_num::cos(k*c[0]) * maulstick_num::sin(k*(c[1]+0.5))) as f32;
        flow.velocity[1][p] = -(maulstick_num::sin(k*(c[0]+0.5)) * maulstick_num::cos(k*c[1])) as f32; }
    let lam = 2.0*(2.0-2.0*maulstick_num::cos(k));
    println!("lambda h2 {lam} * {} ", lam*(n as f64/(2.0*PI)).powi(2));
    let solids = Solids::walls(&grid);
    let fill = vec![1.0; grid.len()];
    let start = flow.velocity[0].clone();
    let dt = 0.5;
    for _ in 0..100 { flow.step(&fill, &solids, &cond(1.0, dt, [0.0;3])); }
    let want = (0..100).fold(1.0, |a, _| a/(1.0+dt*lam));
    let worst = grid.places().map(|p| (f64::from(flow.velocity[0][p]) - want*f64::from(start[p])).abs()/want).fold(0.0, f64::max);
    println!("{scheme:?} tg worst {worst:.1e} decay {want}");
    }
}
#[test]
fn zick() {
    for n in [16, 32, 64] {
        let grid = Grid { cells: [n;3], ends: [P,P,P] };
        let mut flow = Flow::new(&grid);
        flow.effort = Effort { steps: 40, projections: 6 };
        let mut solids = Solids::walls(&grid);
        let c = 0.125f64; let l = n as f64; let a = l*maulstick_num::powf(c*3.0/(4.0*PI), 1.0/3.0);
        solids.add(&grid, |p| { let d: f64 = p.iter().map(|x| (f64::from(*x)-0.5*l).powi(2)).sum::<f64>().sqrt(); (d - a) as f32 });
        let fill = vec![1.0; grid.len()];
        let t = std::time::Instant::now();
        for round in 0..3 { let domain = flow.step(&fill, &solids, &cond(1.0, 1e8, [1.0, 0.0, 0.0]));
        let sum: f64 = grid.places().map(|p| f64::from(flow.velocity[0][p]) * if domain.part[0][p]==Part::Paint {f64::from(domain.area[0][p])} else {0.0}).sum();
        let u = sum / l.powi(3);
        let k = l.powi(3) / (6.0*PI*a*u);
        println!("zick {n} round {round} K {k} vs 4.292, div {:.1e} {:.1}", flow.divergence(&domain, &solids), t.elapsed().as_secs_f64()); }
    }
}
