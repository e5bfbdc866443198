//! Bytes of a table as text.

use std::borrow::Cow;

use crate::error::{Fault, TableError};

/// The text of a table's bytes: UTF-8, or UTF-16 with a byte order mark, as spreadsheets save "Unicode text".
///
/// # Errors
/// [`Fault::NotText`] with the line.
pub fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, TableError> {
    let wide = |rest: &[u8], unit: fn([u8; 2]) -> u16| {
        let units = rest.chunks(2).map(|two| match *two {
            [a, b] => unit([a, b]),
            // Half a unit at the end is a lone surrogate, which is refused.
            _ => 0xD800,
        });
        let mut text = String::with_capacity(rest.len() / 2);
        for letter in char::decode_utf16(units) {
            match letter {
                Ok(letter) => text.push(letter),
                Err(_) => return Err(TableError::new(line_after(&text), Fault::NotText)),
            }
        }
        Ok(Cow::Owned(text))
    };
    match bytes {
        [0xFF, 0xFE, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xFE, 0xFF, rest @ ..] => wide(rest, u16::from_be_bytes),
        [0xEF, 0xBB, 0xBF, rest @ ..] => narrow(rest),
        _ => narrow(bytes),
    }
}

fn narrow(bytes: &[u8]) -> Result<Cow<'_, str>, TableError> {
    std::str::from_utf8(bytes)
        .map(Cow::Borrowed)
        .map_err(|error| {
            let before = std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
            TableError::new(line_after(before), Fault::NotText)
        })
}

/// The number of the line behind a text.
fn line_after(text: &str) -> usize {
    lines(text).count().max(1)
}

/// Lines that end in LF, CR LF or CR, without their ends; after the last end there is one more.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let now = rest?;
        let Some(end) = now.find(['\n', '\r']) else {
            rest = None;
            return Some(now);
        };
        let behind = &now[end..];
        rest = Some(behind.strip_prefix("\r\n").unwrap_or(&behind[1..]));
        Some(&now[..end])
    })
}
