//! Files that a recording holds: where they are, read when they are asked for.

use std::fs::File;
use std::io::{Error, ErrorKind, Result, Write};
use std::os::unix::fs::FileExt as _;

use crate::mcap_records::{AttachmentHead, Found, HEAD, after_texts, attachment_head, u64_at};
use crate::mcap_walk::read_at;

/// Bytes that are copied at once.
const COPIED: u64 = 1 << 20;

/// A file in a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attachment {
    /// Its media type.
    pub media_type: String,
    /// Its length, bytes.
    pub bytes: u64,
    /// Where the body of its record begins in the recording.
    body_at: u64,
    /// Where its data begin there.
    data_at: u64,
}

impl Attachment {
    /// The file of a record of a recording of `length` bytes, with its name.
    pub(crate) fn of(record: &Found<'_>, length: u64) -> Option<(String, Self)> {
        let AttachmentHead {
            name,
            media_type,
            data_at,
            data_bytes,
        } = attachment_head(record.body)?;
        let body_at = (record.at + HEAD) as u64;
        let data_at = body_at + data_at;
        let end = data_at.checked_add(data_bytes)?.checked_add(4)?;
        let attachment = Self {
            media_type,
            bytes: data_bytes,
            body_at,
            data_at,
        };
        (end <= length).then_some((name, attachment))
    }

    /// The file of an entry of the index.
    pub(super) fn of_index(entry: &[u8], length: u64) -> Option<(String, Self)> {
        let [at, bytes, data] = [0, 8, 32].map(|place| u64_at(entry, place));
        let [name, media_type, end] = [0, 1, 2].map(|count| after_texts(entry, 40, count));
        let text = |from: Option<usize>, to: Option<usize>| {
            String::from_utf8(entry.get(from? + 4..to?)?.to_vec()).ok()
        };
        let end_at = at?.checked_add(bytes?).filter(|end| *end <= length)?;
        let attachment = Self {
            media_type: text(media_type, end)?,
            bytes: data?,
            body_at: at? + HEAD as u64,
            data_at: end_at.checked_sub(4)?.checked_sub(data?)?,
        };
        let fits = attachment.body_at + 8 <= attachment.data_at;
        fits.then_some((text(name, media_type)?, attachment))
    }

    /// Where its record begins and ends.
    pub(super) fn record(&self) -> [u64; 2] {
        let end = self.data_at.saturating_add(self.bytes).saturating_add(4);
        [self.body_at.saturating_sub(HEAD as u64), end]
    }

    /// Writes its data to `to`.
    ///
    /// # Errors
    /// The error of the file system; [`ErrorKind::InvalidData`] where they are not what was written.
    pub(crate) fn copy(&self, file: &File, to: &mut dyn Write) -> Result<()> {
        let damaged = || Error::new(ErrorKind::InvalidData, "an attached file is damaged");
        let mut hasher = crc32fast::Hasher::new();
        let end = self.data_at + self.bytes;
        let head = read_at(file, end, self.body_at, self.data_at - self.body_at)?;
        let stated = head.len().checked_sub(8).and_then(|at| u64_at(&head, at));
        if stated != Some(self.bytes) {
            return Err(damaged());
        }
        hasher.update(&head);
        let mut at = self.data_at;
        while at < end {
            let part = read_at(file, end, at, COPIED)?;
            hasher.update(&part);
            to.write_all(&part)?;
            at += part.len() as u64;
        }
        let mut crc = [0; 4];
        file.read_exact_at(&mut crc, end)?;
        let crc = u32::from_le_bytes(crc);
        if crc == 0 || crc == hasher.finalize() {
            Ok(())
        } else {
            Err(damaged())
        }
    }
}
