//! Paint is counted.
//!
//! A quantum is a volume: 2⁻²⁴ thickness unit (1.5 nm) on one cell of the unzoomed canvas. Counts
//! up to one unit, the most that a cell holds, are exact in f32; sums are exact in integers, so the
//! ledger balances to zero in whatever order cells are visited.

/// One thickness unit of the dissertation, m.
pub const UNIT_M: f64 = 0.025;
/// Quanta of one unit: the most that a cell holds.
pub const QUANTA_PER_UNIT: f64 = 16_777_216.0;
/// As [`QUANTA_PER_UNIT`].
pub const CELL_MAX: u32 = 1 << 24;
/// Thickness of one quantum on its cell, m.
pub const QUANTUM_M: f64 = UNIT_M / QUANTA_PER_UNIT;
/// Side of the cell by which travel is measured, m, whatever the painting's own.
pub const REFERENCE_CELL_M: f64 = 2.5e-4;
/// Most paints of a painting.
pub const SLOTS: usize = 16;

/// Volume of a quantum on cells of side `cell_m`, m³.
#[must_use]
pub fn quantum_m3(cell_m: f64) -> f64 {
    QUANTUM_M * cell_m * cell_m
}

/// Counts by paint slot.
pub type Counts = [u64; SLOTS];

/// Adds `b` to `a`.
pub fn add(a: &mut Counts, b: &Counts) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
}
