//! TIFF and BigTIFF: grey, palette, RGB, CMYK and YCbCr, of integers of 1 to 32 bits or of floats; colours by
//! the profile, else by chromaticities. Floats are light.

mod palette;

use std::io::{BufRead, ErrorKind, Seek};

use image::metadata::Orientation;
use maulstick_optics::colour::{Chromaticities, Transfer};
use tiff::decoder::ifd::Value;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::{PhotometricInterpretation as Photometric, Tag, Type, ValueBuffer};
use tiff::{ColorType, TiffError, TiffFormatError};

use super::colours::{Colours, MOST_PROFILE, Range, UnusedMark};
use super::pixels::{Alpha, Numbers, Picture, check_size};
use crate::import_error::ImportError;

const TRANSFER_FUNCTION: Tag = Tag::Unknown(301);
const WHITE_POINT: Tag = Tag::Unknown(318);
const PRIMARIES: Tag = Tag::Unknown(319);
const LUMA_SHARES: Tag = Tag::Unknown(529);
/// Luma shares of red, green and blue where a file gives none (TIFF 6.0, § 21: BT.601).
const BT601: [f64; 3] = [0.299, 0.587, 0.114];
/// Values of the tag ExtraSamples: opacity with and without premultiplied colours.
const ASSOCIATED: u16 = 1;
const UNASSOCIATED: u16 = 2;

/// Numbers as the decoder gives them, and how many a pixel has.
pub(super) struct Samples {
    pub(super) numbers: Numbers,
    pub(super) channels: usize,
}

pub(super) fn read(
    mut source: impl BufRead + Seek,
    most_bytes: u64,
) -> Result<Picture, ImportError> {
    let mut decoder = open(&mut source, most_bytes)?;
    let (width, height) = decoder.dimensions().map_err(|error| wrong(error, [0; 2]))?;
    let size = [width, height];
    check_size(size, 1, most_bytes)?;
    let of_size = |error| wrong(error, size);
    let photometric: u16 = decoder
        .get_tag_unsigned(Tag::PhotometricInterpretation)
        .map_err(of_size)?;
    let turned = decoder.find_tag_unsigned::<u8>(Tag::Orientation);
    let turned = turned.ok().flatten().and_then(Orientation::from_exif);
    let extra = decoder.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples);
    let extra = extra.map_err(of_size)?.and_then(|all| all.first().copied());
    let is_palette = photometric == Photometric::RGBPalette.to_u16();
    let kind = if is_palette {
        ColorType::RGB(16)
    } else {
        decoder.colortype().map_err(of_size)?
    };
    let is_grey = matches!(kind, ColorType::Gray(_) | ColorType::Multiband { .. });
    let (colours, unused) = marked(&mut decoder, if is_grey { 1 } else { 3 });
    let Samples { numbers, channels } = if is_palette {
        palette::read(decoder, size, most_bytes)?
    } else {
        let samples = samples(&mut decoder, size, most_bytes)?;
        match kind {
            ColorType::Multiband { .. } => {
                let is_opacity = matches!(extra, Some(ASSOCIATED | UNASSOCIATED));
                first_of(samples, if is_opacity { 2 } else { 1 })
            }
            ColorType::CMYK(_) => of_inks(samples)?,
            ColorType::YCbCr(_) => of_luma(samples, luma_shares(&mut decoder))?,
            ColorType::Gray(bits) if bits < 8 => spread(samples, bits),
            ColorType::Gray(_) | ColorType::RGB(_) | ColorType::RGBA(_) => samples,
            other => {
                let what = format!("it has colours of the kind {other:?}");
                return Err(ImportError::Unsupported(what));
            }
        }
    };
    Ok(Picture {
        pixels: numbers.into_image(size, channels)?,
        alpha: match extra {
            Some(ASSOCIATED) => Alpha::Associated,
            _ => Alpha::Straight,
        },
        colours,
        unused,
        turned: turned.unwrap_or(Orientation::NoTransforms),
    })
}

pub(super) fn open<R: BufRead + Seek>(
    source: R,
    most_bytes: u64,
) -> Result<Decoder<R>, ImportError> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = usize::try_from(most_bytes).unwrap_or(usize::MAX);
    limits.intermediate_buffer_size = limits.decoding_buffer_size;
    let decoder = Decoder::new(source).map_err(|error| wrong(error, [0; 2]))?;
    Ok(decoder.with_limits(limits))
}

