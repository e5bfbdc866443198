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
//! What has two readings, as 1,234 where nothing says which mark is the decimal one, is refused.
//!
//! | module | holds |
//! | --- | --- |
//! | [`table`] | tables, their rows and headings |
//! | [`error`] | what is wrong, where, and what to do |
//! | [`text`] | bytes as text |

mod dialect;
pub mod error;
mod number;
pub mod table;
pub mod text;

pub use dialect::Separator;
pub use error::{Fault, TableError, shown};
pub use table::{HeadingLine, Note, Row, Table};
pub use text::decode;
