//! The samples of a few rows of a painting.

use std::ops::Range;

use maulstick_appearance::Bakery;
use maulstick_appearance::bands::{Banded, Shelf};
use maulstick_canvas::planes::Planes;
use maulstick_canvas::quantum::{QUANTUM_M, SLOTS};
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::paint::TILE;

use super::channels::Source;

/// Size of a sample, bytes.
const SAMPLE: usize = size_of::<f32>();

/// Red, green, blue, height and gloss of a band, row by row from its lowest.
type Shown = [Vec<f32>; 5];

/// Rows in the layout of the file: line by line, channel by channel.
pub(super) struct Rows<'a> {
    banded: &'a Banded<'a>,
    /// Index of each channel of [`Shown`] among all channels.
    shown: [usize; 5],
    /// Indices of the wet and the dry paint of each slot.
    wet: [usize; SLOTS],
    dry: [usize; SLOTS],
    channels: usize,
    bands: Shelf<Shown>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(banded: &'a Banded<'a>, channels: &[(String, Source)]) -> Self {
        let mut rows = Self {
            banded,
            shown: [0; 5],
            wet: [0; SLOTS],
            dry: [0; SLOTS],
            channels: channels.len(),
            bands: Shelf::default(),
        };
        for (place, (_, source)) in channels.iter().enumerate() {
            match *source {
                Source::Colour(i) => rows.shown[i] = place,
                Source::Height => rows.shown[3] = place,
                Source::Gloss => rows.shown[4] = place,
                Source::Wet(slot) => rows.wet[slot] = place,
                Source::Dry(slot) => rows.dry[slot] = place,
            }
        }
        rows
    }

    fn shown(&self, band: usize) -> Shown {
        let cells = self.banded.rows(band).len() * self.banded.cells()[0];
        let mut planes: Shown = std::array::from_fn(|_| vec![0.0; cells]);
        for (id, tile) in self.banded.tiles(band) {
            let shown = self.banded.shown(id, tile, &mut Bakery::default());
            let [red, green, blue] = &shown.rgb;
            let from = [red, green, blue, &shown.height, &shown.gloss];
            for (plane, from) in planes.iter_mut().zip(from) {
                self.banded.spread(id, from, plane);
            }
        }
        planes
    }

    /// Bytes of these lines, counted from the top, in this machine's order.
    pub(super) fn bytes(&self, lines: Range<usize>) -> Vec<u8> {
        let [width, height] = self.banded.cells();
        let mut bytes = vec![0; lines.len() * width * self.channels * SAMPLE];
        let rows = height - lines.end..height - lines.start;
        let band_of = |row: usize| self.banded.bands() - 1 - row / TILE;
        for band in band_of(rows.end - 1)..=band_of(rows.start) {
            let own = self.banded.rows(band);
            let common = rows.start.max(own.start)..rows.end.min(own.end);
            let mut block = Block {
                bytes: &mut bytes,
                top: rows.end - 1,
                width,
                channels: self.channels,
            };
            let shown = self.bands.get(band, || self.shown(band));
            for (channel, plane) in self.shown.iter().zip(shown.iter()) {
                for row in common.clone() {
                    let values = &plane[(row - own.start) * width..][..width];
                    block.put(*channel, row, 0, values.iter().copied());
                }
            }
            for (id, tile) in self.banded.tiles(band) {
                if let Some(tile) = tile {
                    self.put_paint((id, tile), common.clone(), &mut block);
                }
            }
        }
        bytes
    }

    /// Writes the paint of these rows of a tile, counted from the surface's lowest.
    fn put_paint(&self, (id, tile): (TileId, &Tile), rows: Range<usize>, block: &mut Block<'_>) {
        let lowest = id.y as usize * TILE;
        let cells = (rows.start - lowest) * TILE..(rows.end - lowest) * TILE;
        let across = self.banded.within(id)[0];
        let mut put = |channel: usize, quanta: &[f64]| {
            for (row, quanta) in rows.clone().zip(quanta.chunks_exact(TILE)) {
                let values = quanta[..across].iter();
                let values = values.map(|quanta| (quanta * QUANTUM_M) as f32);
                block.put(channel, row, id.x as usize * TILE, values);
            }
        };
        let mut sums: [Option<Vec<f64>>; SLOTS] = [const { None }; SLOTS];
        let add = |planes: &Planes, sums: &mut [Option<Vec<f64>>; SLOTS]| {
            for (slot, plane) in planes {
                let sum = sums[*slot].get_or_insert_with(|| vec![0.0; cells.len()]);
                let counts = sum.iter_mut().zip(&plane[cells.clone()]);
                counts.for_each(|(sum, count)| *sum += f64::from(*count));
            }
        };
        add(&tile.wet(), &mut sums);
        for (slot, sum) in sums.iter_mut().enumerate() {
            if let Some(sum) = sum.take() {
                put(self.wet[slot], &sum);
            }
        }
        let Some(stack) = tile.dry() else {
            return;
        };
        for layer in stack.layers() {
            add(&layer.planes.get(), &mut sums);
        }
        for (slot, sum) in sums.iter().enumerate() {
            if let Some(sum) = sum {
                put(self.dry[slot], sum);
            }
        }
    }
}

/// The bytes of a block, of which `top` is the highest row.
struct Block<'a> {
    bytes: &'a mut [u8],
    top: usize,
    width: usize,
    channels: usize,
}

impl Block<'_> {
    /// Writes samples of a channel into a row, from column `left` on.
    fn put(&mut self, channel: usize, row: usize, left: usize, values: impl Iterator<Item = f32>) {
        let at = ((self.top - row) * self.channels + channel) * self.width + left;
        let bytes = self.bytes[at * SAMPLE..].chunks_exact_mut(SAMPLE);
        for (bytes, value) in bytes.zip(values) {
            bytes.copy_from_slice(&value.to_ne_bytes());
        }
    }
}
