//! Defects of stored bytes.

/// Defect of the bytes of a page or a load. Its words are a predicate, whose subject is the page.
#[derive(Debug, thiserror::Error)]
pub enum Defect {
    /// No bytes of zstd.
    #[error("is not compressed")]
    Uncompressed,
    /// The compressor says nothing of the size.
    #[error("does not say its size")]
    NoSize,
    /// More or fewer bytes than its paints can have.
    #[error("has {bytes} bytes instead of {least} to {most}")]
    Size {
        /// Its bytes.
        bytes: usize,
        /// The fewest that it can have.
        least: usize,
        /// The most.
        most: usize,
    },
    /// Error of the compressor.
    #[error("cannot be decompressed: {0}")]
    Compression(#[from] std::io::Error),
    /// Other planes than its row says.
    #[error("has other planes than it says")]
    Planes,
    /// A count that no cell holds.
    #[error("has a count above a cell's maximum in slot {0}")]
    Count(usize),
    /// A plane of the paint model that is cut off, out of order or of no known shape.
    #[error("has a torn plane of its paint model")]
    Torn,
    /// A plane of the paint model that is never written.
    #[error("has an empty plane of its paint model")]
    Empty,
    /// Planes of a load that do not fit together.
    #[error("has planes that do not fit together")]
    Load,
}
