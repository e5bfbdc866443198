//! The wet paint on an area of a window.

use maulstick_canvas::window::{Area, Window};
use maulstick_num::fork_join::each;

use super::shares_of;
use crate::interface::Step;

/// Wet quanta of all paints on the cells of an area, row after row.
#[derive(Clone, Debug, Default)]
pub struct Lying {
    /// By cell of the area that was weighed last.
    pub quanta: Vec<f32>,
}

impl Lying {
    /// Weighs the wet paint of an area, and notes and returns how high it stands, cells.
    pub fn weigh(&mut self, area: Area, step: &mut Step<'_>) -> f32 {
        let (window, to_cells) = (&*step.window, step.traits.cells_per_quantum);
        self.quanta.resize(area.cells(), 0.0);
        let weigh = |area: &Area, lying: &mut [f32]| {
            window.weigh(area, lying);
            highest(lying, area, window, to_cells)
        };
        let mut lying = &mut self.quanta[..];
        let parts = area.parts(shares_of(area.cells()));
        let parts = parts.map(|part| {
            let own = lying.split_off_mut(..part.cells());
            (part, own.unwrap_or_default(), 0.0f32)
        });
        let mut parts: Vec<_> = parts.collect();
        each(&mut parts, |(part, lying, top)| *top = weigh(part, lying));
        let top = parts.iter().fold(0.0f32, |most, (.., top)| most.max(*top));
        step.window.note_top(top / to_cells);
        top
    }
}

/// Greatest height of paint of `lying` quanta on the cells of an area, cells; 0 without any.
fn highest(lying: &[f32], area: &Area, window: &Window, to_cells: f32) -> f32 {
    let rows = area.rows(window.width());
    let lying = lying.chunks_exact(area.size[0].max(1));
    rows.zip(lying).fold(0.0, |most, (row, lying)| {
        highest_of(lying, &window.base()[row], to_cells).max(most)
    })
}

/// Greatest height of paint of `lying` quanta on `base`, cells; 0 without any.
fn highest_of(lying: &[f32], base: &[f32], to_cells: f32) -> f32 {
    let mut highest = [0.0f32; 8];
    let (runs, bases) = (lying.chunks_exact(8), base.chunks_exact(8));
    let rest = runs.remainder().iter().zip(bases.remainder());
    for (lying, base) in runs.zip(bases) {
        for i in 0..8 {
            let height = base[i] + lying[i] * to_cells;
            highest[i] = if height > highest[i] {
                height
            } else {
                highest[i]
            };
        }
    }
    let rest = rest.map(|(lying, base)| base + lying * to_cells);
    rest.chain(highest).fold(0.0, f32::max)
}
