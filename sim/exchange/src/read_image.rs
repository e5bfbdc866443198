//! Pictures from files: PNG, JPEG and TIFF, of 8 or 16 bits, grey or RGB, with or without alpha.
//!
//! A picture stays in memory as its file has it, at most 8 bytes a pixel (16 for one of floats), and
//! its rows are converted one at a time. Colours go through the profile that the file brings, which
//! must be one of grey or RGB; any other is taken for sRGB. Transparent pixels lie over white.

use std::fmt;
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Seek};
use std::path::Path;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder as _, ImageError, ImageReader, Limits};
use maulstick_optics::colour::srgb_decode;
use maulstick_optics::icc::Incoming;

use crate::import_error::{ImportError, MOST_SIDE};

/// Most bytes that a decoder may take.
const MOST_BYTES: u64 = 7 << 30;

/// A picture in memory.
pub struct Image {
    pixels: DynamicImage,
    profile: Option<Incoming>,
    /// Linear light of encoded sRGB, 0 to 65535.
    linear: Vec<f32>,
}

/// A row as the file has it: samples from 0 to 65535, or floats.
enum Samples {
    Whole(Vec<u16>),
    Floats(Vec<f32>),
}

impl Image {
    /// Reads a file; what is in it is seen by its first bytes, not by its name.
    ///
    /// # Errors
    /// [`ImportError`] where it is no picture, or one larger than [`MOST_SIDE`].
    pub fn open(path: &Path) -> Result<Self, ImportError> {
        Self::decode(BufReader::new(File::open(path).map_err(ImportError::File)?))
    }

    /// The same for which a decoder takes at most so many bytes.
    ///
    /// # Errors
    /// As [`open`](Self::open), and where it would take more.
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

    fn decode_within(source: impl BufRead + Seek, bytes: u64) -> Result<Self, ImportError> {
        let reader = ImageReader::new(source).with_guessed_format();
        let mut reader = reader.map_err(ImportError::File)?;
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(bytes);
        reader.limits(limits);
        let mut decoder = reader.into_decoder().map_err(wrong)?;
        let (width, height) = decoder.dimensions();
        if width.max(height) > MOST_SIDE {
            return Err(ImportError::TooLarge(width, height));
        }
        if decoder.total_bytes() > bytes {
            return Err(ImportError::Memory(width, height));
        }
        if width.min(height) == 0 {
            return Err(ImportError::NotAPicture("it has no pixels".to_owned()));
        }
        // A profile that cannot be used, as that of a CMYK picture, and a missing one are alike.
        let icc = decoder.icc_profile().unwrap_or_default();
        let profile = icc.and_then(|icc| Incoming::read(&icc).ok());
        let turned = decoder.orientation().unwrap_or(Orientation::NoTransforms);
        let mut pixels = DynamicImage::from_decoder(decoder).map_err(wrong)?;
        pixels.apply_orientation(turned);
        let linear = (0..=65_535u32).map(|v| srgb_decode(f64::from(v) / 65_535.0) as f32);
        Ok(Self {
            pixels,
            profile,
            linear: linear.collect(),
        })
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

    /// Linear sRGB of a row, 0 to 1; row 0 is the top. Floats are taken for linear light.
    pub fn colours(&self, row: usize, into: &mut Vec<[f32; 3]>) {
        let (channels, alpha) = self.channels();
        let pixel = channels + usize::from(alpha);
        let over_white = |colour: [f32; 3], share: f32| match alpha {
            true => colour.map(|channel| share * channel + (1.0 - share)),
            false => colour,
        };
        into.clear();
        match self.samples(row) {
            Samples::Floats(row) => into.extend(row.chunks_exact(pixel).map(|values| {
                let channel = |c: usize| values[c.min(channels - 1)].clamp(0.0, 1.0);
                let share = values[pixel - 1].clamp(0.0, 1.0);
                over_white([0, 1, 2].map(channel), share)
            })),
            Samples::Whole(row) => {
                let encoded = self.encoded(&row, channels, pixel);
                let pixels = encoded.chunks_exact(3).zip(row.chunks_exact(pixel));
                into.extend(pixels.map(|(encoded, values)| {
                    let colour = [0, 1, 2].map(|c| self.linear[usize::from(encoded[c])]);
                    over_white(colour, f32::from(values[pixel - 1]) / 65_535.0)
                }));
            }
        }
    }

    /// Encoded sRGB of a row, three samples a pixel.
    fn encoded(&self, row: &[u16], channels: usize, pixel: usize) -> Vec<u16> {
        let spread = || {
            let pixels = row.chunks_exact(pixel);
            pixels.flat_map(|values| [0, 1, 2].map(|c| values[c.min(channels - 1)]))
        };
        match &self.profile {
            Some(profile) if profile.channels() == 3 => {
                profile.to_srgb(&spread().collect::<Vec<_>>())
            }
            Some(profile) if channels == 1 => {
                let grey: Vec<u16> = row.iter().step_by(pixel).copied().collect();
                profile.to_srgb(&grey)
            }
            _ => spread().collect(),
        }
    }

    /// Heights of a row, 0 to 1: the encoded values of a grey picture, the luma (BT.709) of another.
    /// Transparent pixels are 1. Row 0 is the top.
    pub fn heights(&self, row: usize, into: &mut Vec<[f32; 1]>) {
        let (channels, alpha) = self.channels();
        let pixel = channels + usize::from(alpha);
        let values: Vec<f32> = match self.samples(row) {
            Samples::Floats(row) => row.iter().map(|v| v.clamp(0.0, 1.0)).collect(),
            Samples::Whole(row) => row.iter().map(|v| f32::from(*v) / 65_535.0).collect(),
        };
        into.clear();
        into.extend(values.chunks_exact(pixel).map(|values| {
            let height = match channels {
                1 => values[0],
                _ => 0.2126 * values[0] + 0.7152 * values[1] + 0.0722 * values[2],
            };
            let share = if alpha { values[pixel - 1] } else { 1.0 };
            [share * height + (1.0 - share)]
        }));
    }
}

fn wrong(error: ImageError) -> ImportError {
    match error {
        ImageError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            ImportError::File(error)
        }
        other => ImportError::NotAPicture(other.to_string()),
    }
}

