//! PNG: its pixels, and the mark of its colours by the precedence of its specification (PNG, third
//! edition, § 4.3): cICP, iCCP, sRGB, gAMA with cHRM.

use std::io::{self, BufRead, ErrorKind, Read, Seek, SeekFrom};

use image::DynamicImage;
use image::metadata::Orientation;
use maulstick_optics::colour::{Chromaticities, Transfer};
use png::{BitDepth, Decoder, DecodingError, Info, Limits, Transformations};

use super::colours::{Colours, MOST_PROFILE, Range, UnusedMark};
use super::pixels::{Alpha, Numbers, Picture, check_size};
use crate::import_error::ImportError;

/// Bytes of the signature.
const SIGNATURE: u64 = 8;
/// Value of gAMA and cHRM that stands for 1.
const SCALE: f64 = 100_000.0;

pub(super) fn read(
    mut source: impl BufRead + Seek,
    most_bytes: u64,
) -> Result<Picture, ImportError> {
    let marks = marks(&mut source).map_err(ImportError::File)?;
    source.rewind().map_err(ImportError::File)?;
    // The decoder counts the data that it unpacks beside the pixels, above all the profile.
    let limits = Limits {
        bytes: MOST_PROFILE,
    };
    let mut decoder = Decoder::new_with_limits(source, limits);
    decoder.set_ignore_text_chunk(true);
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info().map_err(wrong)?;
    let size = [header.width, header.height];
    check_size(size, 1, most_bytes)?;
    let mut reader = decoder.read_info().map_err(wrong)?;
    let (colour, depth) = reader.output_color_type();
    let channels = colour.samples();
    let count = size.map(|side| side as usize);
    let count = count[0] * count[1] * channels;
    let numbers = match depth {
        BitDepth::Sixteen => {
            check_size(size, 2 * channels, most_bytes)?;
            let mut words = vec![0u16; count];
            let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
            reader.next_frame(bytes).map_err(wrong)?;
            words
                .iter_mut()
                .for_each(|word| *word = u16::from_be(*word));
            Numbers::Words(words)
        }
        _ => {
            check_size(size, channels, most_bytes)?;
            let mut bytes = vec![0; count];
            reader.next_frame(&mut bytes).map_err(wrong)?;
            Numbers::Bytes(bytes)
        }
    };
    let pixels = numbers.into_image(size, channels)?;
    let info = reader.info();
    let (colours, unused) = marked(info, &marks, colour_channels(&pixels));
    let exif = info.exif_metadata.as_deref();
    Ok(Picture {
        pixels,
        alpha: Alpha::Straight,
        colours,
        unused,
        turned: exif
            .and_then(Orientation::from_exif_chunk)
            .unwrap_or(Orientation::NoTransforms),
    })
}

fn colour_channels(pixels: &DynamicImage) -> usize {
    if pixels.color().has_color() { 3 } else { 1 }
}

/// Chunks that say something of colours.
const MARKS: [[u8; 4]; 5] = [*b"cICP", *b"iCCP", *b"sRGB", *b"gAMA", *b"cHRM"];

/// The [`MARKS`] before the pixels, whole or not: the decoder does not report unreadable ones.
fn marks(source: &mut (impl Read + Seek)) -> io::Result<Vec<[u8; 4]>> {
    source.seek(SeekFrom::Start(SIGNATURE))?;
    let (mut found, mut head) = (Vec::new(), [0; 8]);
    loop {
        match source.read_exact(&mut head) {
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(found),
            other => other?,
        }
        let [a, b, c, d, kind @ ..] = head;
        if kind == *b"IDAT" {
            return Ok(found);
        }
        if MARKS.contains(&kind) && !found.contains(&kind) {
            found.push(kind);
        }
        // A checksum follows.
        let rest = i64::from(u32::from_be_bytes([a, b, c, d])) + 4;
        source.seek(SeekFrom::Current(rest))?;
    }
}

