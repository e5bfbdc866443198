//! The bytes of an answer: owned, or in memory that two processes share.

use std::fmt;
use std::ops::Deref;

use zenoh::shm::ZShm;

/// Bytes to read. Shared bytes stay where they are until this is dropped, and their sender does not change them.
#[derive(Clone)]
pub enum Payload {
    /// Copied.
    Own(Vec<u8>),
    /// In its sender's memory.
    Shared(SharedPayload),
}

/// A piece of another process's pool.
#[derive(Clone)]
pub struct SharedPayload(ZShm);

impl Payload {
    /// Bytes received: in place if its sender shares them.
    pub(crate) fn of(bytes: &zenoh::bytes::ZBytes) -> Self {
        match bytes.as_shm() {
            Some(shared) => Self::Shared(SharedPayload(shared.to_owned())),
            None => Self::Own(bytes.to_bytes().into_owned()),
        }
    }

    /// True if it is in shared memory.
    #[must_use]
    pub fn is_shared(&self) -> bool {
        matches!(self, Self::Shared(_))
    }
}

impl Deref for Payload {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::Own(bytes) => bytes,
            Self::Shared(SharedPayload(bytes)) => bytes,
        }
    }
}

impl From<Vec<u8>> for Payload {
    fn from(bytes: Vec<u8>) -> Self {
        Self::Own(bytes)
    }
}

impl PartialEq for Payload {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl Eq for Payload {}

impl fmt::Debug for Payload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Payload")
            .field("bytes", &self.len())
            .field("shared", &self.is_shared())
            .finish()
    }
}

impl fmt::Debug for SharedPayload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("SharedPayload").field(&self.0.len()).finish()
    }
}
