//! Content of pages, and the document that stores those outside of memory.

use std::any::{Any, TypeId};

use crate::planes::Planes;

/// Storage of pages outside of memory.
pub trait Backing: Send + Sync {
    /// Reads a page whose [`Content`] has the type `kind`: the box holds that type.
    ///
    /// # Errors
    /// [`PageError`].
    fn read(&self, id: u64, kind: TypeId) -> Result<Box<dyn Any>, PageError>;

    /// False while stored pages may be unreadable, for example on a failing disk: then no page leaves memory.
    fn is_at_hand(&self) -> bool {
        true
    }
}

/// Errors of reading a page.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// It was never stored, and left memory.
    #[error("page {0} has no document")]
    Unbacked(u64),
    /// Its kind is not stored.
    #[error("page {0} is of a kind that no document holds")]
    Kind(u64),
    /// It is stored as another kind.
    #[error("page {0} holds something else")]
    Other(u64),
    /// Its storage cannot read it.
    #[error(transparent)]
    Storage(Box<dyn std::error::Error + Send + Sync>),
}

/// Content of a page.
pub trait Content: Send + Sync + Sized + 'static {
    /// Size in memory, bytes.
    fn bytes(&self) -> usize;
    /// Substitute for an unreadable page.
    fn nothing() -> Self;
}

impl dyn Backing {
    /// Reads a page of a known kind.
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