/// All samples, pixel after pixel.
pub(super) fn samples<R: BufRead + Seek>(
    decoder: &mut Decoder<R>,
    size: [u32; 2],
    most_bytes: u64,
) -> Result<Samples, ImportError> {
    let of_size = |error| wrong(error, size);
    let kind = decoder.colortype().map_err(of_size)?;
    let (bits, channels) = (kind.bit_depth(), usize::from(kind.num_samples()));
    check_size(size, channels * usize::from(bits).div_ceil(8), most_bytes)?;
    let mut found = DecodingResult::U8(Vec::new());
    let layout = decoder.read_image_to_buffer(&mut found).map_err(of_size)?;
    if found.as_buffer(0).byte_len() < layout.complete_len {
        return Err(ImportError::Memory(size[0], size[1]));
    }
    let numbers = match found {
        DecodingResult::U8(values) if bits < 8 => {
            if layout.planes > 1 {
                let what = format!("it has planes of {bits} bits");
                return Err(ImportError::Unsupported(what));
            }
            Numbers::Bytes(unpacked(&values, size[0] as usize * channels, bits))
        }
        DecodingResult::U8(values) => Numbers::Bytes(values),
        DecodingResult::U16(values) => Numbers::Words(values),
        DecodingResult::U32(values) => Numbers::Words(
            values
                .into_iter()
                .map(|value| (value >> 16) as u16)
                .collect(),
        ),
        DecodingResult::F16(values) => {
            Numbers::Floats(values.into_iter().map(|value| value.to_f32()).collect())
        }
        DecodingResult::F32(values) => Numbers::Floats(values),
        DecodingResult::F64(values) => {
            Numbers::Floats(values.into_iter().map(|value| value as f32).collect())
        }
        _ => {
            let what = format!("its numbers have {bits} bits, or a sign");
            return Err(ImportError::Unsupported(what));
        }
    };
    let numbers = match layout.planes {
        0 | 1 => numbers,
        planes => interleaved(numbers, planes),
    };
    Ok(Samples { numbers, channels })
}

/// Unpacked numbers of less than 8 bits, from rows of whole bytes.
fn unpacked(packed: &[u8], row: usize, bits: u8) -> Vec<u8> {
    let each = usize::from(bits);
    let rows = packed.chunks_exact((row * each).div_ceil(8).max(1));
    let most = (1u8 << bits) - 1;
    let number = |bytes: &[u8], i: usize| {
        let at = i * each;
        (bytes[at / 8] >> (8 - each - at % 8)) & most
    };
    // The decoder does not read 3, 5, 6 and 7 bits, so no number spans two bytes.
    rows.flat_map(|bytes| (0..row).map(move |i| number(bytes, i)))
        .collect()
}

/// Numbers of less than 8 bits as those of 8 bits.
fn spread(Samples { numbers, channels }: Samples, bits: u8) -> Samples {
    let scale = 255 / ((1u8 << bits) - 1);
    let numbers = match numbers {
        Numbers::Bytes(values) => {
            Numbers::Bytes(values.into_iter().map(|value| value * scale).collect())
        }
        other => other,
    };
    Samples { numbers, channels }
}

/// Numbers of a plane after the other as those of a pixel after the other.
fn interleaved(numbers: Numbers, planes: usize) -> Numbers {
    fn woven<T: Copy>(values: &[T], planes: usize) -> Vec<T> {
        let pixels = values.len() / planes;
        let pixel = |i: usize| (0..planes).map(move |plane| values[plane * pixels + i]);
        (0..pixels).flat_map(pixel).collect()
    }
    match numbers {
        Numbers::Bytes(values) => Numbers::Bytes(woven(&values, planes)),
        Numbers::Words(values) => Numbers::Words(woven(&values, planes)),
        Numbers::Floats(values) => Numbers::Floats(woven(&values, planes)),
    }
}

