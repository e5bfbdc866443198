//! Flows whose force is known: a cylinder in a channel, one that turns in a round vessel.

use super::*;

/// μ = 1.5 Pa·s, and so slow that nothing but viscosity counts.
const FLUID: Fluid = Fluid {
    density_kg_m3: 3.0,
    viscosity_m2_s: 0.5,
};
const MU: f64 = 1.5;

/// The steady wrench on a probe whose surface moves while its place stays.
fn steady(bench: Bench, state: ProbeState, dt_s: f64, time_s: f64) -> Wrench<2> {
    let mut flow = Flow::new(bench, state);
    for _ in 0..(time_s / dt_s) as usize {
        flow.step(state, dt_s);
    }
    flow.wrench()
}

/// A disc of radius a between walls 1 m apart, k = 2a: force by μU by Faxén's series (Happel and Brenner 1965, eq.
/// 7-7.23).
fn faxen(k: f64) -> f64 {
    let square = k * k;
    let series = -0.9157 + square * (1.7244 + square * (-1.7302 + square * 2.4056));
    4.0 * std::f64::consts::PI / (series - maulstick_num::ln(k))
}

fn channel(cells: usize, boundary: Boundary, dt_s: f64) -> f64 {
    let h = 1.0 / cells as f64;
    let bench = Bench {
        grid: Grid {
            cells: [2 * cells, cells],
            cell_m: h,
        },
        vessel: Vessel::Box,
        fluid: FLUID,
        shape: Shape::disc(0.1),
        boundary,
    };
    let state = ProbeState {
        place_m: [1.0, 0.5],
        velocity_m_s: [1e-4, 0.0],
        ..ProbeState::default()
    };
    steady(bench, state, dt_s, 1.0).force_n[0] / (MU * 1e-4)
}

fn coaxial(cells: usize, boundary: Boundary, dt_s: f64) -> f64 {
    let bench = Bench {
        grid: Grid {
            cells: [cells; 2],
            cell_m: 1.0 / cells as f64,
        },
        vessel: Vessel::Round(0.45),
        fluid: FLUID,
        shape: Shape::disc(0.2),
        boundary,
    };
    let state = ProbeState {
        place_m: [0.5; 2],
        spin_rad_s: 1e-3,
        ..ProbeState::default()
    };
    steady(bench, state, dt_s, 1.0).torque_n_m[2] / (MU * 1e-3)
}

#[test]
#[ignore]
fn look() {
    let [r, s] = [0.2f64 * 0.2, 0.45 * 0.45];
    println!("faxen {} coaxial {}", faxen(0.2), 4.0 * std::f64::consts::PI * r * s / (s - r));
    for boundary in [Boundary::Covered, Boundary::Staircase] {
        for cells in [32, 64] {
            for dt in [0.05, 0.01, 0.002] {
                println!("{boundary:?} {cells} {dt}: {} {}", channel(cells, boundary, dt), coaxial(cells, boundary, dt));
            }
        }
    }
}
