//! Rectangles of cells of a surface.

/// Half-open range of cells, which may extend beyond the surface's edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cells {
    pub(super) from: [i64; 2],
    pub(super) to: [i64; 2],
}

impl Cells {
    /// The cells grown by `by` on each side.
    pub(super) fn grown(self, by: i64) -> Self {
        Self {
            from: self.from.map(|cell| cell - by),
            to: self.to.map(|cell| cell + by),
        }
    }
}
