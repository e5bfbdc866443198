//! Tables, their rows and headings.

use crate::dialect::{Cutter, Separator};
use crate::error::{Fault, MOST_CHARACTERS, TableError};
use crate::number::{Marks, is_number};
use crate::text::lines;

/// Role of a table's first line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeadingLine {
    /// It names the columns.
    First,
    /// It names the columns if none of its cells is a number.
    Words,
    /// It is a row like the others.
    Row,
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

/// A table: headings, rows and notes. Cells are without the blanks and quotes around them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    separator: Separator,
    marks: Marks,
    headings: Vec<String>,
    heading_line: Option<usize>,
    notes: Vec<Note>,
    rows: Vec<RowAt>,
    /// All cells, one behind the other.
    text: String,
    /// Ends of the cells in the text.
    ends: Vec<usize>,
    last_line: usize,
}

/// Place of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct RowAt {
    line: usize,
    block: usize,
    /// Number of its first cell.
    first: usize,
}

impl Table {
    /// Reads a table. Empty cells at the end of a line are dropped: spreadsheets pad lines with them.
    ///
    /// # Errors
    /// A [`TableError`] with the line for an open quote, a cell of more than [`MOST_CHARACTERS`], or a line with more cells
    /// than there are headings.
    pub fn parse(text: &str, heading: HeadingLine) -> Result<Self, TableError> {
        let text = text.trim_start_matches('\u{feff}');
        let separator = Separator::choose(contents(text).filter_map(|(_, line)| match line {
            Line::Cells(cells) => Some(cells),
            Line::Blank | Line::Comment(_) => None,
        }));
        let mut table = Self {
            separator,
            marks: Marks::default(),
            headings: Vec::new(),
            heading_line: None,
            notes: Vec::new(),
            rows: Vec::new(),
            text: String::new(),
            ends: Vec::new(),
            last_line: 1,
        };
        let (mut cutter, mut blanks) = (Cutter::new(separator), Vec::new());
        let mut blank = 0;
        for (line, content) in contents(text) {
            match content {
                Line::Comment(comment) => table.notes.extend(note(line, comment)),
                Line::Blank => {
                    blank += 1;
                    continue;
                }
                Line::Cells(cells) => {
                    table.add(line, cells, &mut cutter)?;
                    if table.rows.len() == 1 && table.heading_line.is_none() {
                        table.take_headings(heading);
                    }
                    if table.rows.len() > 1 {
                        blanks.push(blank);
                    }
                    blank = 0;
                }
            }
            table.last_line = line;
        }
        table.part(&blanks);
        table.see_marks();
        Ok(table)
    }

    /// Heading of each column; empty without a line of headings.
    #[must_use]
    pub fn headings(&self) -> &[String] {
        &self.headings
    }

    /// Where the headings stand, or the rows begin: the line, from 1.
    #[must_use]
    pub fn first_line(&self) -> usize {
        self.heading_line
            .or_else(|| self.rows.first().map(|row| row.line))
            .unwrap_or(self.last_line)
    }

    /// The last line of the text, from 1.
    #[must_use]
    pub const fn last_line(&self) -> usize {
        self.last_line
    }

    /// The notes, wherever they stand.
    #[must_use]
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// Separator of the cells.
    #[must_use]
    pub const fn separator(&self) -> Separator {
        self.separator
    }

    /// The rows below the headings.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = Row<'_>> + Clone {
        (0..self.rows.len()).map(|number| Row {
            table: self,
            number,
        })
    }

    /// The places of known columns by the headings, in any case; as they are in order for `count` cells without headings.
    ///
    /// # Errors
    /// A [`TableError`] for a heading that is not known, or that stands twice, or for more cells than known columns.
    pub fn columns<const N: usize>(
        &self,
        known: [&str; N],
    ) -> Result<[Option<usize>; N], TableError> {
        let mut places = [None; N];
        if self.heading_line.is_none() {
            let count = self.rows().next().map_or(0, |row| row.len());
            if count > N {
                let fault = Fault::Wide {
                    cells: count,
                    columns: N,
                };
                return Err(TableError::new(self.first_line(), fault));
            }
            return Ok(std::array::from_fn(|column| {
                (column < count).then_some(column)
            }));
        }
        for (at, heading) in self.headings.iter().enumerate() {
            let name = || heading.clone();
            let place = known
                .iter()
                .position(|known| known.eq_ignore_ascii_case(heading));
            let Some(place) = place else {
                return Err(self.fault(
                    self.first_line(),
                    at,
                    Fault::UnknownColumn { name: name() },
                ));
            };
            if places[place].replace(at).is_some() {
                return Err(self.fault(self.first_line(), at, Fault::TwiceNamed { name: name() }));
            }
        }
        Ok(places)
    }

    /// An error in a cell; the column is counted from 0.
    #[must_use]
    pub fn fault(&self, line: usize, column: usize, fault: Fault) -> TableError {
        TableError {
            line,
            column: Some(column + 1),
            heading: self.headings.get(column).cloned().unwrap_or_default(),
            fault,
        }
    }

    /// The number in a text of this table, such as a heading.
    ///
    /// # Errors
    /// A [`Fault`] where it is none, or has two readings.
    pub fn number(&self, cell: &str) -> Result<f64, Fault> {
        self.marks.read(cell)
    }

    fn add(&mut self, line: usize, cells: &str, cutter: &mut Cutter) -> Result<(), TableError> {
        let first = self.ends.len();
        let (text, ends) = (&mut self.text, &mut self.ends);
        let mut longest = (0, 0);
        let cut = cutter.cut(cells, |cell| {
            if cell.len() > MOST_CHARACTERS {
                longest = longest.max((cell.chars().count(), ends.len() - first));
            }
            text.push_str(cell);
            ends.push(text.len());
        });
        if cut.is_err() {
            return Err(TableError::new(line, Fault::OpenQuote));
        }
        let (characters, column) = longest;
        if characters > MOST_CHARACTERS {
            return Err(self.fault(line, column, Fault::LongCell { characters }));
        }
        while self.ends.len() > first + 1 && self.ends[self.ends.len() - 2] == self.text.len() {
            self.ends.pop();
        }
        let (cells, columns) = (self.ends.len() - first, self.headings.len());
        if self.heading_line.is_some() && cells > columns {
            return Err(self.fault(line, columns, Fault::Wide { cells, columns }));
        }
        self.rows.push(RowAt {
            line,
            block: 0,
            first,
        });
        Ok(())
    }

    /// Makes the first row the headings, if it is them.
    fn take_headings(&mut self, heading: HeadingLine) {
        let cells: Vec<String> = self
            .rows()
            .flat_map(|row| row.cells().map(str::to_owned))
            .collect();
        let is_heading = match heading {
            HeadingLine::First => true,
            HeadingLine::Words => !cells.iter().any(|cell| is_number(cell)),
            HeadingLine::Row => false,
        };
        if is_heading {
            self.headings = cells;
            self.heading_line = self.rows.pop().map(|row| row.line);
            self.text.clear();
            self.ends.clear();
        }
    }

    /// Parts the rows into blocks by the numbers of blank lines between them. Programs that end lines twice put one behind
    /// each row, which parts nothing.
    fn part(&mut self, blanks: &[usize]) {
        let usual = blanks.iter().min().copied().unwrap_or(0);
        let mut block = 0;
        for (row, blanks) in self.rows.iter_mut().skip(1).zip(blanks) {
            block += usize::from(*blanks > usual);
            row.block = block;
        }
    }

    fn see_marks(&mut self) {
        let mut marks = Marks::default();
        for row in self.rows() {
            row.cells().for_each(|cell| marks.see(cell));
        }
        self.headings.iter().for_each(|cell| marks.see(cell));
        self.marks = marks;
    }
}

