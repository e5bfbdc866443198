//! Canvases on which painting is slow: nobody wants one by accident.

use super::NewCanvas;

/// Cells with smaller sides are slow under any brush, m: a sixteenth of a millimetre.
pub const SLOW_CELL_M: f64 = 6.25e-5;
/// A canvas of more cells takes long to draw.
pub const SLOW_CELLS: f64 = 100e6;

/// True if painting on this number of cells with sides of `cell_m`, m, is slow.
#[must_use]
pub fn is_slow(cell_m: f64, cells: f64) -> bool {
    cell_m < SLOW_CELL_M * (1.0 - 1e-9) || cells > SLOW_CELLS
}

impl NewCanvas {
    /// True if painting on it is slow.
    #[must_use]
    pub fn is_slow(&self) -> bool {
        let cells = self.width_m * self.height_m / (self.cell_m * self.cell_m);
        is_slow(self.cell_m, cells)
    }
}
