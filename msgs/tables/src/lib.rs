//! Tables of numbers as spreadsheets and programs of any country write them. The one reader of all tables of the project:
//! strokes, spectra, measurements, paints, outlines, poses.
//!
//! | what | is read |
//! | --- | --- |
//! | text | UTF-8, or UTF-16 with a byte order mark |
//! | lines | end in LF, CR LF or CR |
//! | separators | `;`, tabs, `,` or blanks: the one under which most cells are numbers |
//! | quotes | round a cell; two of them are one within it |
//! | numbers | with a decimal point or comma, without separators of thousands |
//! | comments | lines that begin with `#`; `# key: value` is a note |
//! | blank lines | part blocks, such as strokes |
//!
//! A number with two readings, as 1,234 where nothing says which mark is the decimal one, is rejected.
//!
//! | module | holds |
//! | --- | --- |
//! | [`table`] | tables, their rows and headings |
//! | [`error`] | what is wrong, where, and what to do |
//! | [`text`] | bytes as text |
//!
//! Measurements as a spreadsheet of a country with decimal commas saves them:
//!
//! ```
//! use maulstick_tables::{Fault, HeadingLine, Table};
//!
//! # fn main() -> Result<(), maulstick_tables::TableError> {
//! let table = Table::parse("depth_m;force_n\n0,001;0,25\n0,002;0,5\n", HeadingLine::First)?;
//! let [depth, force] = table.columns(["depth_m", "force_n"])?;
//! let (depth, force) = (depth.expect("a column"), force.expect("a column"));
//! for row in table.rows() {
//!     let stiffness_n_m = row.number(force)? / row.number(depth)?;
//!     assert!((stiffness_n_m - 250.0).abs() < 1e-9);
//! }
//! let unclear = Table::parse("0;1,234\n", HeadingLine::Row)?;
//! let error = unclear.rows().next().expect("a row").number(1).expect_err("1.234 or 1234?");
//! assert!(matches!(error.fault, Fault::TwoReadings { .. }));
//! # Ok(())
//! # }
//! ```

mod dialect;
pub mod error;
mod number;
pub mod table;
pub mod text;

pub use dialect::Separator;
pub use error::{Fault, MOST_CHARACTERS, TableError, shown};
pub use table::{HeadingLine, Note, Row, Table};
pub use text::decode;
