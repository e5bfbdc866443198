//! Records of an MCAP file, read within its bounds.
//!
//! No length that a file states is believed before it is compared with the bytes at hand, so reading a
//! damaged file allocates no more than a small multiple of it. Behind a damaged record the search continues,
//! byte by byte, for the next that can be one: its kind is known, its length fits its kind and the file,
//! and it ends where another begins.

use std::borrow::Cow;
use std::io::Read;

use mcap::MAGIC;
use mcap::records::op;

/// Opcode and length of a record, bytes.
pub const HEAD: usize = 9;
/// The first opcode that MCAP leaves to applications.
const FIRST_PRIVATE: u8 = 0x80;
/// Window of a zstd frame that is decompressed, as a power of 2 in bytes; zstd's own levels up to 19 need it.
const WINDOW_LOG: u32 = 23;
/// Most bytes that a chunk becomes that says so, however well it packs: plain pictures pack above 2000:1.
const MOST_STATED: usize = 64 << 20;
/// Most bytes that a byte of another chunk may become. Samples at rest become 30.
const MOST_EXPANSION: usize = 256;
/// Allocation that a chunk of any size may need, bytes.
const LEAST_ROOM: usize = 1 << 20;

/// A record of a file or chunk, or damaged bytes that begin where one was expected.
#[derive(Clone, Copy, Debug)]
pub struct Found<'a> {
    /// Offset of its beginning, bytes.
    pub at: usize,
    /// Its kind; see [`mcap::records::op`].
    pub opcode: u8,
    /// Its content. Of a damaged one all up to the next record.
    pub body: &'a [u8],
    /// True if its length is one that its kind may have, and another record begins at its end.
    pub whole: bool,
}

/// Records one after the other.
pub struct Records<'a> {
    bytes: &'a [u8],
    at: usize,
}

/// The records of `bytes` from `at` on, up to the closing magic or the end.
pub fn records(bytes: &[u8], at: usize) -> Records<'_> {
    Records { bytes, at }
}

impl<'a> Iterator for Records<'a> {
    type Item = Found<'a>;

    fn next(&mut self) -> Option<Found<'a>> {
        let Self { bytes, at } = *self;
        let opcode = *bytes.get(at)?;
        if bytes[at..].starts_with(MAGIC) {
            return None;
        }
        let end = end_of(bytes, at).filter(|end| begins(bytes, *end));
        let whole = end.is_some();
        let end = end.unwrap_or_else(|| {
            let next = |next: &usize| end_of(bytes, *next).is_some_and(|end| begins(bytes, end));
            (at + 1..bytes.len()).find(next).unwrap_or(bytes.len())
        });
        self.at = end;
        Some(Found {
            at,
            opcode,
            body: bytes.get(at + HEAD..end).unwrap_or_default(),
            whole,
        })
    }
}

/// True if a record, the closing magic or the end is at `at`.
fn begins(bytes: &[u8], at: usize) -> bool {
    at == bytes.len() || bytes[at..].starts_with(MAGIC) || end_of(bytes, at).is_some()
}

/// End of the record at `at`, if it can be one.
fn end_of(bytes: &[u8], at: usize) -> Option<usize> {
    let opcode = *bytes.get(at)?;
    let length = usize::try_from(u64_at(bytes, at + 1)?).ok()?;
    let end = at.checked_add(HEAD)?.checked_add(length)?;
    let body = bytes.get(at + HEAD..end)?;
    // The contents of private records are not known, so they are recognised by what follows them.
    let fits = if opcode >= FIRST_PRIVATE {
        end == bytes.len()
            || bytes.get(end).is_some_and(|next| *next < FIRST_PRIVATE) && begins(bytes, end)
    } else {
        fits(opcode, body)
    };
    fits.then_some(end)
}

/// True if the content of a record has a length that its kind may have.
fn fits(opcode: u8, body: &[u8]) -> bool {
    let length = body.len();
    match opcode {
        op::HEADER => after_texts(body, 0, 2) == Some(length),
        op::FOOTER => length == 20,
        op::SCHEMA => after_texts(body, 2, 3) == Some(length),
        op::CHANNEL => map_fits(body, after_texts(body, 4, 2)),
        op::MESSAGE => length >= 22,
        op::CHUNK => chunk_data(body).is_some_and(|(_, stated, data)| stated == data.len() as u64),
        op::MESSAGE_INDEX => after_texts(body, 2, 1) == Some(length),
        op::CHUNK_INDEX => length >= 64,
        op::ATTACHMENT => attachment_fits(body),
        op::ATTACHMENT_INDEX => after_texts(body, 40, 2) == Some(length),
        op::STATISTICS => after_texts(body, 42, 1) == Some(length),
        op::METADATA => map_fits(body, after_texts(body, 0, 1)),
        op::METADATA_INDEX => after_texts(body, 16, 1) == Some(length),
        op::SUMMARY_OFFSET => length == 17,
        op::DATA_END => length == 4,
        _ => false,
    }
}

/// Names and size of an attachment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct AttachmentHead {
    /// Name of the file.
    pub name: String,
    /// Its media type.
    pub media_type: String,
    /// Where its data begin in the record's body.
    pub data_at: u64,
    /// Their length, as the record states it.
    pub data_bytes: u64,
}

