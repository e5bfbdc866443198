//! Drawing of the head into a grid of cells: the lowest piece of each cell is kept.
//!
//! Rows are drawn eight cells at a time. Only the height and the number of the piece are stored; all else is computed
//! for the remaining pieces alone.

use std::ops::Range;

use maulstick_num::lanes::Lanes;

use super::piece::Piece;
use super::ribbons::{Laid, Ribbons};
use crate::brush::traits::TEXELS_PER_STRIP;

/// Greatest height added to a ribbon that covers a cell only in part, cells: each of several adjacent ribbons gets the
/// cells that it covers most, so more of them give paint where cells are coarse.
const EDGE_PENALTY: f32 = 0.9;
/// Marker of a cell without a piece.
const NOTHING: f32 = -1.0;
/// Cells drawn at a time; rows are padded so that such a run never ends in the next one.
const LANES: usize = 8;
const LANE: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
/// Larger than any cover: a product with it limits a cover only where it is not positive.
const COVER_BOUND: f32 = 1e6;

/// The part of the head over a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Over<'a> {
    piece: &'a Piece,
    t: f32,
    /// Place across, 0 in the middle to 1 at an edge.
    across: f32,
    /// Share of the cell that is covered, 0 to 1.
    pub(super) cover: f32,
}

impl Over<'_> {
    /// Height of the lower side where the bristle, at rest on `ride`, may sink in by `sink`, cells.
    ///
    /// A pressed bristle has its solved height at 0: it follows the ride into the valleys of the tooth, and is lifted
    /// by higher parts.
    pub(super) fn bottom(&self, ride: f32, sink: f32) -> f32 {
        let z = self.piece.z[0] + self.t * self.piece.z[1];
        let rests = (z + ride.min(0.0)).max(ride);
        rests - sink + self.piece.bottom + self.piece.round * self.across * self.across
    }

    /// Height of the bristle's middle line, cells.
    pub(super) fn height(&self) -> f32 {
        self.piece.z[0] + self.t * self.piece.z[1]
    }

    /// Height of its lower side over its middle line, cells.
    pub(super) fn clearance(&self) -> f32 {
        self.piece.bottom + self.piece.round * self.across * self.across
    }

    /// The texel.
    pub(super) fn texel(&self) -> u32 {
        let along = (self.piece.along[0] + self.t * self.piece.along[1]) as usize;
        self.piece.texel + along.min(TEXELS_PER_STRIP - 1) as u32
    }

    /// Travel since the previous step, cells.
    pub(super) fn moved(&self) -> [f32; 2] {
        let [from, change] = self.piece.moved;
        [0, 1].map(|i| from[i] + self.t * change[i])
    }
}

/// The grid.
#[derive(Clone, Debug, Default)]
pub(super) struct Drawing {
    size: [usize; 2],
    /// The rows that are drawn.
    rows: Range<usize>,
    stride: usize,
    score: Vec<f32>,
    /// The lowest piece; whole numbers.
    number: Vec<f32>,
    /// Share of each cell that all pieces leave open. They overlap at random: each covers its share of the area that
    /// the others leave open.
    open: Vec<f32>,
    /// Pieces of cells that are drawn singly.
    pieces: Vec<Piece>,
}

impl Drawing {
    /// An empty grid of `size` columns and rows, of which only `rows` are drawn.
    pub(super) fn begin(&mut self, size: [usize; 2], rows: Range<usize>) {
        self.size = size;
        self.stride = size[0].next_multiple_of(LANES) + LANES;
        self.pieces.clear();
        let cells = self.stride * rows.len();
        self.rows = rows;
        self.score.clear();
        self.score.resize(cells, f32::MAX);
        self.number.clear();
        self.number.resize(cells, NOTHING);
        self.open.clear();
        self.open.resize(cells, 1.0);
    }

    /// The rows that are drawn.
    pub(super) fn rows(&self) -> Range<usize> {
        self.rows.clone()
    }

    /// Pieces that [cells](Self::draw_cell) were drawn with: the numbers of a head's ribbons come after theirs.
    pub(super) fn cells_drawn(&self) -> usize {
        self.pieces.len()
    }

