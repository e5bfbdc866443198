//! Tables of measurements: headings, and rows below them.

use std::ops::Deref;

use maulstick_tables::{HeadingLine, TableError};

use crate::error::{MeasureError, Place};

/// A table whose first line names its columns, with a row at least.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table(maulstick_tables::Table);

impl Table {
    /// Reads a table.
    ///
    /// # Errors
    /// As [`maulstick_tables::Table::parse`], and for a table without headings or rows.
    pub fn parse(text: &str) -> Result<Self, MeasureError> {
        let table = maulstick_tables::Table::parse(text, HeadingLine::First)?;
        if table.headings().is_empty() {
            let help = "the first line names the columns, as in: sample,Titanium White,380,390,…";
            return Err(MeasureError::new("the file holds no table", help).line(1));
        }
        if table.rows().len() == 0 {
            let what = "there are no measurements below the headings";
            let help = "give a row for each reading";
            return Err(MeasureError::new(what, help).line(table.first_line()));
        }
        Ok(Self(table))
    }

    /// An error in a cell of this table; the column is counted from 0.
    #[must_use]
    pub fn fault(
        &self,
        line: usize,
        column: usize,
        what: impl Into<String>,
        help: &str,
    ) -> MeasureError {
        let heading = self.headings().get(column).map_or("", String::as_str);
        MeasureError::new(what, help)
            .line(line)
            .column(column, heading)
    }
}

impl Deref for Table {
    type Target = maulstick_tables::Table;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl From<TableError> for MeasureError {
    fn from(error: TableError) -> Self {
        Self {
            what: error.fault.to_string(),
            help: error.fault.help().to_owned(),
            place: Place {
                line: Some(error.line),
                column: error.column,
                heading: maulstick_tables::shown(&error.heading),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_headings_and_rows() {
        let error = |text: &str| Table::parse(text).expect_err("bad").place.line;
        assert_eq!(error("# x\n"), Some(1));
        assert_eq!(error("# x\na,b\n"), Some(2));
        assert_eq!(error("a,b\n\n1,2,3\n"), Some(3));
        assert!(Table::parse("a,b\n1\n").is_ok());
    }
}
