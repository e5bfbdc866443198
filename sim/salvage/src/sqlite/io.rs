//! Reading at an offset of a file that may be cut or unreadable.

use std::io::{self, Read, Seek, SeekFrom};

/// Up to `length` bytes at `offset`; fewer at the end of the file.
pub(super) fn read_at<F: Read + Seek>(
    file: &mut F,
    offset: u64,
    length: usize,
) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(offset))?;
    let mut bytes = Vec::with_capacity(length);
    file.take(length as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}
