//! Flows with a known force: a cylinder in a channel, one that turns in a round vessel.

use std::f64::consts::PI;

use maulstick_num::ln;

use super::*;

/// μ = 1.5 Pa·s, slow enough for viscosity alone.
const FLUID: Fluid = Fluid {
    density_kg_m3: 3.0,
    viscosity_m2_s: 0.5,
};
const MU: f64 = 1.5;

/// The steady flow around a probe whose surface moves while its place stays.
fn steady(
    cells: [usize; 2],
    vessel: Vessel,
    boundary: Boundary,
    probe: (Shape, ProbeState),
) -> Flow {
    let bench = Bench {
        grid: Grid {
            cells,
            cell_m: 1.0 / cells[1] as f64,
        },
        vessel,
        fluid: FLUID,
        shape: probe.0,
        boundary,
    };
    let mut flow = Flow::new(bench, probe.1);
    for _ in 0..60 {
        flow.step(probe.1, 0.01);
    }
    flow
}

/// Force by μU on a disc that is k times as wide as the channel between two walls: Faxén's series (Happel and Brenner
/// 1965, eq. 7-7.23).
fn faxen(k: f64) -> f64 {
    let square = k * k;
    let series = -0.9157 + square * (1.7244 + square * (-1.7302 + square * 2.4056));
    4.0 * PI / (series - ln(k))
}

/// A disc of radius .1 m in a channel 1 m wide.
fn channel(cells: usize, boundary: Boundary) -> Flow {
    let state = ProbeState {
        place_m: [1.0, 0.5],
        velocity_m_s: [1e-4, 0.0],
        ..ProbeState::default()
    };
    steady(
        [2 * cells, cells],
        Vessel::Box,
        boundary,
        (Shape::disc(0.1), state),
    )
}

fn drag(flow: &Flow) -> f64 {
    -flow.wrench().force_n[0] / (MU * 1e-4)
}

#[test]
fn a_cylinder_in_a_channel_is_dragged_as_faxen_says_and_against_its_motion() {
    let expected = faxen(0.2);
    for (cells, boundary, within) in [
        (32, Boundary::Covered, 0.03),
        (48, Boundary::Covered, 0.015),
        (48, Boundary::Staircase, 0.1),
    ] {
        let mut flow = channel(cells, boundary);
        let off = drag(&flow) / expected - 1.0;
        println!(
            "{boundary:?} {cells}: {:.3}, expected {expected:.3}: {:.1} %",
            drag(&flow),
            100.0 * off
        );
        assert!(off.abs() < within);
        assert!(flow.divergence() < 1e-6 * 1e-4 * 32.0);
        // The seeded fault: a kinematic pressure that is not multiplied by ρ.
        flow.bench.fluid.density_kg_m3 = 1.0;
        let off = drag(&flow) / expected - 1.0;
        assert!(off.abs() > 0.2, "{off}");
    }
}

/// Torque by μΩ on a cylinder that turns in a vessel around it.
fn turning(cells: usize) -> f64 {
    let state = ProbeState {
        place_m: [0.5; 2],
        spin_rad_s: 1e-3,
        ..ProbeState::default()
    };
    let probe = (Shape::disc(0.2), state);
    let flow = steady([cells; 2], Vessel::Round(0.45), Boundary::Covered, probe);
    let wrench = flow.wrench();
    assert!(
        wrench.force_n.iter().all(|force| force.abs() < 1e-7),
        "{wrench:?}"
    );
    wrench.torque_n_m[2] / (MU * 1e-3)
}

#[test]
fn a_cylinder_that_turns_in_a_round_vessel_is_braked_by_the_torque_of_couette() {
    let [inner, outer] = [0.2 * 0.2, 0.45 * 0.45];
    let expected = -4.0 * PI * inner * outer / (outer - inner);
    let [coarse, fine] = [32, 64].map(turning);
    // The error is of the first order in the cell.
    let none = 2.0 * fine - coarse;
    println!("{coarse:.4}, {fine:.4}, without cells {none:.4}, expected {expected:.4}");
    assert!((fine / expected - 1.0).abs() < 0.06);
    assert!((none / expected - 1.0).abs() < 0.02);
}

#[test]
fn a_step_of_any_length_is_stable() {
    for boundary in [Boundary::Covered, Boundary::Staircase] {
        let mut still = ProbeState {
            place_m: [0.5, 0.5],
            velocity_m_s: [0.1, 0.0],
            ..ProbeState::default()
        };
        let bench = crate::sweep::bench(24, boundary, FLUID);
        let mut flow = Flow::new(bench, still);
        // The explicit limit Δt < Δx²/4ν (§ 8.8.4, without ‖u‖) is .9 ms here.
        flow.step(still, 10.0);
        still.velocity_m_s = [0.0; 2];
        for _ in 0..40 {
            flow.step(still, 10.0);
        }
        let force = flow.wrench().force_n;
        assert!(
            force.iter().all(|part| part.abs() < 0.02),
            "{boundary:?} {force:?}"
        );
    }
}
