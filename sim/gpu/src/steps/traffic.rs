//! Memory traffic of the stages, for comparing graphics cards: each buffer bound to a stage counts once, as far as
//! the step's cells or the brush's texels extend. A device's caches reduce it.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use super::device_layout::DeviceLayout;
use super::kernels::{Binding, Kernel};

/// Counters since the model was made.
#[derive(Debug, Default)]
pub struct Traffic {
    steps: AtomicU64,
    dispatches: AtomicU64,
    bytes: AtomicU64,
}

impl Traffic {
    /// Number of steps, of their dispatches and of bytes.
    #[must_use]
    pub fn counts(&self) -> [u64; 3] {
        [&self.steps, &self.dispatches, &self.bytes].map(|count| count.load(Relaxed))
    }

    /// Counts a step.
    pub fn step(&self) {
        self.steps.fetch_add(1, Relaxed);
    }

    /// Counts a dispatch over a grid with this number of cells.
    pub fn dispatch(&self, kernel: &Kernel, on: &DeviceLayout, cells: u64) {
        let (planes, strips) = (on.planes_in_use() as u64, on.strips as u64);
        let words = |binding: &Binding| match binding {
            Binding::Poses => on.poses_words() as u64,
            Binding::Head => 4 * strips + 6 * (on.faces + on.vertices) as u64,
            Binding::Segments => 16 * on.segments() as u64,
            Binding::Planes | Binding::Other => planes * cells,
            Binding::Load => on.load_words() as u64,
            Binding::Asks => on.asks_words() as u64,
            Binding::Base => 2 * cells,
            Binding::Stats | Binding::Groups | Binding::Blend => 0,
            of_grid => of_grid.words_by_cell() * cells,
        };
        let words: u64 = kernel.bindings.iter().map(words).sum();
        self.dispatches.fetch_add(1, Relaxed);
        self.bytes.fetch_add(4 * words, Relaxed);
    }
}
