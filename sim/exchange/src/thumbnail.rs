//! A picture made small.

use std::convert::Infallible;

use maulstick_appearance::bands::in_order;
use maulstick_appearance::picture::{Depth, Export, Picture};
use maulstick_optics::colour::{SrgbTable, srgb_decode};
use maulstick_painting::Painting;
use maulstick_painting::picture::flat_drawing;

/// Pixels of the longer side of a thumbnail in a file, at most.
pub(crate) const SIDE: usize = 256;

/// A surface with its colours alone, in sRGB, with at most `side` pixels either way; none if there is no
/// such surface.
pub fn small_picture(painting: &mut Painting, surface: u32, side: usize) -> Option<Picture> {
    let export = Export::default();
    let drawing = flat_drawing(painting, surface, &export)?;
    let mut small = Thumbnail::new(drawing.banded().cells(), side.max(1));
    let Ok(()) = in_order(
        drawing.banded().bands(),
        |band| drawing.band(band, Depth::Eight),
        |_, rows| -> Result<(), Infallible> {
            small.add(&rows);
            Ok(())
        },
    );
    let [width, height] = small.size();
    Some(Picture::srgb(width, height, small.bytes()))
}

/// Means of linear light over the pixels of a picture that comes row after row.
pub(crate) struct Thumbnail {
    from: [usize; 2],
    size: [usize; 2],
    /// Linear light of a byte.
    light: Vec<f64>,
    /// Red, green and blue of each pixel, and of how many pixels.
    sums: Vec<[f64; 4]>,
    rows: usize,
}

impl Thumbnail {
    /// Of a picture of so many pixels across and down, with at most `most` either way.
    pub(crate) fn new(from: [usize; 2], most: usize) -> Self {
        let longest = from[0].max(from[1]);
        let size = from.map(|side| match longest > most {
            true => ((side * most + longest / 2) / longest).max(1),
            false => side,
        });
        Self {
            from,
            size,
            light: (0..=u8::MAX)
                .map(|byte| srgb_decode(f64::from(byte) / 255.0))
                .collect(),
            sums: vec![[0.0; 4]; size[0] * size[1]],
            rows: 0,
        }
    }

    /// Pixels across and down.
    pub(crate) fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Takes the next rows, of sRGB bytes.
    pub(crate) fn add(&mut self, rows: &[u8]) {
        let [width, height] = self.from;
        for row in rows.chunks_exact(width * 3) {
            let y = self.rows * self.size[1] / height;
            for (x, pixel) in row.chunks_exact(3).enumerate() {
                let x = x * self.size[0] / width;
                let sum = &mut self.sums[y * self.size[0] + x];
                for (sum, byte) in sum.iter_mut().zip(pixel) {
                    *sum += self.light[usize::from(*byte)];
                }
                sum[3] += 1.0;
            }
            self.rows += 1;
        }
    }

    /// Its sRGB bytes, three a pixel.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let table = SrgbTable::default();
        let colour = |[r, g, b, pixels]: &[f64; 4]| [r, g, b].map(|sum| sum / pixels);
        let colours = self.sums.iter().flat_map(colour);
        colours.map(|linear| table.byte(linear as f32)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_averaged_and_nothing_grows() {
        let mut small = Thumbnail::new([3, 2], SIDE);
        let bytes: Vec<u8> = (0..18).map(|i| i * 14).collect();
        small.add(&bytes[..9]);
        small.add(&bytes[9..]);
        assert_eq!((small.size(), small.bytes()), ([3, 2], bytes));
        let mut board = Thumbnail::new([1024, 60], SIDE);
        let row = |y: usize| (0..1024).flat_map(move |x| [[0, 255][(x + y) % 2]; 3]);
        board.add(&(0..60).flat_map(row).collect::<Vec<u8>>());
        // A chessboard of black and white gives half the light: 188, not 128.
        assert_eq!(board.size(), [256, 15]);
        assert!(board.bytes().iter().all(|byte| *byte == 188));
        assert_eq!(Thumbnail::new([1, 5000], SIDE).size(), [1, 256]);
    }
}
