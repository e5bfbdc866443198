//! Content of pages, and the document that holds those that are not in memory.

use std::any::{Any, TypeId};

use crate::planes::Planes;

/// Storage of pages that are not in memory.
pub trait Backing: Send + Sync {
    /// Reads a page whose [`Content`] has the type `kind`: the box holds that type.
    ///
    /// # Errors
    /// [`PageError`].
    fn read(&self, id: u64, kind: TypeId) -> Result<Box<dyn Any>, PageError>;

    /// False while what it stores may not be read back, as where its disk fails: then no page leaves memory.
    fn is_at_hand(&self) -> bool {
        true
    }
}

/// A page without content.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// It was never stored, and left memory.
    #[error("page {0} has no document")]
    Unbacked(u64),
    /// It is of a kind that is not stored.
    #[error("page {0} is of a kind that no document holds")]
    Kind(u64),
    /// It is stored as something else.
    #[error("page {0} holds something else")]
    Other(u64),
    /// Its storage does not give it.
    #[error(transparent)]
    Storage(Box<dyn std::error::Error + Send + Sync>),
}

/// Content of a page.
pub trait Content: Send + Sync + Sized + 'static {
    /// Bytes in memory.
    fn bytes(&self) -> usize;
    /// Stand-in for a page that cannot be read.
    fn nothing() -> Self;
}

impl dyn Backing {
    /// Reads a page of a kind that is known.
    pub(super) fn fetch<T: Content>(&self, id: u64) -> Result<T, PageError> {
        let read = self.read(id, TypeId::of::<T>())?.downcast();
        let content = read.map_err(|_| PageError::Other(id))?;
        Ok(*content)
    }
}

impl Content for Planes {
    fn bytes(&self) -> usize {
        self.bytes()
    }

    fn nothing() -> Self {
        Self::new()
    }
}
