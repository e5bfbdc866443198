//! A picture resampled to a canvas: the mean of an area where it becomes smaller, linear between pixels where it
//! becomes larger; in linear light.

use std::collections::VecDeque;

use maulstick_canvas::assets::MOST_PIXELS;
use maulstick_optics::colour::SrgbTable;

use crate::import_error::ImportError;
use crate::read_image::Image;

/// Colours of a canvas's cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Raster {
    /// Cells across and up.
    pub cells: [usize; 2],
    /// Encoded sRGB, row by row from the lowest.
    pub rgb: Vec<[u8; 3]>,
}

/// Range of a picture that is used along one of its sides.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    /// Pixels of the picture.
    pixels: usize,
    /// Number of cells made from them.
    cells: usize,
    /// Start of the first cell, pixels.
    from: f64,
    /// Pixels per cell.
    scale: f64,
}

/// The middle of a picture that covers `cells`, of the same proportions.
fn cover(pixels: [usize; 2], cells: [usize; 2]) -> [Cut; 2] {
    let scale = |i: usize| pixels[i] as f64 / cells[i] as f64;
    let scale = scale(0).min(scale(1));
    [0, 1].map(|i| Cut {
        pixels: pixels[i],
        cells: cells[i],
        from: 0.5 * (pixels[i] as f64 - scale * cells[i] as f64),
        scale,
    })
}

fn whole(pixels: [usize; 2], cells: [usize; 2]) -> [Cut; 2] {
    [0, 1].map(|i| Cut {
        pixels: pixels[i],
        cells: cells[i],
        from: 0.0,
        scale: pixels[i] as f64 / cells[i] as f64,
    })
}

/// Least share; smaller ones are rounding errors.
const LEAST_SHARE: f64 = 1e-9;

/// Pixels of a cell, from the first on, with their shares.
#[derive(Clone, Debug, PartialEq)]
struct Taps {
    first: usize,
    shares: Vec<f64>,
}

impl Cut {
    fn taps(&self, cell: usize) -> Taps {
        let last = self.pixels - 1;
        if self.scale < 1.0 {
            let at = self.from + (cell as f64 + 0.5) * self.scale - 0.5;
            let at = at.clamp(0.0, last as f64);
            let first = (at as usize).min(last.saturating_sub(1));
            let share = at - first as f64;
            let shares = if share > 0.0 {
                vec![1.0 - share, share]
            } else {
                vec![1.0]
            };
            return Taps { first, shares };
        }
        let low = (self.from + cell as f64 * self.scale).max(0.0);
        let high = (self.from + (cell as f64 + 1.0) * self.scale).min(self.pixels as f64);
        let share = |pixel: usize| high.min(pixel as f64 + 1.0) - low.max(pixel as f64);
        let mut first = (low as usize).min(last);
        // A cell that begins at the next pixel may be a rounding error before it.
        first += usize::from(first < last && share(first) <= LEAST_SHARE);
        let covered = (first..self.pixels).map(share);
        let mut shares: Vec<f64> = covered.take_while(|share| *share > LEAST_SHARE).collect();
        if shares.is_empty() {
            shares.push(1.0);
        }
        let sum: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share /= sum);
        Taps { first, shares }
    }
}

/// Resamples rows of `C` channels, one at a time from the top: `source` reads a row of the picture, `sink` takes one of
/// the canvas. Each row of the picture is read once.
fn resample<const C: usize>(
    [across, down]: [Cut; 2],
    source: &mut dyn FnMut(usize, &mut Vec<[f32; C]>),
    sink: &mut dyn FnMut(&[[f32; C]]),
) {
    let columns: Vec<Taps> = (0..across.cells).map(|cell| across.taps(cell)).collect();
    let mut narrow: VecDeque<(usize, Vec<[f64; C]>)> = VecDeque::new();
    let (mut row, mut out) = (Vec::new(), vec![[0.0f32; C]; across.cells]);
    for cell in 0..down.cells {
        let taps = down.taps(cell);
        while narrow.front().is_some_and(|(y, _)| *y < taps.first) {
            narrow.pop_front();
        }
        let mut sums = vec![[0.0f64; C]; across.cells];
        for (i, share) in taps.shares.iter().enumerate() {
            let y = taps.first + i;
            if narrow.back().is_none_or(|(newest, _)| *newest < y) {
                source(y, &mut row);
                narrow.push_back((y, columns.iter().map(|taps| mean(taps, &row)).collect()));
            }
            let Some((_, line)) = narrow.iter().find(|(at, _)| *at == y) else {
                continue;
            };
            for (sum, value) in sums.iter_mut().zip(line) {
                (0..C).for_each(|c| sum[c] += share * value[c]);
            }
            // Rows in the middle of an area are not needed again.
            while narrow.len() > 2 {
                narrow.pop_front();
            }
        }
        for (out, sum) in out.iter_mut().zip(&sums) {
            *out = sum.map(|value| value as f32);
        }
        sink(&out);
    }
}

