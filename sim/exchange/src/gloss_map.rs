//! The gloss of a painting as a picture: light is glossy.

use std::io::Write;

use maulstick_appearance::Bakery;
use maulstick_appearance::bands::in_order;

use maulstick_appearance::picture::{Depth, Pixels, density, write_png};
use maulstick_optics::light::gloss::ROUGHNESS;
use maulstick_painting::Painting;

use crate::ExchangeError;
use crate::surface::{Progress, Steps, banded, check_whole};

/// Writes the gloss of a surface, 0 to 1, as a grey PNG of 16 bits; its `tEXt` gives the formula for GGX's roughness α.
/// `pHYs` has the size of a cell.
///
/// # Errors
/// [`ExchangeError`].
pub fn write_gloss_map(
    painting: &mut Painting,
    surface: u32,
    to: impl Write,
    progress: Progress<'_>,
) -> Result<(), ExchangeError> {
    let banded = banded(painting, surface)?;
    let width = banded.cells()[0];
    let mut steps = Steps::new(progress, banded.bands());
    let pixels = Pixels {
        size: banded.cells(),
        colour: png::ColorType::Grayscale,
        depth: Depth::Sixteen,
        icc: None,
        pixels_per_m: Some(density(banded.cell_m())),
    };
    let mut info = pixels.info();
    let [least, most] = ROUGHNESS;
    let text = format!(
        "65535 is 1; GGX's roughness alpha is {least} + {:.1} (1 - gloss)^2",
        most - least
    );
    info.uncompressed_latin1_text = vec![png::text_metadata::TEXtChunk::new("Gloss", text)];
    let job = |band: usize| {
        let mut gloss = vec![0.0; banded.rows(band).len() * width];
        for (id, tile) in banded.tiles(band) {
            let shown = banded.shown(id, tile, &mut Bakery::default());
            banded.spread(id, &shown.gloss, &mut gloss);
        }
        let values = gloss.chunks_exact(width).rev().flatten();
        let values = values.map(|gloss| (gloss.clamp(0.0, 1.0) * 65_535.0 + 0.5) as u16);
        values.flat_map(u16::to_be_bytes).collect::<Vec<u8>>()
    };
    write_png::<ExchangeError>(to, info, |file| {
        in_order(banded.bands(), job, |_, rows| {
            file.write_all(&rows)?;
            steps.step();
            Ok(())
        })
    })?;
    check_whole(painting)?;
    Ok(())
}
