//! A table as a spreadsheet writes it: separated by commas, semicolons or tabs, with notes.
//!
//! A line that begins with `#` is a comment; `# key: value` is a note. Spreadsheets that separate by
//! semicolons write decimal commas, pad lines with empty cells and put quotes round what holds a
//! separator: all of that is read.

use crate::error::MeasureError;

/// Headings, rows and notes of a file, as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// What stands above each column.
    pub headings: Vec<String>,
    /// Where the headings stand, from 1.
    pub heading_line: usize,
    /// The rows below.
    pub rows: Vec<Row>,
    /// The notes, wherever they stand.
    pub notes: Vec<Note>,
    decimal_comma: bool,
}

/// A row, with as many cells as there are headings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Its line, from 1.
    pub line: usize,
    /// Its cells without surrounding blanks and quotes.
    pub cells: Vec<String>,
}

/// `# key: value`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// Its line, from 1.
    pub line: usize,
    /// The key in lower case.
    pub key: String,
    /// The value.
    pub value: String,
}

impl Table {
    /// Reads a table.
    ///
    /// # Errors
    /// Where a row has more cells than there are headings, or there are no headings or no rows.
    pub fn parse(text: &str) -> Result<Self, MeasureError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut notes = Vec::new();
        let mut found: Option<Self> = None;
        let mut separator = ',';
        for (line, row) in text.lines().enumerate().map(|(i, row)| (i + 1, row.trim())) {
            if let Some(comment) = row.trim_start_matches('"').strip_prefix('#') {
                notes.extend(note(line, comment));
                continue;
            }
            let blank = |c: char| matches!(c, ',' | ';' | '\t' | ' ');
            if row.trim_matches(blank).is_empty() {
                continue;
            }
            let Some(table) = &mut found else {
                separator = separator_of(row);
                let mut headings = cells(row, separator);
                while headings.last().is_some_and(String::is_empty) {
                    headings.pop();
                }
                found = Some(Self {
                    headings,
                    heading_line: line,
                    rows: Vec::new(),
                    notes: Vec::new(),
                    decimal_comma: separator != ',',
                });
                continue;
            };
            let mut cells = cells(row, separator);
            let width = table.headings.len();
            while cells.len() > width && cells.last().is_some_and(String::is_empty) {
                cells.pop();
            }
            if cells.len() > width {
                let what = format!("{} cells under {width} headings", cells.len());
                let help = "give every column a heading; write decimals with a point";
                return Err(MeasureError::new(what, help).line(line).column(width, ""));
            }
            cells.resize(width, String::new());
            table.rows.push(Row { line, cells });
        }
        let help = "the first line names the columns, as in: sample,Titanium White,380,390,…";
        let mut table =
            found.ok_or_else(|| MeasureError::new("the file holds no table", help).line(1))?;
        if table.rows.is_empty() {
            let what = "there are no measurements below the headings";
            return Err(
                MeasureError::new(what, "give a row for each reading").line(table.heading_line)
            );
        }
        table.notes = notes;
        Ok(table)
    }

    /// The number in a cell; `None` where the cell is none.
    #[must_use]
    pub fn number(&self, cell: &str) -> Option<f64> {
        let number = if self.decimal_comma {
            cell.replace(',', ".").parse::<f64>()
        } else {
            cell.parse::<f64>()
        };
        number.ok().filter(|number| number.is_finite())
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
        MeasureError::new(what, help)
            .line(line)
            .column(column, self.headings.get(column).map_or("", String::as_str))
    }
}

fn note(line: usize, comment: &str) -> Option<Note> {
    let comment = comment.trim_end_matches([',', ';', '\t', ' ', '"']);
    let (key, value) = comment.split_once(':')?;
    Some(Note {
        line,
        key: key.trim().to_lowercase(),
        value: value.trim().to_owned(),
    })
}

/// Whichever of the separators stands most often in the headings.
fn separator_of(headings: &str) -> char {
    let count = |separator: char| headings.chars().filter(|c| *c == separator).count();
    [',', ';', '\t']
        .into_iter()
        .rev()
        .max_by_key(|separator| count(*separator))
        .unwrap_or(',')
}

/// Cells of a line; within quotes a separator is text and two quotes are one.
fn cells(row: &str, separator: char) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut letters = row.chars().peekable();
    while let Some(letter) = letters.next() {
        let last = cells.len() - 1;
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                cells[last].push('"');
            }
            '"' => quoted = !quoted,
            _ if letter == separator && !quoted => cells.push(String::new()),
            _ => cells[last].push(letter),
        }
    }
    for cell in &mut cells {
        *cell = cell.trim().to_owned();
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spreadsheet_of_any_country_is_read() {
        let plain = "# surface: 0.03, 0.65\nsample,White,380\n\"a, b\",1,0.5\n,,\n";
        let other = "\u{feff}\"# surface: 0.03, 0.65\";;\r\nsample;White;380\r\n\"a, b\";1;0,5\r\n";
        let tabs = "# surface: 0.03, 0.65\nsample\tWhite\t380\na, b\t1\t0.5\n";
        for text in [plain, other, tabs] {
            let table = Table::parse(text).expect("a table");
            assert_eq!(table.headings, ["sample", "White", "380"]);
            assert_eq!(table.rows[0].cells[0], "a, b");
            assert_eq!(table.number(&table.rows[0].cells[2]), Some(0.5));
            assert_eq!(table.notes[0].key, "surface");
            assert_eq!(table.notes[0].value, "0.03, 0.65");
        }
    }

    #[test]
    fn quotes_count_after_blanks_too() {
        let text = "sample, White, 380\n \"a, b\", 1, 0.5\nx, \"d, \"\"e\"\"\", 1\n";
        let table = Table::parse(text).expect("a table");
        assert_eq!(table.rows[0].cells, ["a, b", "1", "0.5"]);
        assert_eq!(table.rows[1].cells, ["x", "d, \"e\"", "1"]);
    }

    #[test]
    fn short_rows_are_filled_and_long_ones_refused() {
        let table = Table::parse("a,b,c\n1,2\n1,2,3,,\n").expect("a table");
        assert_eq!(table.rows[0].cells, ["1", "2", ""]);
        assert_eq!(table.rows[1].cells.len(), 3);
        let error = |text: &str| Table::parse(text).expect_err("bad").to_string();
        assert_eq!(
            error("a,b\n\n1,2,3"),
            "line 3, column 3: 3 cells under 2 headings"
        );
        assert_eq!(error("# x\n"), "line 1: the file holds no table");
        assert!(error("a,b\n").starts_with("line 1: there are no measurements"));
        assert_eq!(table.number("NaN"), None);
    }
}
