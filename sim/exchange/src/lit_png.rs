//! The painting under its lamp, as a PNG.

use std::io::Write;

use maulstick_appearance::bands::in_order;
use maulstick_appearance::picture::{Depth, Export, Pixels, density, write_png};
use maulstick_painting::Painting;
use maulstick_painting::picture::lit_drawing;

use crate::ExchangeError;
use crate::surface::{Progress, Steps, check_whole};

/// Writes a surface under the scene's lamp, a pixel a cell, for the profile and gamut of
/// `export`: the profile is embedded, and `pHYs` has the size of a cell. With 8 bits a channel these are the bytes of
/// [`Picture::encode_png`](maulstick_appearance::picture::Picture::encode_png).
///
/// # Errors
/// [`ExchangeError`].
pub fn write_lit_png(
    painting: &mut Painting,
    surface: u32,
    (export, depth): (&Export, Depth),
    to: impl Write,
    progress: Progress<'_>,
) -> Result<(), ExchangeError> {
    let drawing =
        lit_drawing(painting, surface, export).ok_or(ExchangeError::NoSurface(surface))?;
    let banded = drawing.banded();
    let pixels = Pixels {
        size: banded.cells(),
        colour: png::ColorType::Rgb,
        depth,
        icc: Some(drawing.icc()),
        pixels_per_m: Some(density(banded.cell_m())),
    };
    let mut steps = Steps::new(progress, banded.bands());
    let job = |band: usize| drawing.band(band, depth);
    write_png::<ExchangeError>(to, pixels.info(), |file| {
        in_order(banded.bands(), job, |_, rows| {
            file.write_all(&rows)?;
            steps.step();
            Ok(())
        })
    })?;
    check_whole(painting)
}
