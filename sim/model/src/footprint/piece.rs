//! Pieces of the head, and their lines on the grid.

use std::ops::Range;

/// Least width of a soft end, cells.
const SHARP: f32 = 0.25;
/// Length by which a strip extends past its tip, cells.
const TIP: f32 = 0.5;

/// A piece of the head: each quantity at its beginning, and how much it changes to its end.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Piece {
    /// The first texel of its strip.
    pub(super) texel: u32,
    /// Place along the strip in texels.
    pub(super) along: [f32; 2],
    /// Height of the middle line, cells.
    pub(super) z: [f32; 2],
    /// Clearance over what it lies on, cells.
    pub(super) bottom: f32,
    /// By how much its edges are higher than its middle, cells: a bristle is round below.
    pub(super) round: f32,
    /// By how much it counts as higher, cells.
    pub(super) rank: f32,
    /// Travel since the previous step, cells.
    pub(super) moved: [[f32; 2]; 2],
    /// Its line on the grid.
    pub(super) line: Line,
}

/// The middle line of a piece on the grid, by columns of its major axis.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Line {
    /// 0 where it goes rather across than up, 1 otherwise.
    pub(super) major: usize,
    /// Its beginning.
    pub(super) start: [f32; 2],
    /// Share of the piece by column.
    pub(super) inverse: f32,
    /// Rise of the minor axis by column.
    pub(super) slope: f32,
    /// Of the angle to the major axis.
    pub(super) cosine: f32,
    /// Half the width, cells.
    pub(super) half: f32,
    /// Cells over which an edge is soft: a cell, or the width across.
    pub(super) soft: f32,
    /// The most of a cell that it covers.
    pub(super) most: f32,
    /// Share of a column before the beginning and after the end, by column: factor and at column 0.
    pub(super) fades: [[f32; 2]; 2],
}

impl Line {
    /// The middle line of a ribbon that moves by `way` in the step, in the middle of which it begins at `start` and
    /// goes by `d`, half of it `half` wide, cells; and the range of columns that it covers. `ends` is true where
    /// nothing continues it, before its beginning and after its end: there it is soft by its motion along the line.
    #[inline(always)]
    pub(super) fn swept(
        start: [f32; 2],
        d: [f32; 2],
        way: [f32; 2],
        half: f32,
        [begins, stops]: [bool; 2],
    ) -> (Self, [f32; 2]) {
        let major = usize::from(d[1].abs() > d[0].abs());
        let length = d[major].abs();
        let inverse = if length > 1e-4 { 1.0 / d[major] } else { 0.0 };
        let slope = d[1 - major] * inverse;
        let cosine = 1.0 / (1.0 + slope * slope).sqrt();
        let soft = ((way[1 - major] - slope * way[major]).abs() * cosine).max(1.0);
        let along = (way[major] + slope * way[1 - major]).abs() * cosine * cosine;
        let blurred = along.max(SHARP);
        let tip = if stops { TIP } else { 0.0 };
        let past = [begins, stops].map(|ends| if ends { 0.5 * blurred } else { 0.0 });
        // Segments of a strip share their ends: each has the columns from its first up to its last.
        let on = [past[0], past[1] + tip];
        let (low, [below, above]) = if d[major] >= 0.0 {
            (start[major], on)
        } else {
            (start[major] - length, [on[1], on[0]])
        };
        let (low, high) = (low - below, low + length + above);
        let rate = 1.0 / blurred;
        let whole = [0.0, 1.0];
        let rises = [rate, (0.5 - low) * rate];
        let falls = [-rate, (high - 0.5) * rate];
        let dwells = if begins && stops {
            ((length + tip) * rate).min(1.0)
        } else {
            1.0
        };
        let line = Self {
            major,
            start,
            inverse,
            slope,
            cosine,
            half,
            soft,
            most: (half / soft + 0.5).min(1.0) * dwells,
            fades: [
                if below > 0.0 { rises } else { whole },
                if above > 0.0 { falls } else { whole },
            ],
        };
        (line, [low, high])
    }

    /// Of a column: the place along the piece, 0 to 1, and that of the middle across it.
    #[inline(always)]
    pub(super) fn at(&self, column: f32) -> (f32, f32) {
        let off = column + 0.5 - self.start[self.major];
        let t = (off * self.inverse).clamp(0.0, 1.0);
        (t, self.start[1 - self.major] + off * self.slope - 0.5)
    }

    /// The places along and across the piece of a cell.
    #[inline]
    pub(super) fn place(&self, cell: [f32; 2]) -> [f32; 2] {
        let (t, middle) = self.at(cell[self.major]);
        let off = (cell[1 - self.major] - middle).abs() * self.cosine;
        let off = (off - 0.5 * (self.soft - 1.0)).max(0.0);
        [t, (off / self.half).min(1.0)]
    }

    /// Largest distance from its middle that it covers.
    pub(super) fn reach(&self) -> f32 {
        self.half + 0.5 * self.soft
    }

    /// The same across its columns.
    pub(super) fn across(&self) -> f32 {
        self.reach() / self.cosine
    }

    /// The rows that it covers on those columns, of `rows`.
    pub(super) fn rows(&self, columns: &Range<usize>, rows: usize) -> Range<usize> {
        let across = self.across();
        let (_, first) = self.at(columns.start as f32);
        let (_, last) = self.at(columns.end as f32 - 1.0);
        let row = |edge: f32| (edge + 1.0).clamp(0.0, rows as f32) as usize;
        row(first.min(last) - across)..row(first.max(last) + across)
    }
}

impl Piece {
    #[inline(always)]
    pub(super) fn lower_side(&self, t: f32) -> f32 {
        self.z[0] + t * self.z[1] + self.bottom
    }
}
