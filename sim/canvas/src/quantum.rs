//! Quanta: the unit in which paint is counted.
//!
//! A quantum is a volume: 2⁻²⁴ thickness unit (1.5 nm) on one cell of the unzoomed canvas. Counts up to one unit, a
//! cell's capacity, are exact in f32; sums are exact in integers, so the ledger balances to zero in any order of cells.

use std::ops::{Deref, DerefMut};

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// One thickness unit of the dissertation, m.
pub const UNIT_M: f64 = 0.025;
/// Quanta of one unit, the capacity of a cell.
pub const QUANTA_PER_UNIT: f64 = 16_777_216.0;
/// [`QUANTA_PER_UNIT`] as an integer.
pub const CELL_MAX: u32 = 1 << 24;
/// Thickness of one quantum on its cell, m.
pub const QUANTUM_M: f64 = UNIT_M / QUANTA_PER_UNIT;
/// Side of the reference cell by which travel is measured, m, whatever the painting's own cells.
pub const REFERENCE_CELL_M: f64 = 2.5e-4;
/// Greatest number of paints of a painting.
pub const SLOTS: usize = 64;

/// Volume of a quantum on cells of side `cell_m`, m³.
#[must_use]
pub fn quantum_m3(cell_m: f64) -> f64 {
    QUANTUM_M * cell_m * cell_m
}

/// A number for each paint slot, 0 by default; files leave out the zeros of the last slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BySlot<T>([T; SLOTS]);

impl<T> From<[T; SLOTS]> for BySlot<T> {
    fn from(numbers: [T; SLOTS]) -> Self {
        Self(numbers)
    }
}

impl<T: Copy + Default> Default for BySlot<T> {
    fn default() -> Self {
        Self([T::default(); SLOTS])
    }
}

impl<T> Deref for BySlot<T> {
    type Target = [T; SLOTS];

    fn deref(&self) -> &[T; SLOTS] {
        &self.0
    }
}

impl<T> DerefMut for BySlot<T> {
    fn deref_mut(&mut self) -> &mut [T; SLOTS] {
        &mut self.0
    }
}

impl<T: Default + PartialEq + Serialize> Serialize for BySlot<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let last = self.0.iter().rposition(|number| *number != T::default());
        self.0[..last.map_or(0, |last| last + 1)].serialize(serializer)
    }
}

impl<'a, T: Copy + Default + Deserialize<'a>> Deserialize<'a> for BySlot<T> {
    fn deserialize<D: Deserializer<'a>>(deserializer: D) -> Result<Self, D::Error> {
        let first = Vec::<T>::deserialize(deserializer)?;
        let mut all = Self::default();
        let room = all.0.get_mut(..first.len()).ok_or_else(|| {
            D::Error::custom(format!("{} paints: there are {SLOTS} at most", first.len()))
        })?;
        room.copy_from_slice(&first);
        Ok(all)
    }
}

/// Counts by paint slot.
pub type Counts = [u64; SLOTS];

/// Adds `b` to `a`.
pub fn add(a: &mut Counts, b: &Counts) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
}