    /// The part of the head over a cell of these rows.
    #[inline]
    pub(super) fn over<'a>(&'a self, ribbons: &'a Ribbons, x: usize, y: usize) -> Option<Over<'a>> {
        let at = (y - self.rows.start) * self.stride + x;
        let number = self.number[at];
        if number < 0.0 {
            return None;
        }
        let number = number as usize;
        let piece = match number.checked_sub(self.pieces.len()) {
            Some(on) => ribbons.piece(on)?,
            None => &self.pieces[number],
        };
        let [t, across] = piece.line.place([x as f32, y as f32]);
        let cover = 1.0 - self.open[at];
        Some(Over {
            piece,
            t,
            across,
            cover,
        })
    }

    /// Draws the piece of a ribbon that has this number.
    #[inline(always)]
    pub(super) fn draw<L: Lanes>(&mut self, laid: &Laid, number: f32) {
        let from = laid.rows.start.max(self.rows.start);
        let rows = from..laid.rows.end.min(self.rows.end);
        if rows.is_empty() {
            return;
        }
        match laid.piece.line.major {
            0 => self.draw_across::<L>(&laid.piece, number, laid.columns.clone(), rows),
            _ => self.draw_up::<L>(&laid.piece, number, rows),
        }
    }

    /// A piece that goes rather up than across: in each row all is the same but the cover.
    #[inline(always)]
    fn draw_up<L: Lanes>(&mut self, piece: &Piece, number: f32, rows: Range<usize>) {
        let line = &piece.line;
        let across = line.across();
        let edge = self.size[0] as f32;
        let hard = 1.0 / line.soft;
        let [reach, cosine] = [line.reach() * hard, line.cosine * hard].map(L::splat);
        for row in rows {
            let (t, middle) = line.at(row as f32);
            let fade = |[rate, at]: [f32; 2]| at + rate * row as f32;
            let fade = fade(line.fades[0]).min(fade(line.fades[1])).clamp(0.0, 1.0);
            let (most, fade) = (L::splat(line.most), L::splat(fade));
            let lowest = piece.lower_side(t) + piece.rank;
            let from = (middle - across + 1.0).clamp(0.0, edge) as usize;
            let to = (middle + across + 1.0).clamp(0.0, edge) as usize;
            let mut x = from;
            while x < to {
                let column = L::splat(x as f32) + L::of(&LANE);
                let off = (column - L::splat(middle)).abs();
                let cover = (reach - off * cosine).least(most) * fade;
                self.lanes::<L>(row, x, number, cover, L::splat(lowest));
                x += LANES;
            }
        }
    }

    /// A piece that goes rather across than up: of each row the columns near its middle line.
    #[inline(always)]
    fn draw_across<L: Lanes>(
        &mut self,
        piece: &Piece,
        number: f32,
        columns: Range<usize>,
        rows: Range<usize>,
    ) {
        let line = &piece.line;
        let across = line.across();
        let (_, origin) = line.at(0.0);
        let (low, high) = (columns.start as f32, columns.end as f32);
        // On a flat line a row has all of its columns.
        let steep = line.slope.abs() * (high - low) > across;
        let per_row = if steep { 1.0 / line.slope } else { 0.0 };
        let [start, aside] = line.start.map(L::splat);
        let [inverse, slope] = [line.inverse, line.slope].map(L::splat);
        let hard = 1.0 / line.soft;
        let [reach, cosine] = [line.reach() * hard, line.cosine * hard].map(L::splat);
        let most = L::splat(line.most);
        let [starts, ends] = line.fades.map(|fade| fade.map(L::splat));
        let [z, rise] = piece.z.map(L::splat);
        let [bottom, rank] = [piece.bottom, piece.rank].map(L::splat);
        for row in rows {
            let y = row as f32;
            let (x, end) = if steep {
                let middle = (y - origin) * per_row;
                let half = (across * per_row).abs() + 1.0;
                let x = (middle - half).clamp(low, high);
                (x as usize, (middle + half + 1.0).clamp(low, high) as usize)
            } else {
                (columns.start, columns.end)
            };
            let mut x = x;
            while x < end {
                let column = L::splat(x as f32) + L::of(&LANE);
                let off = column + L::splat(0.5) - start;
                let middle = aside + off * slope - L::splat(0.5);
                let cover = (reach - (L::splat(y) - middle).abs() * cosine).least(most);
                let fade = (starts[1] + starts[0] * column).least(ends[1] + ends[0] * column);
                let cover = cover * fade.least(L::splat(1.0)).most(L::splat(0.0));
                let inside = (L::splat(high) - column) * L::splat(COVER_BOUND);
                let t = (off * inverse).most(L::splat(0.0)).least(L::splat(1.0));
                let lowest = z + t * rise + bottom + rank;
                self.lanes::<L>(row, x, number, cover.least(inside), lowest);
                x += LANES;
            }
        }
    }

