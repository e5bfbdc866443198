//! Records of an MCAP file that is too large for memory: read one after the other, a damaged rest as a whole.

use std::fs::File;
use std::io::Result;
use std::os::unix::fs::FileExt as _;

use mcap::records::op;

use crate::mcap_records::{Found, HEAD, attachment_head, records};

/// Largest record but for attachments that is read at once, bytes.
const MOST_RECORD: u64 = 256 << 20;
/// As much of an attachment as holds the names in its head, bytes.
const ATTACHMENT_HEAD: u64 = 64 << 10;

/// Bytes of a file from `at` on, as many of them as it has.
pub(crate) fn read_at(file: &File, length: u64, at: u64, bytes: u64) -> Result<Vec<u8>> {
    let bytes = bytes.min(length.saturating_sub(at));
    let mut read = vec![0; usize::try_from(bytes).unwrap_or(0)];
    file.read_exact_at(&mut read, at)?;
    Ok(read)
}

/// Has `each` see the records of a file of `length` bytes from `from` on. Of a large attachment the body is its beginning.
pub(crate) fn walk(
    file: &File,
    length: u64,
    from: u64,
    each: &mut dyn FnMut(&Found<'_>),
) -> Result<()> {
    let mut at = from;
    while at < length {
        let Some(bytes) = whole_record(file, length, at)? else {
            break;
        };
        let end = at + HEAD as u64 + length_at(&bytes);
        each(&Found {
            at: at as usize,
            opcode: bytes[0],
            body: &bytes[HEAD..],
            whole: true,
        });
        at = end;
    }
    let rest = read_at(file, length, at, length)?;
    for found in records(&rest, 0) {
        each(&Found {
            at: found.at + at as usize,
            ..found
        });
    }
    Ok(())
}

/// The record at `at` with its head, if it is intact.
fn whole_record(file: &File, length: u64, at: u64) -> Result<Option<Vec<u8>>> {
    let head = read_at(file, length, at, HEAD as u64)?;
    if head.len() < HEAD {
        return Ok(None);
    }
    let stated = length_at(&head);
    let end = at.checked_add(HEAD as u64 + stated);
    if end.is_none_or(|end| end > length) {
        return Ok(None);
    }
    if head[0] == op::ATTACHMENT && stated > ATTACHMENT_HEAD {
        let bytes = read_at(file, length, at, HEAD as u64 + ATTACHMENT_HEAD)?;
        let head = attachment_head(&bytes[HEAD..]);
        let ends = head.is_some_and(|head| head.record_bytes() == Some(stated));
        return Ok(ends.then_some(bytes));
    }
    if stated > MOST_RECORD {
        return Ok(None);
    }
    let bytes = read_at(file, length, at, HEAD as u64 + stated)?;
    let first = records(&bytes, 0).next();
    let is_whole = first.is_some_and(|first| first.whole && first.body.len() as u64 == stated);
    Ok(is_whole.then_some(bytes))
}

/// The length that the head of a record states; one that no file has is cut.
fn length_at(head: &[u8]) -> u64 {
    let bytes = head.get(1..HEAD).and_then(|bytes| bytes.first_chunk());
    let stated = bytes.copied().map_or(0, u64::from_le_bytes);
    stated.min(u64::MAX / 2)
}