/// The colours of a picture, and the mark with a higher precedence if that cannot be used.
fn marked(info: &Info<'_>, marks: &[[u8; 4]], channels: usize) -> (Colours, Option<UnusedMark>) {
    let mut unused = None;
    if let Some(found) = code_points(info) {
        match found {
            Ok(colours) => return (colours, None),
            Err(mark) => unused = Some(mark),
        }
    }
    if marks.contains(b"iCCP") {
        let found = match &info.icc_profile {
            Some(icc) => Colours::of_profile(icc, channels),
            None => Err(UnusedMark {
                mark: "colour profile",
                reason: format!(
                    "it is damaged, or unpacks to more than {} MB",
                    MOST_PROFILE >> 20
                ),
            }),
        };
        match found {
            Ok(colours) => return (colours, unused),
            Err(mark) => unused = unused.or(Some(mark)),
        }
    }
    if info.srgb.is_some() {
        return (Colours::srgb(), unused);
    }
    match gamma(info, marks) {
        None => (Colours::srgb(), unused),
        Some(Ok(colours)) => (colours, unused),
        Some(Err(mark)) => (Colours::srgb(), unused.or(Some(mark))),
    }
}

/// Colours by cICP.
fn code_points(info: &Info<'_>) -> Option<Result<Colours, UnusedMark>> {
    let codes = info.coding_independent_code_points?;
    let (primaries, transfer) = (codes.color_primaries, codes.transfer_function);
    let range = match (codes.is_video_full_range_image, info.bit_depth) {
        (true, _) => Range::FULL,
        (false, BitDepth::Sixteen) => Range {
            black: 4096.0,
            white: 60_160.0,
        },
        (false, _) => Range {
            black: 16.0 * 257.0,
            white: 235.0 * 257.0,
        },
    };
    let colours = Chromaticities::of_code(primaries)
        .zip(Transfer::of_code(transfer))
        .and_then(|(chromaticities, transfer)| Colours::encoded(transfer, &chromaticities, range));
    Some(colours.ok_or_else(|| UnusedMark {
        mark: "cICP",
        reason: format!("the colour codes {primaries}, {transfer} are unknown"),
    }))
}

/// Colours by gAMA and cHRM; of one that is missing those of sRGB.
fn gamma(info: &Info<'_>, marks: &[[u8; 4]]) -> Option<Result<Colours, UnusedMark>> {
    let (gamma, chromaticities) = (info.gama_chunk, info.chrm_chunk);
    let is_marked = [b"gAMA", b"cHRM"].map(|mark| marks.contains(mark));
    if is_marked == [false; 2] {
        return None;
    }
    let is_read = [gamma.is_some(), chromaticities.is_some()] == is_marked;
    let transfer = match gamma.map(|gamma| f64::from(gamma.into_scaled()) / SCALE) {
        Some(gamma) if gamma > 0.0 => Some(Transfer::Power(1.0 / gamma)),
        Some(_) => None,
        None => Some(Transfer::Srgb),
    };
    let chromaticities = chromaticities.map_or(Chromaticities::SRGB, |found| {
        let place = |(x, y): (png::ScaledFloat, png::ScaledFloat)| {
            [x, y].map(|value| f64::from(value.into_scaled()) / SCALE)
        };
        Chromaticities {
            primaries: [found.red, found.green, found.blue].map(place),
            white: place(found.white),
        }
    });
    let colours = transfer
        .filter(|_| is_read)
        .and_then(|transfer| Colours::encoded(transfer, &chromaticities, Range::FULL))
        .ok_or_else(|| UnusedMark {
            mark: "gAMA or cHRM",
            reason: "it is out of range".to_owned(),
        });
    Some(colours)
}

fn wrong(error: DecodingError) -> ImportError {
    match error {
        // Wrong content of a chunk is an error of its reader, too.
        DecodingError::IoError(error)
            if !matches!(
                error.kind(),
                ErrorKind::UnexpectedEof | ErrorKind::InvalidData
            ) =>
        {
            ImportError::File(error)
        }
        DecodingError::LimitsExceeded => ImportError::Beside(MOST_PROFILE >> 20),
        other => ImportError::NotAPicture(other.to_string()),
    }
}