    /// Eight cells of a row from `x` on, with the cover and the height of each.
    #[inline(always)]
    fn lanes<L: Lanes>(&mut self, row: usize, x: usize, number: f32, cover: L, lowest: L) {
        let at = (row - self.rows.start) * self.stride + x;
        let (Some(scores), Some(numbers), Some(open)) = (
            self.score[at..].first_chunk_mut(),
            self.number[at..].first_chunk_mut(),
            self.open[at..].first_chunk_mut(),
        ) else {
            return;
        };
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let cover = cover.least(one);
        let height = lowest + (one - cover) * L::splat(EDGE_PENALTY);
        *open = (L::of(open) * (one - cover.most(zero))).values();
        let old = L::of(scores);
        let height = zero.less(cover).choose(height, L::splat(f32::MAX));
        let wins = height.less(old).choose(one, zero);
        *scores = height.least(old).values();
        // A conditional choice would be compiled to a masked store, which is many times slower on some processors.
        let before = L::of(numbers);
        *numbers = (before + wins * (L::splat(number) - before)).values();
    }

    /// Draws a piece over one whole cell.
    pub(super) fn draw_cell(&mut self, x: usize, y: usize, piece: Piece) {
        let at = (y - self.rows.start) * self.stride + x;
        self.open[at] = 0.0;
        let lowest = piece.lower_side(0.0);
        if lowest < self.score[at] {
            self.score[at] = lowest;
            self.number[at] = self.pieces.len() as f32;
            self.pieces.push(piece);
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::lanes::Plain;

    use super::super::piece::Line;
    use super::*;

    /// Drawing in runs of eight agrees with single cells.
    #[test]
    fn runs_of_cells_agree_with_single_cells() {
        let (mut drawing, ribbons) = (Drawing::default(), Ribbons::default());
        let size = [37, 29];
        let mut won = 0;
        for case in 0..400u32 {
            drawing.begin(size, 0..size[1]);
            let unit = |n: u32| ((case.wrapping_mul(2_654_435_761) >> n) & 255) as f32 / 255.0;
            let line = Line {
                major: (case & 1) as usize,
                start: [unit(1) * 40.0 - 2.0, unit(5) * 30.0 - 2.0],
                inverse: 0.2,
                slope: [0.0, 2.0 * unit(9) - 1.0][(case as usize >> 1) & 1],
                cosine: 0.8,
                half: 0.1 + 3.0 * unit(13),
                soft: 1.0,
                most: 1.0,
                fades: [[0.0, 1.0]; 2],
            };
            let piece = Piece {
                z: [unit(3), -0.5],
                line,
                ..Piece::default()
            };
            let columns = (size[line.major] / 5)..(size[line.major] * 4 / 5);
            let rows = match line.major {
                0 => line.rows(&columns, size[1]),
                _ => columns.clone(),
            };
            let laid = Laid {
                piece,
                columns: columns.clone(),
                rows,
            };
            drawing.draw::<Plain>(&laid, 0.0);
            drawing.pieces.push(piece);
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let cell = [x as f32, y as f32];
                    let (_, middle) = line.at(cell[line.major]);
                    let cover = line.reach() - (cell[1 - line.major] - middle).abs() * line.cosine;
                    let inside = columns.contains(&[x, y][line.major]) && cover > 1e-4;
                    let outside = !columns.contains(&[x, y][line.major]) || cover < -1e-4;
                    let drawn = drawing.over(&ribbons, x, y).is_some();
                    assert!(drawn || !inside, "case {case}: {x} {y} is not drawn");
                    assert!(!drawn || !outside, "case {case}: {x} {y} is drawn");
                    won += usize::from(drawn);
                }
            }
        }
        assert!(won > 5000, "{won}");
    }
}
