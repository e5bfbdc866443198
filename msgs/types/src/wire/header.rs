//! The 48 bytes before every message, and the errors of reading one.

/// First two bytes of every message, little endian.
pub const MAGIC: u16 = 0x4D4C;
/// Length of the header in bytes.
pub const HEADER_BYTES: usize = 48;

/// Fields of the 48 bytes, in this order, little endian: names and types as in field tables.
pub const HEADER_FIELDS: [(&str, &str); 10] = [
    ("magic", "u16"),
    ("version", "u16"),
    ("schema", "u32"),
    ("source", "u32"),
    ("epoch", "u32"),
    ("flags", "u32"),
    ("length", "u32"),
    ("seq", "u64"),
    ("event_ns", "u64"),
    ("sent_ns", "u64"),
];

/// Bits of [`Header::flags`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flags(pub u32);

impl Flags {
    /// No flag.
    pub const NONE: Self = Self(0);
    /// The message is played from a take: it is never merged and waits for credit.
    pub const REPLAY: Self = Self(1);
    /// The first message of its stream.
    pub const FIRST: Self = Self(2);
    /// The next message continues this one.
    pub const CONTINUES: Self = Self(4);
    /// The last message of a played take: until then the take has its brush to itself.
    pub const LAST: Self = Self(8);

    /// Both sets of bits.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// True if all bits of `other` are set.
    #[must_use]
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

/// Sender of a message: a number of its own, and one drawn at random at each start. Streams are distinguished by
/// their topics: two devices may have chosen the same number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Origin {
    /// [`name_hash`](crate::name_hash) of a brush or a node; a device may choose any number.
    pub source: u32,
    /// Random at each start of the sender.
    pub epoch: u32,
}

/// Beginning of every message: magic, then these fields, little endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// Version of the message's field table.
    pub version: u16,
    /// Hash of the message's name and field table.
    pub schema: u32,
    /// [`Origin::source`].
    pub source: u32,
    /// [`Origin::epoch`].
    pub epoch: u32,
    /// Replay, first, continues, last.
    pub flags: Flags,
    /// Length of the body in bytes.
    pub length: u32,
    /// Number of the message in its stream.
    pub seq: u64,
    /// Time at which its content was sampled, rig clock, ns.
    pub event_ns: u64,
    /// Time of sending, rig clock, ns.
    pub sent_ns: u64,
}

impl Header {
    /// The sender.
    #[must_use]
    pub fn origin(&self) -> Origin {
        Origin {
            source: self.source,
            epoch: self.epoch,
        }
    }

    /// The bytes on the wire.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; HEADER_BYTES] {
        let mut bytes = [0; HEADER_BYTES];
        bytes[0..2].copy_from_slice(&MAGIC.to_le_bytes());
        bytes[2..4].copy_from_slice(&self.version.to_le_bytes());
        let words = [
            self.schema,
            self.source,
            self.epoch,
            self.flags.0,
            self.length,
        ];
        for (place, word) in bytes[4..24].chunks_exact_mut(4).zip(words) {
            place.copy_from_slice(&word.to_le_bytes());
        }
        for (place, word) in
            bytes[24..]
                .chunks_exact_mut(8)
                .zip([self.seq, self.event_ns, self.sent_ns])
        {
            place.copy_from_slice(&word.to_le_bytes());
        }
        bytes
    }

    /// Reads the header and checks magic and length against the whole message.
    ///
    /// # Errors
    /// [`DecodeError::TooShort`], [`DecodeError::Magic`] or [`DecodeError::Length`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, DecodeError> {
        if bytes.len() < HEADER_BYTES {
            return Err(DecodeError::TooShort {
                length: bytes.len(),
            });
        }
        let u16_at = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        let u32_at = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
        let u64_at = |at: usize| u64::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
        if u16_at(0) != MAGIC {
            return Err(DecodeError::Magic { got: u16_at(0) });
        }
        let header = Self {
            version: u16_at(2),
            schema: u32_at(4),
            source: u32_at(8),
            epoch: u32_at(12),
            flags: Flags(u32_at(16)),
            length: u32_at(20),
            seq: u64_at(24),
            event_ns: u64_at(32),
            sent_ns: u64_at(40),
        };
        if header.length as usize != bytes.len() - HEADER_BYTES {
            return Err(DecodeError::Length {
                says: header.length as usize,
                has: bytes.len() - HEADER_BYTES,
            });
        }
        Ok(header)
    }
}

/// Error of decoding a message.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DecodeError {
    /// Fewer bytes than a header.
    #[error("{length} bytes are too few for a message: its header alone has 48")]
    TooShort {
        /// Bytes received.
        length: usize,
    },
    /// The first two bytes are not [`MAGIC`].
    #[error("not a Maulstick message: it begins with {got:#06x} instead of 0x4d4c")]
    Magic {
        /// The first two bytes.
        got: u16,
    },
    /// The length field disagrees with the bytes received.
    #[error("the header promises a body of {says} bytes, {has} arrived")]
    Length {
        /// Length in the header.
        says: usize,
        /// Bytes received.
        has: usize,
    },
    /// Another message, or another version of it.
    #[error(
        "schema {got:#010x} (version {version}) is not {name}'s {wanted:#010x}: \
         rebuild the sender, or compare the message formats"
    )]
    UnknownSchema {
        /// The message that was expected.
        name: &'static str,
        /// Its hash.
        wanted: u32,
        /// The hash that came.
        got: u32,
        /// The version that came.
        version: u16,
    },
    /// A body over the message's limit.
    #[error("{name} of {length} bytes exceeds its limit of {limit}")]
    TooLong {
        /// The message.
        name: &'static str,
        /// Bytes of the body.
        length: usize,
        /// Its limit.
        limit: usize,
    },
    /// The body does not hold the fields.
    #[error("{name}: the body does not decode: {reason}")]
    Body {
        /// The message.
        name: &'static str,
        /// Error of the codec.
        reason: String,
    },
    /// Bytes are left over.
    #[error("{name}: {left} bytes are left after the last field")]
    Trailing {
        /// The message.
        name: &'static str,
        /// Number of bytes left over.
        left: usize,
    },
}
