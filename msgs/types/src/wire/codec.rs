//! The only file that names the codec: bincode, little endian, fixed width, always with a limit.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::wire::header::{DecodeError, Flags, HEADER_BYTES, Header, Origin};
use crate::wire::schema::{Schema, Wire};

/// A message of the rig: a schema with a version and a size limit.
///
/// Implemented by the macro of `define.rs` alone.
pub trait Message: Wire + Send + Sync + 'static {
    /// Name in the schema and in logs.
    const NAME: &'static str;
    /// Version of the field table; fields are only appended, and each version has golden bytes.
    const VERSION: u16;
    /// The largest body that is encoded or decoded, bytes.
    const MAX_BYTES: usize;
    /// True for a message of the [contract](crate::STYLUS_CONTRACT): programs of other versions read it.
    const IN_CONTRACT: bool;

    /// The field table with its hash.
    fn schema() -> &'static Schema;

    /// Reads a body of that version that has passed the header's checks.
    ///
    /// # Errors
    /// [`DecodeError::Body`] where the bytes do not hold the fields, [`DecodeError::Trailing`]
    /// where they hold more than a message of that version does.
    fn decode_body(version: u16, body: &[u8]) -> Result<Self, DecodeError>;
}

/// Encodes header and body; `sent_ns` is the rig clock's time of sending.
///
/// # Errors
/// [`DecodeError::TooLong`] where the body exceeds the message's limit.
pub fn encode<M: Message>(
    origin: &Origin,
    flags: Flags,
    seq: u64,
    event_ns: u64,
    sent_ns: u64,
    message: &M,
) -> Result<Vec<u8>, DecodeError> {
    let mut bytes = vec![0; HEADER_BYTES];
    write_body(message, &mut bytes)?;
    let header = header::<M>(origin, flags, seq, event_ns, sent_ns, bytes.len())?;
    bytes[..HEADER_BYTES].copy_from_slice(&header);
    Ok(bytes)
}

/// The bytes that [`encode`] gives for a message.
///
/// # Errors
/// [`DecodeError::TooLong`] where the body exceeds the message's limit.
pub fn encoded_bytes<M: Message>(message: &M) -> Result<usize, DecodeError> {
    let mut count = Count(HEADER_BYTES);
    write_body(message, &mut count)?;
    within_limit::<M>(count.0)?;
    Ok(count.0)
}

/// Encodes into memory of exactly [`encoded_bytes`], as [`encode`] does.
///
/// # Errors
/// [`DecodeError::Body`] where the memory is of another size.
pub fn encode_into<M: Message>(
    origin: &Origin,
    flags: Flags,
    seq: u64,
    event_ns: u64,
    sent_ns: u64,
    message: &M,
    into: &mut [u8],
) -> Result<(), DecodeError> {
    let wrong = || DecodeError::Body {
        name: M::NAME,
        reason: "the memory is of another size".into(),
    };
    let header = header::<M>(origin, flags, seq, event_ns, sent_ns, into.len())?;
    let (head, mut body) = into.split_at_mut_checked(HEADER_BYTES).ok_or_else(wrong)?;
    head.copy_from_slice(&header);
    write_body(message, &mut body)?;
    if body.is_empty() {
        Ok(())
    } else {
        Err(wrong())
    }
}

/// Counts what is written.
struct Count(usize);

impl std::io::Write for Count {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0 += bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn write_body<M: Message>(message: &M, into: &mut impl std::io::Write) -> Result<(), DecodeError> {
    let config = bincode::config::standard().with_fixed_int_encoding();
    bincode::serde::encode_into_std_write(message, into, config).map_err(|error| {
        DecodeError::Body {
            name: M::NAME,
            reason: error.to_string(),
        }
    })?;
    Ok(())
}

/// The length of a body of a message of `bytes` with its header, where it is allowed.
fn within_limit<M: Message>(bytes: usize) -> Result<usize, DecodeError> {
    let length = bytes.saturating_sub(HEADER_BYTES);
    if length > M::MAX_BYTES {
        return Err(DecodeError::TooLong {
            name: M::NAME,
            length,
            limit: M::MAX_BYTES,
        });
    }
    Ok(length)
}

fn header<M: Message>(
    origin: &Origin,
    flags: Flags,
    seq: u64,
    event_ns: u64,
    sent_ns: u64,
    bytes: usize,
) -> Result<[u8; HEADER_BYTES], DecodeError> {
    let length = within_limit::<M>(bytes)?;
    let header = Header {
        version: M::VERSION,
        schema: M::schema().hash,
        source: origin.source,
        epoch: origin.epoch,
        flags,
        length: u32::try_from(length).unwrap_or(u32::MAX),
        seq,
        event_ns,
        sent_ns,
    };
    Ok(header.to_bytes())
}

/// Decodes header and body.
///
/// # Errors
/// Any [`DecodeError`]; hostile bytes give one too, never a panic and never an allocation beyond
/// the message's limit.
pub fn decode<M: Message>(bytes: &[u8]) -> Result<(Header, M), DecodeError> {
    let (header, body) = body_of::<M>(bytes)?;
    Ok((header, M::decode_body(header.version, body)?))
}

/// Header and body of a message, whose schema and length are right.
pub(crate) fn body_of<M: Message>(bytes: &[u8]) -> Result<(Header, &[u8]), DecodeError> {
    let header = Header::from_bytes(bytes)?;
    let body = &bytes[HEADER_BYTES..];
    if header.schema != M::schema().hash {
        return Err(DecodeError::UnknownSchema {
            name: M::NAME,
            wanted: M::schema().hash,
            got: header.schema,
            version: header.version,
        });
    }
    if body.len() > M::MAX_BYTES {
        return Err(DecodeError::TooLong {
            name: M::NAME,
            length: body.len(),
            limit: M::MAX_BYTES,
        });
    }
    Ok((header, body))
}

/// Decodes a body into what borrows from it, with an upper bound on what the codec may claim.
pub(crate) fn borrow_limited<'a, M, const LIMIT: usize>(
    name: &'static str,
    body: &'a [u8],
) -> Result<M, DecodeError>
where
    M: Deserialize<'a>,
{
    let config = bincode::config::standard()
        .with_fixed_int_encoding()
        .with_limit::<LIMIT>();
    let (message, used) = bincode::serde::borrow_decode_from_slice(body, config).map_err(
        |error: bincode::error::DecodeError| DecodeError::Body {
            name,
            reason: error.to_string(),
        },
    )?;
    nothing_left(name, body.len() - used)?;
    Ok(message)
}