/// The first numbers of each pixel.
fn first_of(Samples { numbers, channels }: Samples, kept: usize) -> Samples {
    fn first<T: Copy>(values: &[T], channels: usize, kept: usize) -> Vec<T> {
        let pixels = values.chunks_exact(channels);
        pixels.flat_map(|pixel| &pixel[..kept]).copied().collect()
    }
    let kept = kept.min(channels);
    let numbers = match numbers {
        Numbers::Bytes(values) => Numbers::Bytes(first(&values, channels, kept)),
        Numbers::Words(values) => Numbers::Words(first(&values, channels, kept)),
        Numbers::Floats(values) => Numbers::Floats(first(&values, channels, kept)),
    };
    Samples {
        numbers,
        channels: kept,
    }
}

/// Inks as they would multiply on white paper; profiles of inks are not obeyed.
fn of_inks(Samples { numbers, channels }: Samples) -> Result<Samples, ImportError> {
    let through = |most: u32, ink: u32, black: u32| {
        let white = (most - ink.min(most)) * (most - black.min(most));
        (white + most / 2) / most
    };
    let numbers = match numbers {
        Numbers::Bytes(values) => {
            let pixels = values.chunks_exact(channels);
            let light = |ink: u8, black: u8| through(255, ink.into(), black.into()) as u8;
            let rgb = pixels.flat_map(|inks| [0, 1, 2].map(|i| light(inks[i], inks[3])));
            Numbers::Bytes(rgb.collect())
        }
        Numbers::Words(values) => {
            let pixels = values.chunks_exact(channels);
            let light = |ink: u16, black: u16| through(65_535, ink.into(), black.into()) as u16;
            let rgb = pixels.flat_map(|inks| [0, 1, 2].map(|i| light(inks[i], inks[3])));
            Numbers::Words(rgb.collect())
        }
        Numbers::Floats(_) => {
            let what = "it has inks in floats".to_owned();
            return Err(ImportError::Unsupported(what));
        }
    };
    Ok(Samples {
        numbers,
        channels: 3,
    })
}

/// The shares of red, green and blue in luma.
fn luma_shares<R: BufRead + Seek>(decoder: &mut Decoder<R>) -> [f64; 3] {
    let own = numbers_of(decoder, LUMA_SHARES).and_then(|all| <[f64; 3]>::try_from(all).ok());
    own.filter(|shares| shares.iter().all(|share| *share > 0.0))
        .unwrap_or(BT601)
}

/// RGB of luma and differences (TIFF 6.0, § 21), 8 bits each.
fn of_luma(
    Samples { numbers, channels }: Samples,
    [red, green, blue]: [f64; 3],
) -> Result<Samples, ImportError> {
    let Numbers::Bytes(values) = numbers else {
        let what = "it has luma of more than 8 bits".to_owned();
        return Err(ImportError::Unsupported(what));
    };
    let pixels = values.chunks_exact(channels);
    let rgb = pixels.flat_map(|pixel| {
        let [y, b, r] = [0, 1, 2].map(|i| f64::from(pixel[i]));
        let r = y + (2.0 - 2.0 * red) * (r - 128.0);
        let b = y + (2.0 - 2.0 * blue) * (b - 128.0);
        let g = (y - red * r - blue * b) / green;
        [r, g, b].map(|value| (value + 0.5) as u8)
    });
    Ok(Samples {
        numbers: Numbers::Bytes(rgb.collect()),
        channels: 3,
    })
}

/// The colours of a picture with this number of colour channels, and the mark with a higher precedence if that cannot
/// be used.
fn marked<R: BufRead + Seek>(
    decoder: &mut Decoder<R>,
    channels: usize,
) -> (Colours, Option<UnusedMark>) {
    let found = match profile(decoder) {
        Some(Ok(icc)) => Some(Colours::of_profile(&icc, channels)),
        Some(Err(unused)) => Some(Err(unused)),
        None => chromaticities(decoder),
    };
    match found {
        None => (Colours::srgb(), None),
        Some(Ok(colours)) => (colours, None),
        Some(Err(unused)) => (Colours::srgb(), Some(unused)),
    }
}

fn profile<R: BufRead + Seek>(decoder: &mut Decoder<R>) -> Option<Result<Vec<u8>, UnusedMark>> {
    let unused = |reason: String| UnusedMark {
        mark: "colour profile",
        reason,
    };
    let mut tags = decoder.image_ifd();
    let entry = tags.find_entry(Tag::IccProfile)?;
    if entry.count() > MOST_PROFILE as u64 {
        let most = MOST_PROFILE >> 20;
        return Some(Err(unused(format!("it has more than {most} MB"))));
    }
    let mut icc = ValueBuffer::empty(Type::UNDEFINED);
    Some(match tags.find_tag_buf(Tag::IccProfile, &mut icc) {
        Ok(_) => Ok(icc.as_bytes().to_vec()),
        Err(error) => Err(unused(error.to_string())),
    })
}

