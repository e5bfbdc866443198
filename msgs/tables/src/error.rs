//! Errors of a table: the fault, its place, advice.

use std::fmt;

/// Most characters of a cell: what is longer is not a number, and hardly a name.
pub const MOST_CHARACTERS: usize = 1000;
/// Characters of a cell that an error shows.
const SHOWN: usize = 40;

/// A fault of a table and its place.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct TableError {
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1.
    pub column: Option<usize>,
    /// Heading of that column; empty if there is none.
    pub heading: String,
    /// The fault.
    pub fault: Fault,
}

impl TableError {
    /// An error in a line.
    #[must_use]
    pub const fn new(line: usize, fault: Fault) -> Self {
        Self {
            line,
            column: None,
            heading: String::new(),
            fault,
        }
    }

    /// The same with its column, but without its line: `column 2 (x): 'one' is not a number`.
    #[must_use]
    pub fn what(&self) -> String {
        let Some(column) = self.column else {
            return self.fault.to_string();
        };
        if self.heading.is_empty() {
            format!("column {column}: {}", self.fault)
        } else {
            format!("column {column} ({}): {}", shown(&self.heading), self.fault)
        }
    }
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.what())
    }
}

/// Fault of a table.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// Bytes that are no text.
    #[error("the text is not UTF-8")]
    NotText,
    /// A quote that nothing closes on its line.
    #[error("a quote is opened and not closed on the line")]
    OpenQuote,
    /// A cell that is longer than any number or name.
    #[error("a cell has {characters} characters, more than {}", MOST_CHARACTERS)]
    LongCell {
        /// Its length.
        characters: usize,
    },
    /// More cells than the table has columns.
    #[error("{cells} columns, but the table has {columns}")]
    Wide {
        /// Cells of the line.
        cells: usize,
        /// Columns of the table.
        columns: usize,
    },
    /// Fewer cells than the table has columns.
    #[error("{cells} columns, but the table has {columns}")]
    Narrow {
        /// Cells of the line.
        cells: usize,
        /// Columns of the table.
        columns: usize,
    },
    /// A heading that the table cannot have.
    #[error("there is no column '{}'", shown(.name))]
    UnknownColumn {
        /// The heading.
        name: String,
    },
    /// A heading above two columns.
    #[error("two columns have the heading '{}'", shown(.name))]
    TwiceNamed {
        /// The heading.
        name: String,
    },
    /// A column that the table must have.
    #[error("the column '{name}' is missing")]
    MissingColumn {
        /// Its heading.
        name: String,
    },
    /// A cell without content.
    #[error("the cell is empty")]
    Missing,
    /// A cell that is no number.
    #[error("'{}' is not a number", shown(.cell))]
    NotANumber {
        /// The cell.
        cell: String,
    },
    /// NaN or infinity.
    #[error("'{}' is not finite", shown(.cell))]
    NotFinite {
        /// The cell.
        cell: String,
    },
    /// A number whose mark may be that of decimals or of thousands.
    #[error("'{}' has two readings: with decimals, or in thousands", shown(.cell))]
    TwoReadings {
        /// The cell.
        cell: String,
    },
}

impl Fault {
    /// Advice.
    #[must_use]
    pub const fn help(&self) -> &'static str {
        match self {
            Self::NotText => "save the table as CSV in UTF-8",
            Self::OpenQuote => "close the quote, or take it away; a cell is on one line",
            Self::LongCell { .. } => "shorten it; is this a table, and are its quotes closed?",
            Self::Wide { .. } => {
                "give every column a heading; write decimals with a point, or quote what has a separator in it"
            }
            Self::Narrow { .. } => "give every line all columns, or drop it",
            Self::UnknownColumn { .. } => "correct the heading, or delete the column",
            Self::TwiceNamed { .. } => "keep one of the two columns",
            Self::MissingColumn { .. } => "give the column, or correct the headings",
            Self::Missing => "fill it in, or drop the line",
            Self::NotANumber { .. } => {
                "correct it or drop the line; write 0.25, for example, without separators of thousands"
            }
            Self::NotFinite { .. } => "drop the line, or write 0.25, for example",
            Self::TwoReadings { .. } => {
                "write numbers with a decimal point, without separators of thousands"
            }
        }
    }
}

/// The beginning of a text for one line of an error.
#[must_use]
pub fn shown(text: &str) -> String {
    let mut letters = text.chars();
    let mut shown: String = letters
        .by_ref()
        .take(SHOWN)
        .map(|letter| if letter.is_control() { ' ' } else { letter })
        .collect();
    if letters.next().is_some() {
        shown.push('…');
    }
    shown
}
