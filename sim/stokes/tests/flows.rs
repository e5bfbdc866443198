use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::domain::*;
use maulstick_stokes::unified::*;
use maulstick_stokes::operator::*;

#[test]
fn poiseuille() {
    let ends = [Ends::Periodic, Ends::Sides([Side::NoSlip; 2]), Ends::Periodic];
    for n in [8usize, 16, 32] {
    let grid = Grid { cells: [4, n, 4], ends };
    let fill = vec![1.0; grid.len()];
    let solids = Solids::walls(&grid);
    let domain = Domain::new(&grid, &fill, &solids);
    let tau = 1e6;
    let mut un = Unified::new(&domain, tau, &fill);
    let zero = grid.field();
    // G/mu = 1 in cells: alpha*dt*g = beta * (g/nu)
    let beta = weights(tau)[1];
    let alpha = weights(tau)[0];
    let force = vec![beta/alpha; grid.len()];
    let b = un.right_hand_side(&domain, [&force, &zero, &zero], &solids.velocity);
    let mut x = vec![0.0; 4*grid.len()];
    let norms = un.solve(&b, &mut x, 12);
    println!("{n}: {:?}", norms.iter().map(|n| format!("{:.1e}", n/norms[0])).collect::<Vec<_>>());
    let h = n as f64;
    let mut worst: f64 = 0.0;
    for j in 0..n { let y = j as f64 + 0.5; let want = 0.5*y*(h-y) + 0.125; let got = f64::from(x[grid.at([1, j as isize, 1])]);
      worst = worst.max((got/want-1.0).abs()); }
    println!("worst {worst:.1e}");
    }
}

#[test]
fn cavity() {
    for (wave, hasball, level) in [(0.0, true, 0.35), (0.0, true, 1.0), (0.0, false, 0.35), (2.0, false, 0.35), (2.0, true, 0.35), (2.0, true, 0.25)] {
    let tau = 1e6; let n = 32;
    let grid = Grid::walled([n, n, n/2]);
    let top = n as f64 * level;
    let fill: Vec<f32> = (0..grid.len()).map(|p| { let c = grid.cell(p); let z = c[2] as f64; let t = top + wave*maulstick_num::sin(c[0] as f64*0.5); (t - z).clamp(0.0, 1.0) as f32}).collect();
    let mut solids = Solids::walls(&grid);
    // a ball that moves
    let c = n as f32; let ball = |p: [f32;3]| ((p[0]-0.5*c).powi(2)+(p[1]-0.5*c).powi(2)+(p[2]-0.3*c).powi(2)).sqrt() - 0.2*c;
    if hasball {solids.add(&grid, ball);
    for p in 0..grid.len() { let q = grid.cell(p).map(|v| v as f32); if ball(q) < 2.0 { solids.velocity[0][p] = 1.0; } }}
    let domain = Domain::new(&grid, &fill, &solids);
    let mut un = Unified::new(&domain, tau, &vec![1.0; grid.len()]);
    let zero = grid.field();
    let one: Vec<f32> = (0..grid.len()).map(|p| if hasball {0.0} else {(p % 37) as f32*1e5}).collect();
    let b = un.right_hand_side(&domain, [&one, &zero, &zero], &solids.velocity);
    let mut x = vec![0.0; 4*grid.len()];
    let f = fields_mut(&mut x);
    for a in 0..3 { for p in 0..grid.len() { if domain.part[a][p]==Part::Solid { f[a][p] = solids.velocity[a][p]; } } }
    let t = std::time::Instant::now();
    let norms = un.solve(&b, &mut x, 20);
    println!("{wave} {hasball} {level}: {:.2} ms {}", t.elapsed().as_secs_f64()*1e3/20.0, norms.iter().map(|n| format!("{:.1e}", n/norms[0])).collect::<Vec<_>>().join(" "));
    }
}
