//! Rows of the file: tables, checksums, and paint as bytes.

pub mod checksum;
pub mod defect;
pub mod loads;
pub mod planes;
pub mod rows;
pub mod schema;
