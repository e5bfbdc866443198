//! A painting in numbers, as an OpenEXR file: colour, height, and the thickness of each paint.
//!
//! | channel | holds |
//! | --- | --- |
//! | `R`, `G`, `B` | linear colour before light, primaries and white of sRGB, unclamped; without the surface's own reflection k₁ |
//! | `height` | m above the highest peaks of the bare ground |
//! | `gloss` | 0 (matt) to 1, from which GGX's roughness α follows as in [`write_gloss_map`](crate::write_gloss_map) |
//! | `wet.<paint>`, `dry.<paint>` | thickness of that paint alone, m |
//!
//! All are 32-bit floats, a pixel a cell, from the top row, in blocks of 16 lines packed by ZIP. A thickness is a count
//! of quanta times [`QUANTUM_M`], from which the count can be recovered below 15 mm.

mod channels;
mod rows;

use std::io::{BufWriter, Seek, Write};

use exr::block::chunk::Chunk;
use exr::block::writer::ChunksWriter;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::compression::Compression;
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, Chromaticities, LineOrder, SampleType, Text};
use exr::meta::header::{Header, LayerAttributes};
use maulstick_appearance::bands::in_order;
#[cfg(doc)]
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_painting::Painting;
use maulstick_types::paint::TILE;

use self::channels::{Source, channels};
use self::rows::Rows;
use crate::ExchangeError;
use crate::surface::{Progress, Steps, banded, check_whole};

/// Number of lines of a block.
const BLOCK: usize = 16;
/// Chromaticities of sRGB: red, green, blue, white (IEC 61966-2-1).
const SRGB: [Vec2<f32>; 4] = [
    Vec2(0.64, 0.33),
    Vec2(0.3, 0.6),
    Vec2(0.15, 0.06),
    Vec2(0.3127, 0.329),
];
/// m in an inch.
const INCH_M: f64 = 0.0254;
const COMMENTS: &str = "R, G, B: linear colour before light, without the surface's own reflection. \
    height: metres above the highest peaks of the bare ground. \
    gloss: 0 (matt) to 1. \
    wet.*, dry.*: thickness of each paint in metres.";

/// Writes a surface as an OpenEXR file, from the start of `to`; the final position is not its end.
///
/// # Errors
/// [`ExchangeError`].
pub fn write_open_exr(
    painting: &mut Painting,
    surface: u32,
    to: impl Write + Seek,
    progress: Progress<'_>,
) -> Result<(), ExchangeError> {
    let channels = channels(&painting.scene().paints);
    let banded = banded(painting, surface)?;
    let [width, height] = banded.cells();
    let header = header([width, height], banded.cell_m(), &channels);
    let rows = Rows::new(&banded, &channels);
    // As many lines as a tile has: neighbouring jobs have few bands in common.
    let jobs = height.div_ceil(TILE);
    let mut steps = Steps::new(progress, jobs);
    let to = BufWriter::new(to);
    let headers = std::iter::once(header).collect();
    exr::block::write(to, headers, true, |meta, file| {
        let block = |top: usize| -> exr::error::Result<(usize, Chunk)> {
            let lines = BLOCK.min(height - top);
            let block = UncompressedBlock {
                index: BlockIndex {
                    layer: 0,
                    pixel_position: Vec2(0, top),
                    pixel_size: Vec2(width, lines),
                    level: Vec2(0, 0),
                },
                data: rows.bytes(top..top + lines),
            };
            Ok((top / BLOCK, block.compress_to_chunk(&meta.headers)?))
        };
        let job = |number: usize| -> exr::error::Result<Vec<(usize, Chunk)>> {
            let top = number * TILE;
            (top..height.min(top + TILE))
                .step_by(BLOCK)
                .map(block)
                .collect()
        };
        in_order(jobs, job, |_, blocks| {
            for (index, chunk) in blocks? {
                file.write_chunk(index, chunk)?;
            }
            steps.step();
            Ok(())
        })
    })?;
    check_whole(painting)
}

fn header(size: [usize; 2], cell_m: f64, channels: &[(String, Source)]) -> Header {
    let text = |text: &str| Text::from_slice_unchecked(text.as_bytes());
    let list = channels.iter().map(|(name, source)| {
        // Channels whose ratios a lossy packer should preserve.
        let linear = !matches!(source, Source::Colour(_));
        ChannelDescription::new(text(name), SampleType::F32, linear)
    });
    let mut header = Header::new(text(""), (size[0], size[1]), list.collect()).with_encoding(
        Compression::ZIP16,
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    );
    let [red, green, blue, white] = SRGB;
    header.shared_attributes.chromaticities = Some(Chromaticities {
        red,
        green,
        blue,
        white,
    });
    header.own_attributes = LayerAttributes {
        horizontal_density: Some((INCH_M / cell_m) as f32),
        comments: Some(text(COMMENTS)),
        software_name: Some(text("Maulstick")),
        ..LayerAttributes::default()
    };
    header
}
