//! Columns of a table of strokes, and the numbers in its rows.

use maulstick_rig::UserError;
use maulstick_rig::table_file::table_fault;
use maulstick_tables::{Fault, HeadingLine, Table, TableError};

use super::STEEPEST_TILT_DEG;
use super::note::Note;

/// Names of the columns, the needed ones first.
const COLUMNS: [&str; 8] = [
    "t", "x", "y", "pressure", "tilt_x", "tilt_y", "twist", "stroke",
];
/// Columns that a table must have.
const NEEDED: usize = 4;
/// Columns with numbers.
const NUMBERS: usize = 7;
const PRESSURE: usize = 3;
const TILTS: [usize; 2] = [4, 5];
const STROKE: usize = 7;
/// Steepest tilt of a pen, degrees.
const FLAT: f64 = 90.0;
/// Rounding of a number in a table.
const ROUNDING: f64 = 1e-3;
/// Columns of a table without headings.
const LINE: &str = "each line is: t x y pressure [tilt_x tilt_y [twist]]";

/// A sample as it stands in the table.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) line: usize,
    /// In the order of the columns up to the twist; NaN if absent.
    pub(super) values: [f64; NUMBERS],
    /// The stroke that it is of, counted up from 0.
    pub(super) stroke: usize,
}

impl Row {
    pub(super) fn touches(&self) -> bool {
        self.values[PRESSURE] > 0.0
    }

    /// True if paint is laid from it to the next row.
    pub(super) fn paints_to(&self, next: &Self) -> bool {
        self.touches() && next.touches() && self.stroke == next.stroke
    }

    /// Time, in the table's unit.
    pub(super) fn time(&self) -> f64 {
        self.values[0]
    }
}

/// The rows of a table; what was rounded into its range is noted. Of a stroke they are for their lines and the column
/// `stroke`.
pub(super) fn rows(text: &str, name: &str, notes: &mut Vec<Note>) -> Result<Vec<Row>, UserError> {
    let fault = |error: TableError| match &error.fault {
        Fault::UnknownColumn { name: heading } => {
            let word = heading.to_lowercase();
            let place = format!("{name}:{}", error.line);
            UserError::unknown(error.fault.to_string(), &word, COLUMNS).at(place)
        }
        Fault::MissingColumn { .. } | Fault::Narrow { .. } => table_fault(name, &error).help(LINE),
        _ => table_fault(name, &error),
    };
    let table = Table::parse(text, HeadingLine::Words).map_err(fault)?;
    if table.rows().len() == 0 {
        return Err(UserError::usage("the table holds no samples")
            .at(name)
            .help(LINE));
    }
    let places = places(&table, name, fault)?;
    let mut limits = Limits::default();
    let mut rows: Vec<Row> = Vec::with_capacity(table.rows().len());
    let (mut block, mut named) = (0, "");
    let columns = table.rows().next().map_or(0, |row| row.len());
    for row in table.rows() {
        if table.headings().is_empty() && row.len() != columns {
            let cells = row.len();
            let what = if cells < columns {
                Fault::Narrow { cells, columns }
            } else {
                Fault::Wide { cells, columns }
            };
            return Err(fault(TableError::new(row.line(), what)));
        }
        let mut values = [f64::NAN; NUMBERS];
        for (column, value) in values.iter_mut().enumerate() {
            let Some(at) = places[column] else {
                continue;
            };
            let number = row.number(at).map_err(fault)?;
            *value = limits.within(column, number).map_err(|(low, high)| {
                let what = format!("{number} is not within {low} and {high}");
                UserError::usage(format!("column {} ({}): {what}", at + 1, COLUMNS[column]))
                    .at(format!("{name}:{}", row.line()))
                    .help("scale the column")
            })?;
        }
        let label = places[STROKE].map_or("", |at| row.cell(at));
        let stroke = match rows.last() {
            Some(last) if (row.block(), label) == (block, named) => last.stroke,
            Some(last) => last.stroke + 1,
            None => 0,
        };
        (block, named) = (row.block(), label);
        rows.push(Row {
            line: row.line(),
            values,
            stroke,
        });
    }
    notes.extend(limits.notes());
    Ok(rows)
}

/// Where each column is.
type Places = [Option<usize>; COLUMNS.len()];

fn places(
    table: &Table,
    name: &str,
    fault: impl Fn(TableError) -> UserError,
) -> Result<Places, UserError> {
    let places = table.columns(COLUMNS).map_err(&fault)?;
    let count = table.rows().next().map_or(0, |row| row.len());
    if table.headings().is_empty() && count > NEEDED && ![NEEDED + 2, NUMBERS].contains(&count) {
        let what =
            format!("{count} columns without headings: the meaning of the last one is not known");
        return Err(UserError::usage(what)
            .at(format!("{name}:{}", table.first_line()))
            .help("name the columns in a first line, as in: t,x,y,pressure,stroke"));
    }
    let is_lost = |column: &usize| places[*column].is_none();
    let needed = (0..NEEDED).find(is_lost);
    // A tilt about one axis alone is none.
    let tilts: Vec<usize> = TILTS.into_iter().filter(is_lost).collect();
    let lost = needed.or((tilts.len() == 1).then(|| tilts[0]));
    match lost {
        Some(column) => Err(fault(TableError::new(
            table.first_line(),
            Fault::MissingColumn {
                name: COLUMNS[column].to_owned(),
            },
        ))),
        None => Ok(places),
    }
}

/// Numbers that were a little outside of their range.
#[derive(Clone, Copy, Debug, Default)]
struct Limits {
    pressures: usize,
    tilts: usize,
}

impl Limits {
    /// A number of a column as it is used, or the range that it must lie within.
    fn within(&mut self, column: usize, number: f64) -> Result<f64, (f64, f64)> {
        let (used, given, count) = match column {
            PRESSURE => ((0.0, 1.0), (0.0, 1.0), &mut self.pressures),
            _ if TILTS.contains(&column) => (
                (-STEEPEST_TILT_DEG, STEEPEST_TILT_DEG),
                (-FLAT, FLAT),
                &mut self.tilts,
            ),
            _ => return Ok(number),
        };
        if !(given.0 - ROUNDING..=given.1 + ROUNDING).contains(&number) {
            return Err(given);
        }
        let within = number.clamp(used.0, used.1);
        *count += usize::from(within != number);
        Ok(within)
    }

    fn notes(self) -> impl Iterator<Item = Note> {
        let pressures = (self.pressures > 0).then_some(Note::Pressures(self.pressures));
        let tilts = (self.tilts > 0).then_some(Note::Tilts(self.tilts));
        pressures.into_iter().chain(tilts)
    }
}