impl fmt::Debug for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Image")
            .field("size", &self.size())
            .field("colour", &self.pixels.color())
            .field("profile", &self.profile)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use image::{ImageFormat, Rgb, RgbImage};
    use maulstick_optics::colour::RgbSpace;
    use maulstick_optics::icc::Profile;

    use super::*;

    fn read(pixels: impl Into<DynamicImage>, format: ImageFormat) -> Image {
        let mut bytes = Cursor::new(Vec::new());
        let pixels = pixels.into();
        pixels.write_to(&mut bytes, format).expect("written");
        Image::read(&bytes.into_inner()).expect("a picture")
    }

    fn first(image: &Image, row: usize) -> ([f32; 3], f32) {
        let (mut colours, mut heights) = (Vec::new(), Vec::new());
        image.colours(row, &mut colours);
        image.heights(row, &mut heights);
        assert_eq!(
            (colours.len(), heights.len()),
            (image.size()[0], image.size()[0])
        );
        (colours[0], heights[0][0])
    }

    fn near(got: [f32; 3], want: [f32; 3], by: f32) -> bool {
        got.iter().zip(want).all(|(a, b)| (a - b).abs() < by)
    }

    #[test]
    fn every_kind_of_pixel_is_read() {
        // Linear light of 128/255 and of half of 65535.
        let (byte, word) = (0.215_861, 0.214_041);
        let grey8 = image::GrayImage::from_pixel(2, 1, image::Luma([128]));
        let grey16 = image::ImageBuffer::from_pixel(2, 1, image::Luma([32_768u16]));
        let rgb16 = image::ImageBuffer::from_pixel(2, 1, Rgb([32_768u16, 0, 65_535]));
        let half = image::RgbaImage::from_pixel(2, 1, image::Rgba([255, 0, 0, 51]));
        let grey_alpha = image::GrayAlphaImage::from_pixel(2, 1, image::LumaA([0, 0]));
        for format in [ImageFormat::Png, ImageFormat::Tiff] {
            let (colour, height) = first(&read(grey8.clone(), format), 0);
            assert!(near(colour, [byte; 3], 1e-5), "{colour:?}");
            assert!(!near(colour, [word; 3], 1e-5), "a fault would pass");
            assert!((height - 128.0 / 255.0).abs() < 1e-5);
            let (colour, height) = first(&read(grey16.clone(), format), 0);
            assert!(near(colour, [word; 3], 1e-5), "{colour:?}");
            assert!((height - 0.5).abs() < 1e-4);
            let (colour, height) = first(&read(rgb16.clone(), format), 0);
            assert!(near(colour, [word, 0.0, 1.0], 1e-5), "{colour:?}");
            assert!((height - 0.1785).abs() < 1e-4, "{height}");
            let (colour, _) = first(&read(half.clone(), format), 0);
            assert!(near(colour, [1.0, 0.8, 0.8], 1e-5), "{colour:?}");
        }
        let clear = first(&read(grey_alpha, ImageFormat::Png), 0);
        assert_eq!(clear, ([1.0; 3], 1.0));
        let jpeg = first(
            &read(RgbImage::from_pixel(9, 9, Rgb([128; 3])), ImageFormat::Jpeg),
            4,
        );
        assert!(near(jpeg.0, [byte; 3], 0.01), "{jpeg:?}");
    }

    #[test]
    fn a_profile_is_obeyed() {
        let with = |space: RgbSpace| {
            let mut bytes = Vec::new();
            let mut info = png::Info::with_size(1, 1);
            info.color_type = png::ColorType::Rgb;
            info.bit_depth = png::BitDepth::Eight;
            info.icc_profile = Some(Profile::of(space).icc().to_vec().into());
            let encoder = png::Encoder::with_info(&mut bytes, info).expect("an encoder");
            let mut writer = encoder.write_header().expect("a header");
            writer.write_image_data(&[117, 251, 76]).expect("a pixel");
            drop(writer);
            first(&Image::read(&bytes).expect("a picture"), 0).0
        };
        // Display P3's (117, 251, 76) is sRGB's green.
        let (wide, own) = (with(RgbSpace::DisplayP3), with(RgbSpace::Srgb));
        println!("{wide:?} {own:?}");
        assert!(near(wide, [0.0, 1.0, 0.0], 0.02), "{wide:?}");
        assert!(!near(own, [0.0, 1.0, 0.0], 0.02), "a fault would pass");
    }

    #[test]
    fn the_top_row_is_the_first_and_slim_pictures_are_read() {
        let mut two = RgbImage::new(1, 2);
        two.put_pixel(0, 0, Rgb([255, 0, 0]));
        let image = read(two, ImageFormat::Png);
        assert_eq!(first(&image, 0).0, [1.0, 0.0, 0.0]);
        assert_eq!(first(&image, 1).0, [0.0; 3]);
        let slim = read(image::GrayImage::new(20_000, 10), ImageFormat::Png);
        assert_eq!(slim.size(), [20_000, 10]);
        assert_eq!(
            read(image::GrayImage::new(1, 1), ImageFormat::Png).size(),
            [1, 1]
        );
    }

    #[test]
    fn what_is_no_picture_says_so() {
        let says = |bytes: &[u8], word: &str| {
            let error = Image::read(bytes).expect_err("no picture").to_string();
            println!("{error}");
            assert!(error.contains(word), "{error}");
        };
        says(b"", "PNG, JPEG or TIFF");
        says(b"not a picture at all", "PNG, JPEG or TIFF");
        says(b"GIF89a\x01\0\x01\0", "PNG, JPEG or TIFF");
        let mut whole = Cursor::new(Vec::new());
        let pixels = RgbImage::from_fn(50, 50, |x, y| Rgb([x as u8, y as u8, (x * y) as u8]));
        pixels
            .write_to(&mut whole, ImageFormat::Png)
            .expect("written");
        let whole = whole.into_inner();
        says(&whole[..whole.len() / 2], "PNG, JPEG or TIFF");
        let mut wide = Cursor::new(Vec::new());
        let pixels = image::GrayImage::new(20_001, 1);
        pixels
            .write_to(&mut wide, ImageFormat::Png)
            .expect("written");
        says(&wide.into_inner(), "20001×1 pixels is too large");
        let none = Image::open(Path::new("/nowhere/picture.png")).expect_err("none");
        assert!(matches!(none, ImportError::File(_)), "{none}");
    }
}
