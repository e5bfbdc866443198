//! Content of pages, and the document that holds those that are not in memory.

use crate::load::BrushLoad;
use crate::planes::{Planes, TILE_CELLS};

/// Storage of pages that are not in memory.
pub trait Backing: Send + Sync {
    /// The counts of a page.
    ///
    /// # Errors
    /// The defect, in words.
    fn planes(&self, id: u64) -> Result<Planes, String>;
    /// Load of a brush.
    ///
    /// # Errors
    /// The defect, in words.
    fn load(&self, id: u64) -> Result<BrushLoad, String>;
}

/// Content of a page.
pub trait Content: Send + Sync + Sized + 'static {
    /// Bytes in memory.
    fn bytes(&self) -> usize;
    /// Reads it.
    ///
    /// # Errors
    /// As [`Backing`]'s.
    fn fetch(backing: &dyn Backing, id: u64) -> Result<Self, String>;
    /// Stand-in for a page that cannot be read.
    fn nothing() -> Self;
}

impl Content for Planes {
    fn bytes(&self) -> usize {
        self.len() * TILE_CELLS * size_of::<f32>()
    }

    fn fetch(backing: &dyn Backing, id: u64) -> Result<Self, String> {
        backing.planes(id)
    }

    fn nothing() -> Self {
        Self::new()
    }
}

impl Content for BrushLoad {
    fn bytes(&self) -> usize {
        self.bytes()
    }

    fn fetch(backing: &dyn Backing, id: u64) -> Result<Self, String> {
        backing.load(id)
    }

    fn nothing() -> Self {
        Self::clean(0)
    }
}
