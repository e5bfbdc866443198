//! Defects of stored bytes.

/// Defect of the bytes of a page or a load. Its text is a predicate, whose subject is the page.
#[derive(Debug, thiserror::Error)]
pub enum Defect {
    /// The bytes are not zstd.
    #[error("is not compressed")]
    Uncompressed,
    /// The compressed data lack their size.
    #[error("does not say its size")]
    NoSize,
    /// The size does not fit its paints.
    #[error("has {bytes} bytes instead of {least} to {most}")]
    Size {
        /// Size of the data, bytes.
        bytes: usize,
        /// Least size, bytes.
        least: usize,
        /// Greatest size, bytes.
        most: usize,
    },
    /// Error of the compressor.
    #[error("cannot be decompressed: {0}")]
    Compression(#[from] std::io::Error),
    /// Other planes than its row lists.
    #[error("has other planes than its row lists")]
    Planes,
    /// A count above the capacity of a cell.
    #[error("has a count above a cell's maximum in slot {0}")]
    Count(usize),
    /// A plane of the paint model that is truncated, out of order or of an unknown shape.
    #[error("has a torn plane of its paint model")]
    Torn,
    /// A plane of the paint model that is never written.
    #[error("has an empty plane of its paint model")]
    Empty,
    /// Inconsistent planes of a load.
    #[error("has planes that do not fit together")]
    Load,
}
