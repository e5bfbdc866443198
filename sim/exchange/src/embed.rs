//! Conversion of pictures for a painting's grounds and teeth.

use std::sync::Arc;

use maulstick_canvas::assets::MOST_PIXELS;

use crate::fit_to::{colours, heights};
use crate::import_error::ImportError;
use crate::read_image::Image;

/// A picture as a ground of a surface of `cells`, 8-bit RGB PNG: a pixel a cell, coarser on very large surfaces.
///
/// # Errors
/// [`ImportError`].
pub fn ground(image: &Image, cells: [u32; 2]) -> Result<Arc<[u8]>, ImportError> {
    let all = u64::from(cells[0]) * u64::from(cells[1]);
    let mut coarse = 1u32;
    while all / (u64::from(coarse) * u64::from(coarse)) > MOST_PIXELS / 2 {
        coarse *= 2;
    }
    let size = cells.map(|cells| cells.div_ceil(coarse) as usize);
    let raster = colours(image, size)?;
    let rows = raster.rgb.rchunks_exact(size[0]);
    let raw: Vec<u8> = rows.flatten().flatten().copied().collect();
    png_of(size, png::ColorType::Rgb, png::BitDepth::Eight, &raw)
}

/// A picture as a tooth that is `width_mm` wide on cells of `cell_m`, 16-bit grey PNG: as fine as the picture, but no
/// finer than the cells, and coarser for very many pixels.
///
/// # Errors
/// [`ImportError`].
pub fn tooth(image: &Image, width_mm: f64, cell_m: f64) -> Result<Arc<[u8]>, ImportError> {
    let pixels = image.size();
    let cells = (width_mm * 1e-3 / cell_m).round().max(1.0) as usize;
    let mut across = pixels[0].min(cells);
    let down = |across: usize| {
        let down = pixels[1] as f64 * across as f64 / pixels[0] as f64;
        (down.round() as usize).max(1)
    };
    while across > 1 && across as u64 * down(across) as u64 > MOST_PIXELS {
        across /= 2;
    }
    let size = [across, down(across)];
    let raw: Vec<u8> = heights(image, size)?
        .iter()
        .flat_map(|height| height.to_be_bytes())
        .collect();
    png_of(
        size,
        png::ColorType::Grayscale,
        png::BitDepth::Sixteen,
        &raw,
    )
}

fn png_of(
    [width, height]: [usize; 2],
    colour: png::ColorType,
    depth: png::BitDepth,
    raw: &[u8],
) -> Result<Arc<[u8]>, ImportError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().map_err(ImportError::Png)?;
    writer.write_image_data(raw).map_err(ImportError::Png)?;
    writer.finish().map_err(ImportError::Png)?;
    Ok(bytes.into())
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::{DynamicImage, ImageFormat, Rgb, RgbImage};
    use maulstick_canvas::assets::Assets;

    use super::*;

    fn read(pixels: impl Into<DynamicImage>) -> Image {
        let mut bytes = Cursor::new(Vec::new());
        let pixels = pixels.into();
        pixels
            .write_to(&mut bytes, ImageFormat::Png)
            .expect("written");
        Image::read(&bytes.into_inner()).expect("a picture")
    }

    #[test]
    fn a_painting_takes_what_is_made_for_it() {
        let image = read(RgbImage::from_fn(6, 4, |x, y| {
            Rgb([40 * x as u8, 60 * y as u8, 77])
        }));
        let mut embedded = Assets::default();
        let ground = ground(&image, [6, 4]).expect("a ground");
        let hash = embedded.add(ground).expect("taken");
        let colours = embedded.colours(&hash).expect("colours");
        assert_eq!((colours.width, colours.height), (6, 4));
        assert_eq!(colours.values[0], [0, 180, 77], "the lowest row is first");
        assert_eq!(colours.values[23], [200, 0, 77]);
        let tooth = tooth(&image, 1.0, 2.5e-4).expect("a tooth");
        let hash = embedded.add(tooth).expect("taken");
        let heights = embedded.heights(&hash).expect("heights");
        assert_eq!(
            (heights.width, heights.height),
            (4, 3),
            "no finer than cells"
        );
        assert!(heights.values[3] > heights.values[0]);
    }
}
