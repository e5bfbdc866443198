//! A painting in layers, as an OpenRaster file (openraster.org, baseline 0.0.5).
//!
//! From the bottom: the ground; each dry layer; the wet paint. A layer is the flat colour of the painting up to it,
//! opaque where it has any paint and clear elsewhere. So all layers together are the painting without light on its
//! relief, and those up to any of them are its state before the next: colours of glazes are in the glazes, not in the
//! blending of layers.

mod images;

use std::fmt::Write as _;
use std::io::{Seek, Write};

use maulstick_appearance::bands::in_order;
use maulstick_appearance::picture::{Depth, Drawing, Export, Pixels, density, write_png};
use maulstick_painting::Painting;
use maulstick_painting::picture::flat_drawing;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, System, ZipWriter};

use self::images::{Image, Shows, draw, images};
use crate::ExchangeError;
use crate::surface::{Progress, Steps, check_whole};
use crate::thumbnail::{SIDE, Thumbnail};

/// Pixels of the pictures that are drawn at once: packed they wait in memory, while drawn alone each
/// would bake all layers under it again.
const AT_ONCE: usize = 1 << 28;
/// Bytes of image data in one chunk of a PNG.
const CHUNK: usize = 1 << 18;
/// m in an inch.
const INCH_M: f64 = 0.0254;

/// Writes a surface as an OpenRaster file in sRGB, 8 bits a channel, a pixel a cell, with the whole
/// picture and a thumbnail of at most 256 pixels. Dry layers without paint on the surface are left
/// out, and so is wet paint where there is none.
///
/// # Errors
/// [`ExchangeError`].
pub fn write_open_raster(
    painting: &mut Painting,
    surface: u32,
    to: impl Write + Seek,
    progress: Progress<'_>,
) -> Result<(), ExchangeError> {
    let export = Export::default();
    let layers = painting.scene().layers.clone();
    let drawing =
        flat_drawing(painting, surface, &export).ok_or(ExchangeError::NoSurface(surface))?;
    let banded = drawing.banded();
    let size = banded.cells();
    let images = images(banded, &layers);
    let at_once = (AT_ONCE / (size[0] * size[1])).clamp(1, images.len());
    let groups = images.chunks(at_once);
    let mut steps = Steps::new(progress, groups.len() * banded.bands());
    let mut file = ZipWriter::new(to);
    add(&mut file, "mimetype", b"image/openraster")?;
    add(
        &mut file,
        "stack.xml",
        stack(size, banded.cell_m(), &images).as_bytes(),
    )?;
    let mut thumbnail = Thumbnail::new(size, SIDE);
    for group in groups {
        let packed = pack(&drawing, group, &mut thumbnail, &mut steps)?;
        for (image, packed) in group.iter().zip(packed) {
            add(&mut file, &image.file, &packed)?;
        }
    }
    let small = Pixels {
        size: thumbnail.size(),
        pixels_per_m: None,
        ..pixels(&drawing, png::ColorType::Rgb)
    };
    let mut packed = Vec::new();
    write_png::<ExchangeError>(&mut packed, small.info(), |file| {
        Ok(file.write_all(&thumbnail.bytes())?)
    })?;
    add(&mut file, "Thumbnails/thumbnail.png", &packed)?;
    file.finish()?;
    check_whole(painting)
}

fn pixels<'a>(drawing: &Drawing<'a>, colour: png::ColorType) -> Pixels<'a> {
    Pixels {
        size: drawing.banded().cells(),
        colour,
        depth: Depth::Eight,
        icc: Some(drawing.icc()),
        pixels_per_m: Some(density(drawing.banded().cell_m())),
    }
}

/// The PNG files of some pictures, drawn together; the whole one goes into the thumbnail as well.
fn pack(
    drawing: &Drawing<'_>,
    images: &[Image],
    thumbnail: &mut Thumbnail,
    steps: &mut Steps<'_>,
) -> Result<Vec<Vec<u8>>, ExchangeError> {
    let mut files = vec![Vec::new(); images.len()];
    let open = images.iter().zip(&mut files).map(|(image, file)| {
        let info = pixels(drawing, image.colour()).info();
        png::Encoder::with_info(file, info)?.write_header()
    });
    let mut open = open.collect::<Result<Vec<_>, _>>()?;
    let rows = open
        .iter_mut()
        .map(|file| file.stream_writer_with_size(CHUNK));
    let mut rows = rows.collect::<Result<Vec<_>, _>>()?;
    let job = |band: usize| draw(drawing, images, band);
    in_order(drawing.banded().bands(), job, |_, bands| {
        for ((image, rows), band) in images.iter().zip(&mut rows).zip(&bands) {
            rows.write_all(band)?;
            if image.shows == Shows::Merged {
                thumbnail.add(band);
            }
        }
        steps.step();
        Ok::<(), ExchangeError>(())
    })?;
    for rows in rows {
        rows.finish()?;
    }
    for file in open {
        file.finish()?;
    }
    Ok(files)
}

/// Adds a file uncompressed, because pictures are packed already, with the format's date.
fn add<W: Write + Seek>(
    file: &mut ZipWriter<W>,
    name: &str,
    bytes: &[u8],
) -> Result<(), ExchangeError> {
    let options = SimpleFileOptions::DEFAULT
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::DEFAULT)
        .unix_permissions(0o644)
        .system(System::Unix)
        .large_file(u32::try_from(bytes.len()).is_err());
    file.start_file(name, options)?;
    file.write_all(bytes)?;
    Ok(())
}

/// The stack of layers, from the top.
fn stack([width, height]: [usize; 2], cell_m: f64, images: &[Image]) -> String {
    let density = (INCH_M / cell_m).round();
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    // Writing to a string cannot fail.
    writeln!(
        xml,
        "<image version=\"0.0.5\" w=\"{width}\" h=\"{height}\" xres=\"{density}\" yres=\"{density}\">"
    )
    .ok();
    xml.push_str("  <stack>\n");
    for image in images.iter().rev() {
        if let Some(name) = &image.layer {
            writeln!(
                xml,
                "    <layer name=\"{}\" src=\"{}\" x=\"0\" y=\"0\" opacity=\"1.0\" \
                 visibility=\"visible\" composite-op=\"svg:src-over\"/>",
                escaped(name),
                image.file
            )
            .ok();
        }
    }
    xml.push_str("  </stack>\n</image>\n");
    xml
}

/// A text within the quotes of XML 1.0, which has no control characters.
fn escaped(text: &str) -> String {
    let mut xml = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => xml.push_str("&amp;"),
            '<' => xml.push_str("&lt;"),
            '>' => xml.push_str("&gt;"),
            '"' => xml.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => xml.push(' '),
            c if c.is_control() => xml.push(' '),
            c => xml.push(c),
        }
    }
    xml
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_name_is_xml() {
        let name = "a < b & \"c\"\u{7}\u{ffff} Ölgrund";
        assert_eq!(escaped(name), "a &lt; b &amp; &quot;c&quot;   Ölgrund");
    }
}
