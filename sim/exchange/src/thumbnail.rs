//! A picture made small.

use std::collections::HashMap;
use std::convert::Infallible;

use maulstick_appearance::Bakery;
use maulstick_appearance::bands::in_order;
use maulstick_appearance::display::DisplayTile;
use maulstick_appearance::picture::{Depth, Drawing, Export, Picture};
use maulstick_canvas::page::Page;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_optics::colour::{SrgbTable, srgb_decode};
use maulstick_painting::Painting;
use maulstick_painting::picture::flat_drawing;
use maulstick_types::paint::TILE;

/// Greatest side of a thumbnail in a file, pixels.
pub(crate) const SIDE: usize = 256;

/// A surface with its colours alone, in sRGB, with at most `side` pixels either way; `None` if there is no such
/// surface.
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

/// Small pictures of paintings that share tiles, like the states of a history: a few colours of each tile are cached,
/// so that a picture costs only its differences from earlier ones.
#[derive(Debug, Default)]
pub struct HistoryPictures {
    tiles: HashMap<TileKey, Blocks>,
    /// Number of pictures so far.
    drawn: u64,
}

/// Key of a tile's colours: its place, its wet and its dried paint, the look of the painting, and the cells across a
/// block.
type TileKey = (TileId, Option<u64>, Option<u64>, i64, usize);

/// Means of linear light of the blocks of a tile, rows from the top.
#[derive(Debug)]
struct Blocks {
    light: Vec<[f32; 3]>,
    /// The picture that they were last used for.
    used: u64,
}

/// Greatest number of cells across a block.
const BLOCK: usize = 8;
/// Number of cached colours beyond twice those of a whole surface: 12 MB.
const SPARE_COLOURS: usize = 1 << 20;

impl HistoryPictures {
    /// A surface with its colours alone, in sRGB, with at most `side` pixels either way; `None` if there is no such
    /// surface.
    pub fn draw(&mut self, painting: &mut Painting, surface: u32, side: usize) -> Option<Picture> {
        let print = painting.look().print();
        let export = Export::default();
        let drawing = flat_drawing(painting, surface, &export)?;
        let cells = drawing.banded().cells();
        let block = (cells[0].max(cells[1]) / side.max(1)).clamp(1, BLOCK);
        // A power of two parts a tile evenly.
        let block = 1 << block.ilog2();
        self.drawn += 1;
        let size = cells.map(|side| side.div_ceil(block));
        let mut small = Thumbnail::new(size, side.max(1));
        let (mut bakery, mut shown) = (Bakery::default(), 0);
        for band in 0..drawing.banded().bands() {
            let mut light =
                vec![[0.0f32; 3]; drawing.banded().rows(band).len().div_ceil(block) * size[0]];
            for (id, tile) in drawing.banded().tiles(band) {
                let wet = tile.and_then(Tile::wet_page).map(Page::id);
                let dry = tile.and_then(Tile::dry).map(|stack| stack.id());
                let key = (id, wet, dry, print, block);
                let known = self.tiles.entry(key).or_insert_with(|| {
                    let look = drawing.banded().shown(id, tile, &mut bakery);
                    Blocks {
                        light: blocks(&drawing, (id, &look), block, &small.light),
                        used: 0,
                    }
                });
                known.used = self.drawn;
                shown += known.light.len();
                let across = drawing.banded().within(id)[0].div_ceil(block);
                let left = id.x as usize * TILE / block;
                for (row, own) in known.light.chunks_exact(across).enumerate() {
                    light[row * size[0] + left..][..across].copy_from_slice(own);
                }
            }
            light
                .chunks_exact(size[0])
                .for_each(|row| small.add_light(row));
        }
        let kept: usize = self.tiles.values().map(|own| own.light.len()).sum();
        if kept > 2 * shown + SPARE_COLOURS {
            let drawn = self.drawn;
            self.tiles.retain(|_, own| own.used == drawn);
        }
        let [width, height] = small.size();
        Some(Picture::srgb(width, height, small.bytes()))
    }
}

/// Means of linear light of the blocks of a tile, rows from the top; `linear` is that of a byte.
fn blocks(
    drawing: &Drawing<'_>,
    (id, shown): (TileId, &DisplayTile),
    block: usize,
    linear: &[f64],
) -> Vec<[f32; 3]> {
    let [across, rows] = drawing.banded().within(id);
    let pixels = drawing.tile((id, shown), Depth::Eight);
    let size = [across, rows].map(|side| side.div_ceil(block));
    let mut sums = vec![[0.0; 4]; size[0] * size[1]];
    for (at, pixel) in pixels.chunks_exact(3).enumerate() {
        let (x, y) = (at % across, at / across);
        let sum: &mut [f64; 4] = &mut sums[y / block * size[0] + x / block];
        for (sum, byte) in sum.iter_mut().zip(pixel) {
            *sum += linear[usize::from(*byte)];
        }
        sum[3] += 1.0;
    }
    let mean = |[r, g, b, pixels]: [f64; 4]| [r, g, b].map(|sum| (sum / pixels) as f32);
    sums.into_iter().map(mean).collect()
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
    /// A thumbnail of a picture of this size, across and down, with at most `most` pixels along each side.
    pub(crate) fn new(from: [usize; 2], most: usize) -> Self {
        let longest = from[0].max(from[1]);
        let size = from.map(|side| {
            if longest > most {
                ((side * most + longest / 2) / longest).max(1)
            } else {
                side
            }
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

    /// Adds the next rows, of sRGB bytes.
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

    /// Adds the next row, of linear light.
    fn add_light(&mut self, row: &[[f32; 3]]) {
        let y = self.rows * self.size[1] / self.from[1];
        for (x, pixel) in row.iter().enumerate() {
            let x = x * self.size[0] / self.from[0];
            let sum = &mut self.sums[y * self.size[0] + x];
            for (sum, light) in sum.iter_mut().zip(pixel) {
                *sum += f64::from(*light);
            }
            sum[3] += 1.0;
        }
        self.rows += 1;
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