impl AttachmentHead {
    /// Length of the record's body, with the checksum behind the data.
    pub(crate) fn record_bytes(&self) -> Option<u64> {
        self.data_at.checked_add(4)?.checked_add(self.data_bytes)
    }
}

/// The head of the attachment whose body begins with `body`.
pub(crate) fn attachment_head(body: &[u8]) -> Option<AttachmentHead> {
    let [name, media_type, end] = [0, 1, 2].map(|count| after_texts(body, 16, count));
    let text = |from: Option<usize>, to: Option<usize>| {
        let bytes = body.get(from?.checked_add(4)?..to?)?;
        String::from_utf8(bytes.to_vec()).ok()
    };
    Some(AttachmentHead {
        name: text(name, media_type)?,
        media_type: text(media_type, end)?,
        data_at: end? as u64 + 8,
        data_bytes: u64_at(body, end?)?,
    })
}

/// True if an attachment's data and checksum end with it. [`mcap::parse_record`] panics on some that do not.
fn attachment_fits(body: &[u8]) -> bool {
    let stated = attachment_head(body).and_then(|head| head.record_bytes());
    stated == Some(body.len() as u64)
}

/// End of the `count` texts that begin at `at`: each a u32 length and its bytes. Arrays look the same.
pub(crate) fn after_texts(body: &[u8], at: usize, count: usize) -> Option<usize> {
    (0..count).try_fold(at, |at, _| {
        let length = u32::from_le_bytes(*body.get(at..)?.first_chunk()?);
        let end = at
            .checked_add(4)?
            .checked_add(usize::try_from(length).ok()?)?;
        (end <= body.len()).then_some(end)
    })
}

/// True if a map that begins at `at` ends with the record, and its texts with it: [`mcap::parse_record`] allocates the
/// lengths that they state.
fn map_fits(body: &[u8], at: Option<usize>) -> bool {
    let Some(at) = at.filter(|at| after_texts(body, *at, 1) == Some(body.len())) else {
        return false;
    };
    let mut text = at + 4;
    while text < body.len() {
        let Some(next) = after_texts(body, text, 2) else {
            return false;
        };
        text = next;
    }
    true
}

pub(crate) fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    Some(u64::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

/// Compression of a chunk, the length that it states, and the data that it has.
fn chunk_data(body: &[u8]) -> Option<(&str, u64, &[u8])> {
    let end = after_texts(body, 28, 1)?;
    let compression = std::str::from_utf8(&body[32..end]).ok()?;
    Some((compression, u64_at(body, end)?, body.get(end + 8..)?))
}

/// Records of a chunk, decompressed.
pub struct Unpacked<'a> {
    /// As far as they can be had.
    pub bytes: Cow<'a, [u8]>,
    /// The damage, if some are missing or changed.
    pub damage: Option<String>,
}

/// Decompresses the body of a chunk record, as far as that goes.
pub fn unpack(body: &[u8]) -> Unpacked<'_> {
    let nothing = |damage: String| Unpacked {
        bytes: Cow::Borrowed(&[]),
        damage: Some(damage),
    };
    let Some((compression, stated, data)) = chunk_data(body) else {
        return nothing("the head of a chunk is cut off".into());
    };
    let data = match usize::try_from(stated) {
        Ok(length) if compression.is_empty() => data.get(..length).unwrap_or(data),
        _ => data,
    };
    let (bytes, mut damage) = match compression {
        "" => (Cow::Borrowed(data), None),
        "zstd" => {
            let decoder = zstd::stream::read::Decoder::with_buffer(data).and_then(|mut decoder| {
                decoder.window_log_max(WINDOW_LOG)?;
                Ok(decoder.single_frame())
            });
            read_all(decoder, most_of(body, data))
        }
        "lz4" => read_all(lz4::Decoder::new(data), most_of(body, data)),
        other => return nothing(format!("chunks compressed by '{other}' cannot be read")),
    };
    let crc = u32::from_le_bytes(std::array::from_fn(|i| body[24 + i]));
    if damage.is_none() && crc != 0 && crc32fast::hash(&bytes) != crc {
        damage = Some("the checksum of a chunk is not that of its records".into());
    }
    Unpacked { bytes, damage }
}

/// Most bytes that the data of a chunk may become.
fn most_of(body: &[u8], data: &[u8]) -> usize {
    let stated = u64_at(body, 16).and_then(|stated| usize::try_from(stated).ok());
    let by_size = data.len().saturating_mul(MOST_EXPANSION).max(LEAST_ROOM);
    by_size.max(stated.unwrap_or(0).min(MOST_STATED))
}

/// Reads the bytes that a decoder gives before it fails, up to a limit.
fn read_all(
    decoder: std::io::Result<impl Read>,
    most: usize,
) -> (Cow<'static, [u8]>, Option<String>) {
    let mut bytes = Vec::new();
    let read = decoder.and_then(|decoder| decoder.take(most as u64 + 1).read_to_end(&mut bytes));
    let damage = match read {
        Err(error) => Some(format!("a chunk cannot be decompressed: {error}")),
        Ok(length) if length > most => Some(format!("a chunk becomes more than {most} bytes")),
        Ok(_) => None,
    };
    bytes.truncate(most);
    (Cow::Owned(bytes), damage)
}
