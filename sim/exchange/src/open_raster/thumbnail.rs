//! A picture made small.

use maulstick_optics::colour::{SrgbTable, srgb_decode};

/// Pixels of the longer side at most.
const SIDE: usize = 256;

/// Means of linear light over the pixels of a picture that comes row after row.
pub(super) struct Thumbnail {
    from: [usize; 2],
    size: [usize; 2],
    /// Linear light of a byte.
    light: Vec<f64>,
    /// Red, green and blue of each pixel, and of how many pixels.
    sums: Vec<[f64; 4]>,
    rows: usize,
}

impl Thumbnail {
    /// Of a picture of so many pixels across and down.
    pub(super) fn new(from: [usize; 2]) -> Self {
        let longest = from[0].max(from[1]);
        let size = from.map(|side| match longest > SIDE {
            true => ((side * SIDE + longest / 2) / longest).max(1),
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
    pub(super) fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Takes the next rows, of sRGB bytes.
    pub(super) fn add(&mut self, rows: &[u8]) {
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
    pub(super) fn bytes(&self) -> Vec<u8> {
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
        let mut small = Thumbnail::new([3, 2]);
        let bytes: Vec<u8> = (0..18).map(|i| i * 14).collect();
        small.add(&bytes[..9]);
        small.add(&bytes[9..]);
        assert_eq!((small.size(), small.bytes()), ([3, 2], bytes));
        let mut board = Thumbnail::new([1024, 60]);
        let row = |y: usize| (0..1024).flat_map(move |x| [[0, 255][(x + y) % 2]; 3]);
        board.add(&(0..60).flat_map(row).collect::<Vec<u8>>());
        // A chessboard of black and white gives half the light: 188, not 128.
        assert_eq!(board.size(), [256, 15]);
        assert!(board.bytes().iter().all(|byte| *byte == 188));
        assert_eq!(Thumbnail::new([1, 5000]).size(), [1, 256]);
    }
}
