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

    /// The field table with its hash.
    fn schema() -> &'static Schema;

    /// Reads a body that has passed the header's checks.
    ///
    /// # Errors
    /// [`DecodeError::Body`] where the bytes do not hold the fields, [`DecodeError::Trailing`]
    /// where they hold more.
    fn decode_body(body: &[u8]) -> Result<Self, DecodeError>;
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
    Ok((header, M::decode_body(body)?))
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
    if used != body.len() {
        return Err(DecodeError::Trailing {
            name,
            left: body.len() - used,
        });
    }
    Ok(message)
}

/// Decodes a body with an upper bound on what the codec may claim.
pub(crate) fn decode_limited<M, const LIMIT: usize>(
    name: &'static str,
    body: &[u8],
) -> Result<M, DecodeError>
where
    M: DeserializeOwned + Serialize,
{
    let config = bincode::config::standard()
        .with_fixed_int_encoding()
        .with_limit::<LIMIT>();
    let (message, used) =
        bincode::serde::decode_from_slice(body, config).map_err(|error| DecodeError::Body {
            name,
            reason: error.to_string(),
        })?;
    if used != body.len() {
        return Err(DecodeError::Trailing {
            name,
            left: body.len() - used,
        });
    }
    Ok(message)
}
