//! Shared parts of tests of flows.
#![allow(dead_code, unreachable_pub, reason = "each test uses a part")]

pub mod pools;

use maulstick_stokes::flow::Conditions;
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;

/// An axis that closes on itself.
pub const PERIODIC: Ends = Ends::Periodic;
/// An axis between two walls.
pub const BETWEEN: Ends = Ends::Sides([Side::NoSlip; 2]);

/// Conditions on cells of a metre.
pub fn conditions(paint: Paint, seconds: f64, pull: [f64; 3]) -> Conditions {
    Conditions {
        cell_m: 1.0,
        seconds,
        paint,
        pull,
    }
}

/// A window full of paint.
pub fn full(grid: &Grid) -> Vec<f32> {
    vec![1.0; grid.len()]
}

/// The largest absolute value.
pub fn worst(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| value.abs().max(most))
}
