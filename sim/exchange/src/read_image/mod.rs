//! Pictures from files: PNG, JPEG, TIFF, OpenEXR, Radiance and OpenRaster.
//!
//! A picture stays in memory in the form of its file, at most 8 bytes a pixel (16 for one of floats), and its rows are
//! converted one at a time. Its colours follow the file's profile of grey or of RGB, the marks of PNG, or
//! chromaticities; without any they are sRGB. Transparent pixels lie over white. A picture with a NaN pixel is
//! rejected.
//!
//! | module | holds |
//! | --- | --- |
//! | [`kind`] | which pictures are read |
//! | `png_file`, `jpeg_file`, `tiff_file`, `exr_file`, `hdr_file`, `ora_file` | one kind each |
//! | `pixels` | what a file holds; checks of size and numbers |
//! | `colours` | from numbers to light |

mod colours;
mod exr_file;
mod hdr_file;
mod jpeg_file;
pub mod kind;
mod ora_file;
mod pixels;
mod png_file;
mod tiff_file;

use std::fmt;
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read as _, Seek, SeekFrom};
use std::path::Path;

use image::DynamicImage;

use self::colours::Colours;
pub use self::colours::UnusedMark;
pub use self::kind::PictureKind;
use self::pixels::{Alpha, Picture, check_numbers};
use crate::import_error::ImportError;
#[cfg(doc)]
use crate::import_error::MOST_SIDE;

/// Most bytes that a decoder may take.
const MOST_BYTES: u64 = 7 << 30;

/// A picture in memory.
pub struct Image {
    pixels: DynamicImage,
    alpha: Alpha,
    colours: Colours,
    unused: Option<UnusedMark>,
}

/// A row as the file has it: samples from 0 to 65535, or floats.
enum Samples {
    Whole(Vec<u16>),
    Floats(Vec<f32>),
}

impl Samples {
    /// Samples of 0 to 65535; floats are cut off at 0 and 1.
    fn into_whole(self) -> Vec<u16> {
        let whole = |value: &f32| (value.clamp(0.0, 1.0) * 65_535.0 + 0.5) as u16;
        match self {
            Self::Whole(row) => row,
            Self::Floats(row) => row.iter().map(whole).collect(),
        }
    }
}

impl Image {
    /// Reads a file; its kind is determined by its first bytes, not by its name.
    ///
    /// # Errors
    /// [`ImportError`] where it is no picture, or one larger than [`MOST_SIDE`].
    pub fn open(path: &Path) -> Result<Self, ImportError> {
        Self::decode(BufReader::new(File::open(path).map_err(ImportError::File)?))
    }

    /// [`open`](Self::open) with a limit on the decoder's memory, bytes.
    ///
    /// # Errors
    /// As [`open`](Self::open), and where it would exceed the limit.
    pub fn open_within(path: &Path, bytes: u64) -> Result<Self, ImportError> {
        let file = BufReader::new(File::open(path).map_err(ImportError::File)?);
        Self::decode_within(file, bytes)
    }

    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn read(bytes: &[u8]) -> Result<Self, ImportError> {
        Self::decode(Cursor::new(bytes))
    }

    fn decode(source: impl BufRead + Seek) -> Result<Self, ImportError> {
        Self::decode_within(source, MOST_BYTES)
    }

    fn decode_within(
        mut source: impl BufRead + Seek,
        most_bytes: u64,
    ) -> Result<Self, ImportError> {
        let mut head = Vec::new();
        source
            .by_ref()
            .take(kind::HEAD as u64)
            .read_to_end(&mut head)
            .map_err(ImportError::File)?;
        source.seek(SeekFrom::Start(0)).map_err(ImportError::File)?;
        let Some(kind) = PictureKind::of(&head) else {
            let what = "it begins as none of these does".to_owned();
            return Err(ImportError::NotAPicture(what));
        };
        let Picture {
            mut pixels,
            alpha,
            colours,
            unused,
            turned,
        } = match kind {
            PictureKind::Png => png_file::read(source, most_bytes),
            PictureKind::Jpeg => jpeg_file::read(source, most_bytes),
            PictureKind::Tiff => tiff_file::read(source, most_bytes),
            PictureKind::Exr => exr_file::read(source, most_bytes),
            PictureKind::Hdr => hdr_file::read(source, most_bytes),
            PictureKind::Ora => ora_file::read(source, most_bytes),
        }?;
        pixels.apply_orientation(turned);
        check_numbers(&pixels)?;
        Ok(Self {
            pixels,
            alpha,
            colours,
            unused,
        })
    }

