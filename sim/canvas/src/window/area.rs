//! Rectangles of cells.

/// A rectangle of a window's cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Area {
    /// Its lowest column and row.
    pub from: [usize; 2],
    /// Columns and rows.
    pub size: [usize; 2],
}

impl Area {
    /// True if it has no cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.size.contains(&0)
    }

    /// Its rows from the lowest up, in `count` parts.
    pub fn parts(&self, count: usize) -> impl Iterator<Item = Self> + use<> {
        let area = *self;
        let row = move |part| area.size[1] * part / count;
        (0..count).map(move |part| Self {
            from: [area.from[0], area.from[1] + row(part)],
            size: [area.size[0], row(part + 1) - row(part)],
        })
    }

    /// Number of its cells.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// Its rows as index ranges of planes with this width.
    pub fn rows(&self, width: usize) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
        let (from, size) = (self.from, self.size);
        (0..size[1]).map(move |y| {
            let start = (from[1] + y) * width + from[0];
            start..start + size[0]
        })
    }
}
