//! Lengths of a brush in cells of a surface.

/// Scale of a brush's lengths on a surface.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Scale {
    /// Side of a cell in the surface's own lengths, m.
    pub cell_m: f64,
    /// Desk lengths per surface length.
    pub zoom: f64,
}

/// Path of a brush in one step, m of its own lengths.
pub(crate) const STEP_M: f64 = 0.25e-3;

impl Scale {
    /// Path of a brush in one step, cells: at least one. A `fine` one has no longer steps, because paint moves ahead of
    /// a blade's narrow edge, and a hairline would be widened by the sweep of its slanting hair.
    #[must_use]
    pub fn step_cells(&self, fine: bool) -> f64 {
        if fine {
            return 1.0;
        }
        (STEP_M / (self.cell_m * self.zoom)).max(1.0)
    }
}
