//! A quantity of a surface as a grey PNG of 16 bits.

use std::io::Write;

use maulstick_appearance::bands::{Banded, in_order};
use maulstick_appearance::picture::{Depth, Pixels, density, write_png};
use png::text_metadata::TEXtChunk;

use crate::ExchangeError;
use crate::surface::Steps;

/// Writes `values` of each band, a value a cell from the lowest row up, and a text about them under a keyword. `pHYs`
/// has the size of a cell.
///
/// # Errors
/// [`ExchangeError`].
pub(crate) fn write_grey_map(
    banded: &Banded<'_>,
    (keyword, text): (&str, String),
    values: impl Fn(usize) -> Vec<u16> + Sync,
    to: impl Write,
    steps: &mut Steps<'_>,
) -> Result<(), ExchangeError> {
    let width = banded.cells()[0];
    let pixels = Pixels {
        size: banded.cells(),
        colour: png::ColorType::Grayscale,
        depth: Depth::Sixteen,
        icc: None,
        pixels_per_m: Some(density(banded.cell_m())),
    };
    let mut info = pixels.info();
    info.uncompressed_latin1_text = vec![TEXtChunk::new(keyword, text)];
    let job = |band: usize| {
        let values = values(band);
        let rows = values.chunks_exact(width).rev();
        let bytes = rows.flatten().flat_map(|value| value.to_be_bytes());
        bytes.collect::<Vec<u8>>()
    };
    write_png::<ExchangeError>(to, info, |file| {
        in_order(banded.bands(), job, |_, rows| {
            file.write_all(&rows)?;
            steps.step();
            Ok(())
        })
    })
}