fn mean<const C: usize>(taps: &Taps, row: &[[f32; C]]) -> [f64; C] {
    let mut sum = [0.0; C];
    for (share, pixel) in taps.shares.iter().zip(&row[taps.first..]) {
        (0..C).for_each(|c| sum[c] += share * f64::from(pixel[c]));
    }
    sum
}

/// The colours of a canvas's cells from a picture that covers it, centred, with the excess cut off.
///
/// # Errors
/// [`ImportError::Canvas`] for more than 67 million cells.
pub fn colours(image: &Image, cells: [usize; 2]) -> Result<Raster, ImportError> {
    let [across, up] = cells.map(|cells| cells.max(1));
    if across as u64 * up as u64 > MOST_PIXELS {
        return Err(ImportError::Canvas(across, up));
    }
    let table = SrgbTable::default();
    let mut rgb = vec![[0u8; 3]; across * up];
    let mut rows = rgb.rchunks_exact_mut(across);
    resample(
        cover(image.size(), [across, up]),
        &mut |row, into| image.colours(row, into),
        &mut |line| {
            if let Some(row) = rows.next() {
                for (to, from) in row.iter_mut().zip(line) {
                    *to = from.map(|channel| table.byte(channel));
                }
            }
        },
    );
    Ok(Raster {
        cells: [across, up],
        rgb,
    })
}

/// A whole picture as heights at `size` pixels, 0 to 65535, row by row from the top.
///
/// # Errors
/// As [`colours`].
pub fn heights(image: &Image, size: [usize; 2]) -> Result<Vec<u16>, ImportError> {
    let [across, down] = size.map(|pixels| pixels.max(1));
    if across as u64 * down as u64 > MOST_PIXELS {
        return Err(ImportError::Canvas(across, down));
    }
    let mut heights = Vec::with_capacity(across * down);
    resample(
        whole(image.size(), [across, down]),
        &mut |row, into| image.heights(row, into),
        &mut |line| {
            let value = |[height]: &[f32; 1]| (height * 65_535.0 + 0.5) as u16;
            heights.extend(line.iter().map(value));
        },
    );
    Ok(heights)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grey picture of these values, resampled.
    fn fitted(size: [usize; 2], values: &[f32], cut: [Cut; 2]) -> Vec<f32> {
        let mut out = Vec::new();
        let mut asked = vec![0; size[1]];
        resample(
            cut,
            &mut |row, into: &mut Vec<[f32; 1]>| {
                asked[row] += 1;
                into.clear();
                into.extend(values[row * size[0]..][..size[0]].iter().map(|v| [*v]));
            },
            &mut |line| out.extend(line.iter().map(|[v]| *v)),
        );
        assert!(asked.iter().all(|times| *times <= 1), "{asked:?}");
        out
    }

    #[test]
    fn every_cell_is_made_of_all_the_pixels_under_it() {
        for (pixels, cells) in [(3000, 800), (2500, 800), (3000, 1200), (4800, 1024), (7, 7)] {
            let scale = pixels as f64 / cells as f64;
            let cut = Cut {
                pixels,
                cells,
                from: 0.0,
                scale,
            };
            for cell in 0..cells {
                let taps = cut.taps(cell);
                let least = (scale - 1.0).floor().max(1.0) as usize;
                assert!(
                    taps.shares.len() >= least,
                    "{pixels} onto {cells}, cell {cell}: {taps:?}"
                );
            }
        }
    }

    #[test]
    fn smaller_pictures_are_means_of_areas_and_larger_ones_are_smooth() {
        let size = [3, 2];
        let values = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        // Two cells of 1.5 pixels each way, the picture cut to a square would be 2×2.
        assert_eq!(fitted(size, &values, whole(size, [1, 1])), [2.5]);
        let halves = fitted(size, &values, whole(size, [2, 1]));
        assert!((halves[0] - (1.0 / 3.0 + 1.5)).abs() < 1e-6, "{halves:?}");
        assert_eq!(fitted(size, &values, whole(size, size)), values);
        // Between pixel middles it is linear, beyond them level.
        let wide = fitted([2, 1], &[0.0, 1.0], whole([2, 1], [4, 1]));
        assert_eq!(wide, [0.0, 0.25, 0.75, 1.0]);
        assert!(wide != [0.0, 0.0, 1.0, 1.0], "a fault would pass");
    }

    #[test]
    fn the_middle_covers_the_canvas() {
        let size = [20_000, 10];
        let [across, down] = cover(size, [1024, 1024]);
        assert!((across.scale - 10.0 / 1024.0).abs() < 1e-12 && down.from.abs() < 1e-9);
        assert!((across.from - 9995.0).abs() < 1e-9);
        let values: Vec<f32> = (0..200_000).map(|i| (i % 20_000) as f32).collect();
        let square = fitted(size, &values, cover(size, [10, 10]));
        assert!((square[0] - 9995.0).abs() < 1e-3 && (square[9] - 10_004.0).abs() < 1e-3);
        let narrow = fitted([10, 30], &vec![0.25; 300], cover([10, 30], [64, 7]));
        assert!(narrow.iter().all(|v| (v - 0.25).abs() < 1e-6));
        assert_eq!(fitted([1, 1], &[7.0], cover([1, 1], [3, 2])), [7.0; 6]);
    }
}
