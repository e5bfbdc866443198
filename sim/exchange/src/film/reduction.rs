//! Reduced pictures: each pixel is the mean of the linear light of its area.

use maulstick_optics::colour::srgb_decode;

/// Pixels covered by a cell along one side: index of the pixel, and the share of it.
type Cover = Vec<(usize, f32)>;

/// Reduction of a picture from one size to another.
#[derive(Debug)]
pub(super) struct Reduction {
    /// Cells across and down.
    pub(super) cells: [usize; 2],
    /// Pixels across and down.
    pub(super) size: [usize; 2],
    /// For each column, and for each row from the top.
    covers: [Vec<Cover>; 2],
    /// Linear light of an sRGB value of 16 bits.
    linear: Vec<f32>,
}

impl Reduction {
    /// A reduction from cells to pixels, across and down.
    pub(super) fn new(cells: [usize; 2], size: [usize; 2]) -> Self {
        let decode = |value: u32| srgb_decode(f64::from(value) / 65_535.0) as f32;
        Self {
            cells,
            size,
            covers: [0, 1].map(|side| covers(cells[side], size[side])),
            linear: (0..=u32::from(u16::MAX)).map(decode).collect(),
        }
    }

    /// Contribution of rows of cells from the row `top` on to the light of the pixels: the first row of pixels, and the
    /// linear light of it and of those after it. The rows are sRGB of 16 bits, the higher byte first.
    pub(super) fn light(&self, top: usize, rows: &[u8]) -> (usize, Vec<[f32; 3]>) {
        let [columns, lines] = &self.covers;
        let width = self.size[0];
        let mut light: Vec<[f32; 3]> = Vec::new();
        let own = lines.iter().skip(top);
        let first = own.clone().flatten().next().map_or(0, |(row, _)| *row);
        for (cells, line) in rows.chunks_exact(6 * self.cells[0]).zip(own) {
            let mut row = vec![[0.0f32; 3]; width];
            for (cell, cover) in cells.as_chunks::<6>().0.iter().zip(columns) {
                let value = |c: usize| u16::from_be_bytes([cell[2 * c], cell[2 * c + 1]]);
                let colour = [0, 1, 2].map(|c| self.linear[usize::from(value(c))]);
                for (pixel, share) in cover {
                    (0..3).for_each(|c| row[*pixel][c] += share * colour[c]);
                }
            }
            for (pixel, share) in line {
                let at = (pixel - first) * width;
                if light.len() < at + width {
                    light.resize(at + width, [0.0; 3]);
                }
                for (sum, colour) in light[at..].iter_mut().zip(&row) {
                    (0..3).for_each(|c| sum[c] += share * colour[c]);
                }
            }
        }
        (first, light)
    }
}

/// For each of `from` cells along a side, its cover of `to` pixels.
fn covers(from: usize, to: usize) -> Vec<Cover> {
    let edge = |cell: usize| (cell * to) as f64 / from.max(1) as f64;
    let cover = |cell: usize| {
        let (start, end) = (edge(cell), edge(cell + 1));
        let pixels = start.floor() as usize..(end.ceil() as usize).min(to);
        let share = |pixel: usize| end.min((pixel + 1) as f64) - start.max(pixel as f64);
        let shares = pixels.map(|pixel| (pixel, share(pixel) as f32));
        shares.filter(|(_, share)| *share > 0.0).collect()
    };
    (0..from).map(cover).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_is_covered_once() {
        for (from, to) in [(1, 1), (7, 3), (64, 64), (100, 99), (1000, 7), (3, 5)] {
            let mut sums = vec![0.0f64; to];
            for (pixel, share) in covers(from, to).into_iter().flatten() {
                sums[pixel] += f64::from(share);
            }
            let off = sums.iter().map(|sum| (sum - 1.0).abs());
            assert!(off.fold(0.0, f64::max) < 1e-5, "{from} to {to}: {sums:?}");
        }
    }

    #[test]
    fn light_is_averaged_whatever_rows_come_together() {
        // A chessboard of black and white gives half the light.
        let board = |rows: std::ops::Range<usize>| -> Vec<u8> {
            let cell = |x: usize, y: usize| [[0, 0xff][(x + y) % 2]; 6];
            rows.flat_map(|y| (0..90).flat_map(move |x| cell(x, y)))
                .collect()
        };
        let reduction = Reduction::new([90, 60], [20, 16]);
        let mut frame = vec![[0.0f32; 3]; 20 * 16];
        for rows in [0..7, 7..40, 40..60] {
            let (first, light) = reduction.light(rows.start, &board(rows));
            for (sum, light) in frame.iter_mut().skip(20 * first).zip(light) {
                (0..3).for_each(|c| sum[c] += light[c]);
            }
        }
        let off = frame.iter().flatten().map(|light| (light - 0.5).abs());
        assert!(off.fold(0.0, f32::max) < 0.04);
    }
}