/// A row of a table.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    table: &'a Table,
    number: usize,
}

impl<'a> Row<'a> {
    /// Its line, from 1.
    #[must_use]
    pub fn line(&self) -> usize {
        self.table.rows[self.number].line
    }

    /// The number of its block, from 0: blank lines part blocks.
    #[must_use]
    pub fn block(&self) -> usize {
        self.table.rows[self.number].block
    }

    /// Its cells without the empty ones at its end; one at least.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a row has a cell")]
    pub fn len(&self) -> usize {
        let next = self.table.rows.get(self.number + 1);
        next.map_or(self.table.ends.len(), |row| row.first) - self.table.rows[self.number].first
    }

    /// Its cells.
    pub fn cells(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        let row = *self;
        (0..row.len()).map(move |column| row.cell(column))
    }

    /// A cell; empty if the row ends before it. The column is counted from 0.
    #[must_use]
    pub fn cell(&self, column: usize) -> &'a str {
        if column >= self.len() {
            return "";
        }
        let at = self.table.rows[self.number].first + column;
        let begin = at
            .checked_sub(1)
            .map_or(0, |before| self.table.ends[before]);
        &self.table.text[begin..self.table.ends[at]]
    }

    /// The number in a cell. The column is counted from 0.
    ///
    /// # Errors
    /// A [`TableError`] where it is none, or not finite, or has two readings.
    pub fn number(&self, column: usize) -> Result<f64, TableError> {
        let number = self.table.marks.read(self.cell(column));
        number.map_err(|fault| self.fault(column, fault))
    }

    /// All of its numbers, of which there must be `N`.
    ///
    /// # Errors
    /// A [`TableError`] where there are more or fewer cells, or one is no number.
    pub fn numbers<const N: usize>(&self) -> Result<[f64; N], TableError> {
        let (cells, columns) = (self.len(), N);
        if cells != columns {
            let fault = if cells > columns {
                Fault::Wide { cells, columns }
            } else {
                Fault::Narrow { cells, columns }
            };
            return Err(TableError::new(self.line(), fault));
        }
        let mut numbers = [0.0; N];
        for (column, number) in numbers.iter_mut().enumerate() {
            *number = self.number(column)?;
        }
        Ok(numbers)
    }

    /// An error in a cell; the column is counted from 0.
    #[must_use]
    pub fn fault(&self, column: usize, fault: Fault) -> TableError {
        self.table.fault(self.line(), column, fault)
    }
}

/// Content of a line.
enum Line<'a> {
    Blank,
    Comment(&'a str),
    Cells(&'a str),
}

/// The lines of a text with their numbers, from 1.
fn contents(text: &str) -> impl Iterator<Item = (usize, Line<'_>)> {
    lines(text).enumerate().map(|(number, line)| {
        let content = match line.trim_start_matches(is_quote_or_blank).strip_prefix('#') {
            Some(comment) => Line::Comment(comment),
            None if line.trim_matches(is_blank).is_empty() => Line::Blank,
            None => Line::Cells(line),
        };
        (number + 1, content)
    })
}

fn is_quote_or_blank(letter: char) -> bool {
    letter == '"' || letter.is_whitespace()
}

fn is_blank(letter: char) -> bool {
    matches!(letter, ',' | ';' | '"') || letter.is_whitespace()
}

fn note(line: usize, comment: &str) -> Option<Note> {
    let comment = comment.trim_end_matches(is_blank);
    let (key, value) = comment.split_once(':')?;
    Some(Note {
        line,
        key: key.trim().to_lowercase(),
        value: value.trim().to_owned(),
    })
}