    /// The mark of its colours that was passed over, if one was.
    #[must_use]
    pub fn unused_mark(&self) -> Option<&UnusedMark> {
        self.unused.as_ref()
    }

    /// Pixels across and down.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.pixels.width() as usize, self.pixels.height() as usize]
    }

    /// Colour channels, and whether alpha follows them.
    fn channels(&self) -> (usize, bool) {
        let colour = self.pixels.color();
        let alpha = colour.has_alpha();
        (
            usize::from(colour.channel_count()) - usize::from(alpha),
            alpha,
        )
    }

    fn samples(&self, row: usize) -> Samples {
        let (colours, alpha) = self.channels();
        let length = (colours + usize::from(alpha)) * self.size()[0];
        let from = row * length;
        fn part<T>(raw: &[T], from: usize, length: usize) -> &[T] {
            raw.get(from..from + length).unwrap_or_default()
        }
        let bytes = |raw: &[u8]| {
            let row = part(raw, from, length).iter();
            Samples::Whole(row.map(|byte| u16::from(*byte) * 257).collect())
        };
        let words = |raw: &[u16]| Samples::Whole(part(raw, from, length).to_vec());
        let floats = |raw: &[f32]| Samples::Floats(part(raw, from, length).to_vec());
        match &self.pixels {
            DynamicImage::ImageLuma8(pixels) => bytes(pixels),
            DynamicImage::ImageLumaA8(pixels) => bytes(pixels),
            DynamicImage::ImageRgb8(pixels) => bytes(pixels),
            DynamicImage::ImageRgba8(pixels) => bytes(pixels),
            DynamicImage::ImageLuma16(pixels) => words(pixels),
            DynamicImage::ImageLumaA16(pixels) => words(pixels),
            DynamicImage::ImageRgb16(pixels) => words(pixels),
            DynamicImage::ImageRgba16(pixels) => words(pixels),
            DynamicImage::ImageRgb32F(pixels) => floats(pixels),
            DynamicImage::ImageRgba32F(pixels) => floats(pixels),
            _ => Samples::Whole(vec![u16::MAX; length]),
        }
    }

    /// Linear sRGB of a row, 0 to 1; row 0 is the top.
    pub fn colours(&self, row: usize, into: &mut Vec<[f32; 3]>) {
        let (samples, shares) = self.opaque(row);
        let pixels = self.light(samples, self.channels().0).into_iter();
        let over_white = |(colour, share): ([f32; 3], f32)| {
            colour.map(|channel| share * channel.clamp(0.0, 1.0) + (1.0 - share))
        };
        into.clear();
        into.extend(pixels.zip(shares).map(over_white));
    }

    /// Linear sRGB of a row, 0 or more, transparent pixels over black; row 0 is the top.
    pub fn radiance(&self, row: usize, into: &mut Vec<[f32; 3]>) {
        let (samples, shares) = self.opaque(row);
        let pixels = self.light(samples, self.channels().0).into_iter();
        let pixels = pixels.zip(shares);
        into.clear();
        into.extend(pixels.map(|(colour, share)| colour.map(|v| share * v.max(0.0))));
    }

    /// The first pixel whose floats are negative or infinite, across and down.
    #[must_use]
    pub fn first_without_radiance(&self) -> Option<[usize; 2]> {
        let (channels, has_alpha) = self.channels();
        let pixel = channels + usize::from(has_alpha);
        (0..self.size()[1]).find_map(|row| {
            let Samples::Floats(values) = self.samples(row) else {
                return None;
            };
            let is_wrong = |value: &f32| !(0.0..f32::INFINITY).contains(value);
            let place = values.iter().position(is_wrong)?;
            Some([place / pixel, row])
        })
    }

    /// Linear sRGB of opaque pixels, not within 0 to 1 where they are of another gamut or brighter than white.
    fn light(&self, samples: Samples, channels: usize) -> Vec<[f32; 3]> {
        match samples {
            Samples::Floats(row) if self.colours.takes_floats() => {
                self.colours.of_light(&row, channels)
            }
            other => self.colours.of_whole(&other.into_whole(), channels),
        }
    }

    /// The samples of a row without opacity, and the opacity of its pixels.
    fn opaque(&self, row: usize) -> (Samples, impl Iterator<Item = f32>) {
        let (channels, has_alpha) = self.channels();
        let samples = self.samples(row);
        let (samples, shares) = if has_alpha {
            self.parted(samples, channels)
        } else {
            (samples, Vec::new())
        };
        (samples, shares.into_iter().chain(std::iter::repeat(1.0)))
    }

    /// A row without its opacity, of which its colours are independent now, and the opacity.
    fn parted(&self, samples: Samples, channels: usize) -> (Samples, Vec<f32>) {
        let (pixel, is_straight) = (channels + 1, self.alpha == Alpha::Straight);
        match samples {
            Samples::Floats(row) => {
                let share = |values: &[f32]| values[channels].clamp(0.0, 1.0);
                let straight = |values: &[f32], c: usize| match share(values) {
                    share if is_straight || share == 0.0 => values[c],
                    share => values[c] / share,
                };
                let pixels = row.chunks_exact(pixel);
                let colours = pixels
                    .clone()
                    .flat_map(|values| (0..channels).map(move |c| straight(values, c)));
                (
                    Samples::Floats(colours.collect()),
                    pixels.map(share).collect(),
                )
            }
            Samples::Whole(row) => {
                let straight = |values: &[u16], c: usize| match u32::from(values[channels]) {
                    share if is_straight || share == 0 => values[c],
                    share => {
                        let straight = (u32::from(values[c]) * 65_535 + share / 2) / share;
                        u16::try_from(straight).unwrap_or(u16::MAX)
                    }
                };
                let pixels = row.chunks_exact(pixel);
                let colours = pixels
                    .clone()
                    .flat_map(|values| (0..channels).map(move |c| straight(values, c)));
                let share = |values: &[u16]| f32::from(values[channels]) / 65_535.0;
                (
                    Samples::Whole(colours.collect()),
                    pixels.map(share).collect(),
                )
            }
        }
    }

    /// Heights of a row, 0 to 1: the encoded values of a grey picture, the luma (BT.709) of another.
    /// Transparent pixels are 1. Row 0 is the top.
    pub fn heights(&self, row: usize, into: &mut Vec<[f32; 1]>) {
        let (samples, shares) = self.opaque(row);
        let channels = self.channels().0;
        let values: Vec<f32> = match samples {
            Samples::Floats(row) => row.iter().map(|v| v.clamp(0.0, 1.0)).collect(),
            Samples::Whole(row) => row.iter().map(|v| f32::from(*v) / 65_535.0).collect(),
        };
        into.clear();
        into.extend(
            values
                .chunks_exact(channels)
                .zip(shares)
                .map(|(values, share)| {
                    let height = match channels {
                        1 => values[0],
                        _ => 0.2126 * values[0] + 0.7152 * values[1] + 0.0722 * values[2],
                    };
                    [share * height + (1.0 - share)]
                }),
        );
    }
}

impl fmt::Debug for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Image")
            .field("size", &self.size())
            .field("kind", &self.pixels.color())
            .field("colours", &self.colours)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests;
