//! Tables of measurements: their headings, notes, rows and instruments.

pub mod headings;
pub mod instrument;
pub mod measurements;
pub mod notes;
pub(crate) mod reading;
pub mod table;