fn nothing_left(name: &'static str, left: usize) -> Result<(), DecodeError> {
    match left {
        0 => Ok(()),
        left => Err(DecodeError::Trailing { name, left }),
    }
}

/// Decodes a body with an upper bound on what the codec may claim.
pub(crate) fn decode_limited<M, const LIMIT: usize>(
    name: &'static str,
    body: &[u8],
) -> Result<M, DecodeError>
where
    M: DeserializeOwned + Serialize,
{
    let (message, used) = decode_first::<M, LIMIT>(name, body)?;
    nothing_left(name, body.len() - used)?;
    Ok(message)
}

/// Decodes a body of a contract. A newer one may hold more fields than `version` has: they are left alone. An older one
/// lacks the last ones: they are 0, none or empty. A body that was cut is known by the header's length alone.
pub(crate) fn decode_contract<M, const LIMIT: usize>(
    name: &'static str,
    version: u16,
    sent: u16,
    body: &[u8],
) -> Result<M, DecodeError>
where
    M: DeserializeOwned + Serialize,
{
    if sent >= version {
        let (message, used) = decode_first::<M, LIMIT>(name, body)?;
        if sent == version {
            nothing_left(name, body.len() - used)?;
        }
        return Ok(message);
    }
    let filled = [body, &vec![0; LIMIT.saturating_sub(body.len())]].concat();
    let (message, used) = decode_first::<M, LIMIT>(name, &filled)?;
    nothing_left(name, body.len().saturating_sub(used))?;
    Ok(message)
}

/// Decodes the first bytes of a body, and counts them.
fn decode_first<M, const LIMIT: usize>(
    name: &'static str,
    body: &[u8],
) -> Result<(M, usize), DecodeError>
where
    M: DeserializeOwned,
{
    let config = bincode::config::standard()
        .with_fixed_int_encoding()
        .with_limit::<LIMIT>();
    bincode::serde::decode_from_slice(body, config).map_err(|error| DecodeError::Body {
        name,
        reason: error.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[expect(unreachable_pub, reason = "messages are public")]
    mod before {
        crate::wire::define::message! {
            /// A message as its contract began.
            pub struct Sample [contract of hash 0x0102_0304, version 1, at most 64 bytes] {
                /// A number.
                pub number: u32,
                /// A word.
                pub word: String,
            }
        }
    }

    #[expect(unreachable_pub, reason = "messages are public")]
    mod after {
        crate::wire::define::message! {
            /// The same with more at its end.
            pub struct Sample [contract of hash 0x0102_0304, version 2, at most 64 bytes] {
                /// A number.
                pub number: u32,
                /// A word.
                pub word: String,
                /// Added.
                pub share: f64,
                /// Added.
                pub flag: Option<u8>,
            }
        }
    }

    fn sent<M: Message>(message: &M) -> Vec<u8> {
        let origin = Origin {
            source: 1,
            epoch: 2,
        };
        encode(&origin, Flags::NONE, 0, 0, 0, message).expect("within its limit")
    }

    #[test]
    fn a_message_of_a_contract_is_read_by_older_and_by_newer_programs() {
        let old = before::Sample {
            number: 7,
            word: "pen".into(),
        };
        let new = after::Sample {
            number: 7,
            word: "pen".into(),
            share: 0.5,
            flag: Some(3),
        };
        let filled = after::Sample {
            share: 0.0,
            flag: None,
            ..new.clone()
        };
        assert_eq!(decode(&sent(&new)).map(|(_, read)| read), Ok(old.clone()));
        assert_eq!(decode(&sent(&old)).map(|(_, read)| read), Ok(filled));
        assert_eq!(decode(&sent(&new)).map(|(_, read)| read), Ok(new));
    }

    #[test]
    fn bytes_that_no_version_has_are_refused() {
        let old = sent(&before::Sample {
            number: 7,
            word: "pen".into(),
        });
        let body = &old[HEADER_BYTES..];
        let longer = [body, &[0]].concat();
        let cut = &body[..body.len() - 1];
        assert!(before::Sample::decode_body(1, &longer).is_err());
        assert!(before::Sample::decode_body(2, &longer).is_ok());
        assert!(before::Sample::decode_body(1, cut).is_err());
        assert!(before::Sample::decode_body(2, cut).is_err());
        // An older one holds no more than this one.
        let newer = after::Sample {
            number: 7,
            word: "pen".into(),
            share: 0.5,
            flag: None,
        };
        let whole = [&sent(&newer)[HEADER_BYTES..], &[0]].concat();
        assert!(after::Sample::decode_body(1, &whole).is_err());
    }
}
