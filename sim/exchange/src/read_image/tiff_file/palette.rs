//! TIFF with a palette. The decoder does not support such pictures, but their indices are stored like the numbers of a
//! grey one: it is read as grey, and the colours are looked up here.

use std::io::{BufRead, Cursor, Read as _, Seek};

use tiff::decoder::Decoder;
use tiff::tags::{ByteOrder, PhotometricInterpretation as Photometric, Tag};

use super::{Samples, open, samples, wrong};
use crate::import_error::ImportError;
use crate::read_image::pixels::Numbers;

/// Bytes of a directory's count and of an entry, and where in it the value stands.
struct Form {
    count: usize,
    entry: usize,
    value: usize,
}

const CLASSIC: Form = Form {
    count: 2,
    entry: 12,
    value: 8,
};
const BIG: Form = Form {
    count: 8,
    entry: 20,
    value: 12,
};
/// The number of BigTIFF in its first bytes.
const BIG_TIFF: u16 = 43;

/// Colours of 16 bits.
pub(super) fn read<R: BufRead + Seek>(
    mut decoder: Decoder<R>,
    size: [u32; 2],
    most_bytes: u64,
) -> Result<Samples, ImportError> {
    let of_size = |error| wrong(error, size);
    let map = decoder.get_tag_u16_vec(Tag::ColorMap).map_err(of_size)?;
    let order = decoder.byte_order();
    let directory = decoder.ifd_pointer().map_or(0, |place| place.0);
    let source = decoder.inner();
    let mut bytes = Vec::new();
    source
        .rewind()
        .and_then(|()| source.take(most_bytes).read_to_end(&mut bytes))
        .map_err(ImportError::File)?;
    let damaged = || ImportError::NotAPicture("its directory is damaged".to_owned());
    call_grey(&mut bytes, directory, order).ok_or_else(damaged)?;
    let mut decoder = open(Cursor::new(&bytes[..]), most_bytes)?;
    let indices: Vec<u16> = match samples(&mut decoder, size, most_bytes)?.numbers {
        Numbers::Bytes(values) => values.into_iter().map(u16::from).collect(),
        Numbers::Words(values) => values,
        Numbers::Floats(_) => return Err(damaged()),
    };
    let each = map.len() / 3;
    // Old programs wrote colours of 8 bits.
    let scale = if map.iter().all(|value| *value < 256) {
        257
    } else {
        1
    };
    let colour = |index: u16| {
        let index = usize::from(index);
        (index < each).then(|| [0, 1, 2].map(|i| map[i * each + index] * scale))
    };
    let mut words = Vec::with_capacity(3 * indices.len());
    for index in indices {
        let colour = colour(index).ok_or_else(|| {
            ImportError::NotAPicture(format!("its palette has {each} colours, and none {index}"))
        })?;
        words.extend(colour);
    }
    Ok(Samples {
        numbers: Numbers::Words(words),
        channels: 3,
    })
}

/// Changes the directory at a place of the file to that of a grey picture.
fn call_grey(bytes: &mut [u8], directory: u64, order: ByteOrder) -> Option<()> {
    let word = |bytes: &[u8], at: usize| {
        let word = bytes.get(at..at + 2)?.try_into().ok()?;
        Some(match order {
            ByteOrder::LittleEndian => u16::from_le_bytes(word),
            ByteOrder::BigEndian => u16::from_be_bytes(word),
        })
    };
    let is_big = word(bytes, 2)? == BIG_TIFF;
    let form = if is_big { BIG } else { CLASSIC };
    let directory = usize::try_from(directory).ok()?;
    let photometric = Tag::PhotometricInterpretation.to_u16();
    let mut at = directory.checked_add(form.count)?;
    // The decoder has found the tag, so the walk ends at it.
    while word(bytes, at)? != photometric {
        at = at.checked_add(form.entry)?;
    }
    let grey = Photometric::BlackIsZero.to_u16();
    let grey = match order {
        ByteOrder::LittleEndian => grey.to_le_bytes(),
        ByteOrder::BigEndian => grey.to_be_bytes(),
    };
    let value = at + form.value;
    bytes.get_mut(value..value + 2)?.copy_from_slice(&grey);
    Some(())
}