/// The fractions of a tag; `None` without it, and where one of them is none.
fn numbers_of<R: BufRead + Seek>(decoder: &mut Decoder<R>, tag: Tag) -> Option<Vec<f64>> {
    let number = |value: Value| match value {
        Value::Rational(above, below) => Some(f64::from(above) / f64::from(below)),
        Value::Float(value) => Some(value.into()),
        Value::Double(value) => Some(value),
        _ => None,
    };
    match decoder.find_tag(tag).ok()?? {
        Value::List(all) => all.into_iter().map(number).collect(),
        one => Some(vec![number(one)?]),
    }
}

/// Colours by the tags WhitePoint and PrimaryChromaticities, with the transfer function of sRGB.
fn chromaticities<R: BufRead + Seek>(
    decoder: &mut Decoder<R>,
) -> Option<Result<Colours, UnusedMark>> {
    let [white, primaries] = [WHITE_POINT, PRIMARIES].map(|tag| numbers_of(decoder, tag));
    if decoder.image_ifd().find_entry(TRANSFER_FUNCTION).is_some() {
        return Some(Err(UnusedMark {
            mark: "transfer function",
            reason: "of TIFF, profiles alone are obeyed".to_owned(),
        }));
    }
    if white.is_none() && primaries.is_none() {
        return None;
    }
    let mut own = Chromaticities::SRGB;
    if let Some([x, y]) = white.as_deref() {
        own.white = [*x, *y];
    }
    if let Some([rx, ry, gx, gy, bx, by]) = primaries.as_deref() {
        own.primaries = [[*rx, *ry], [*gx, *gy], [*bx, *by]];
    }
    let colours = Colours::encoded(Transfer::Srgb, &own, Range::FULL);
    Some(colours.ok_or_else(|| UnusedMark {
        mark: "chromaticities",
        reason: "they span no gamut".to_owned(),
    }))
}

pub(super) fn wrong(error: TiffError, [width, height]: [u32; 2]) -> ImportError {
    match error {
        TiffError::IoError(error) if error.kind() != ErrorKind::UnexpectedEof => {
            ImportError::File(error)
        }
        TiffError::LimitsExceeded => ImportError::Memory(width, height),
        TiffError::UnsupportedError(what) => ImportError::Unsupported(what.to_string()),
        TiffError::FormatError(TiffFormatError::InvalidDimensions(..)) => {
            ImportError::NotAPicture("it has no pixels".to_owned())
        }
        other => ImportError::NotAPicture(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_few_bits_come_out_of_rows_of_whole_bytes() {
        assert_eq!(
            unpacked(&[0b1010_0000, 0b0100_0000], 3, 1),
            [1, 0, 1, 0, 1, 0]
        );
        assert_eq!(unpacked(&[0b1101_0010], 4, 2), [3, 1, 0, 2]);
        assert_eq!(unpacked(&[0xab, 0xc0], 3, 4), [10, 11, 12]);
    }

    #[test]
    fn luma_and_inks_become_red_green_and_blue() {
        let of = |values: &[u8], channels: usize| Samples {
            numbers: Numbers::Bytes(values.to_vec()),
            channels,
        };
        // JFIF: pure red is 76, 85, 255.
        let rgb = of_luma(of(&[76, 85, 255, 128, 128, 128], 3), BT601).expect("read");
        let Numbers::Bytes(rgb) = rgb.numbers else {
            panic!("bytes");
        };
        let off = rgb.iter().zip([254u8, 0, 0, 128, 128, 128]);
        assert!(off.clone().all(|(a, b)| a.abs_diff(b) < 2), "{rgb:?}");
        let rgb = of_inks(of(&[0, 255, 0, 51, 0, 0, 0, 0], 4)).expect("read");
        let Numbers::Bytes(rgb) = rgb.numbers else {
            panic!("bytes");
        };
        assert_eq!(rgb, [204, 0, 204, 255, 255, 255]);
    }
}
