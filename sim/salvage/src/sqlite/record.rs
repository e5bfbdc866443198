//! Values of a row: "Record Format", SQLite file format, section 2.1.

/// Value of a row.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// SQL NULL.
    Null,
    /// Integer of 0 to 8 bytes.
    Int(i64),
    /// IEEE 754 number of 8 bytes.
    Real(f64),
    /// UTF-8 text; a row with other text counts as damaged.
    Text(String),
    /// Bytes without an encoding.
    Blob(Vec<u8>),
}

/// SQLite's compile-time limit on columns (`SQLITE_MAX_COLUMN` cannot be raised above it).
const MAX_COLUMNS: usize = 32_767;

/// Varint at the start of `bytes`, and its length of 1 to 9 bytes.
pub(super) fn varint(bytes: &[u8]) -> Option<(u64, usize)> {
    let mut value = 0_u64;
    for (at, &byte) in bytes.iter().take(8).enumerate() {
        value = value << 7 | u64::from(byte & 0x7f);
        if byte < 0x80 {
            return Some((value, at + 1));
        }
    }
    Some((value << 8 | u64::from(*bytes.get(8)?), 9))
}

/// Bytes of a value in the body of a record; `None` for the reserved types 10 and 11.
fn width(serial: u64) -> Option<u64> {
    match serial {
        0 | 8 | 9 => Some(0),
        1..=4 => Some(serial),
        5 => Some(6),
        6 | 7 => Some(8),
        10 | 11 => None,
        _ => Some((serial - 12) / 2),
    }
}

/// Serial types in a record's header behind its length, if they fill `body` bytes exactly, as in every record of SQLite.
fn serials(mut header: &[u8], body: u64) -> Option<Vec<u64>> {
    let mut serials = Vec::new();
    let mut sum = 0_u64;
    while !header.is_empty() {
        let (serial, length) = varint(header)?;
        header = header.get(length..)?;
        sum = sum.checked_add(width(serial)?)?;
        serials.push(serial);
        if sum > body || serials.len() > MAX_COLUMNS {
            return None;
        }
    }
    (sum == body).then_some(serials)
}

/// Size of the header's length field and of the rest of the header, bytes, of a record of `payload` bytes that starts
/// with `local`.
fn header_size(payload: u64, local: &[u8]) -> Option<(usize, usize)> {
    let (header, length) = varint(local)?;
    if header > payload {
        return None;
    }
    Some((length, usize::try_from(header).ok()?.checked_sub(length)?))
}

/// True if a record of `payload` bytes that starts with `local` may be valid, judged by its local part.
pub(super) fn plausible(payload: u64, local: &[u8]) -> bool {
    let Some((length, rest)) = header_size(payload, local) else {
        return false;
    };
    let body = payload - (length + rest) as u64;
    match local.get(length..length + rest) {
        Some(header) => serials(header, body).is_some(),
        None => true,
    }
}

/// Values of a record of `payload` bytes that starts with `local`; `take` gives its bytes in runs, from the first on.
/// `None` if the record is damaged.
pub(super) fn read(
    payload: u64,
    local: &[u8],
    mut take: impl FnMut(usize) -> Option<Vec<u8>>,
) -> Option<Vec<Value>> {
    let (length, rest) = header_size(payload, local)?;
    take(length)?;
    let header = take(rest)?;
    let serials = serials(&header, payload - (length + rest) as u64)?;
    let mut values = Vec::with_capacity(serials.len());
    for serial in serials {
        let bytes = take(usize::try_from(width(serial)?).ok()?)?;
        values.push(value(serial, bytes)?);
    }
    Some(values)
}

fn value(serial: u64, bytes: Vec<u8>) -> Option<Value> {
    let value = match serial {
        0 => Value::Null,
        1..=6 => {
            let negative = bytes.first().is_some_and(|byte| byte & 0x80 != 0);
            let sign = if negative { -1 } else { 0 };
            let digits = bytes.iter();
            Value::Int(digits.fold(sign, |sum, &byte| sum << 8 | i64::from(byte)))
        }
        7 => Value::Real(f64::from_be_bytes(bytes.try_into().ok()?)),
        8 => Value::Int(0),
        9 => Value::Int(1),
        _ if serial.is_multiple_of(2) => Value::Blob(bytes),
        _ => Value::Text(String::from_utf8(bytes).ok()?),
    };
    Some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn varints_have_one_to_nine_bytes() {
        assert_eq!(varint(&[0x7f]), Some((127, 1)));
        assert_eq!(varint(&[0x81, 0x00]), Some((128, 2)));
        assert_eq!(varint(&[0xff; 9]), Some((u64::MAX, 9)));
        assert_eq!(varint(&[0xff; 8]), None);
        assert_eq!(varint(&[0x80]), None);
        assert_eq!(varint(&[]), None);
    }

    #[test]
    fn whole_numbers_keep_their_sign() {
        assert_eq!(value(1, vec![0xff]), Some(Value::Int(-1)));
        assert_eq!(value(3, vec![0x80, 0, 0]), Some(Value::Int(-(1 << 23))));
        let least = i64::MIN.to_be_bytes().to_vec();
        assert_eq!(value(6, least), Some(Value::Int(i64::MIN)));
    }

    #[test]
    fn a_header_that_does_not_fill_the_record_is_damaged() {
        let record = [3, 1, 8, 42];
        let mut at = 0;
        let take = |bytes: usize| {
            at += bytes;
            record.get(at - bytes..at).map(<[u8]>::to_vec)
        };
        assert_eq!(
            read(4, &record, take),
            Some(vec![Value::Int(42), Value::Int(0)])
        );
        assert!(plausible(4, &record));
        assert!(!plausible(5, &record));
        assert!(!plausible(4, &[3, 10, 8, 42]));
        assert!(!plausible(4, &[0, 1, 8, 42]));
    }
}
