//! Tables of strokes as takes.
//!
//! Columns t (s, or what `TimeUnit` says), x, y (table units, y down), pressure (0 to 1), and if there are any tilt x, tilt y
//! and twist (degrees), divided by white space or commas. A first line of words names the columns in
//! another order; lines that begin with `#` say nothing.

use std::path::Path;

use maulstick_brush::model::RESTART_NS;
use maulstick_rig::Fault;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, FARTHEST_M, StylusPose, StylusSample, axes};

use crate::take::{Take, TakeSample};

/// Names of the columns, the needed ones first.
const COLUMNS: [&str; 7] = ["t", "x", "y", "pressure", "tilt_x", "tilt_y", "twist"];
/// Columns that a table must have.
const NEEDED: usize = 4;
/// Steepest tilt, degrees.
const STEEPEST: f64 = 85.0;

/// Median times between samples of a stroke from which a unit of time is guessed, s: pens report 10 to 500
/// times a second.
const PEN_PERIODS_S: std::ops::RangeInclusive<f64> = 0.002..=0.1;

/// How a table lies on the desk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableLayout {
    /// Length of a table unit, mm.
    pub unit_mm: f64,
    /// The tablet's area in table units; its middle becomes the desk's origin.
    pub size: [f64; 2],
    /// Unit of the column t; guessed from the time between samples if absent.
    pub time_unit: Option<TimeUnit>,
}

impl Default for TableLayout {
    fn default() -> Self {
        Self {
            unit_mm: 0.25,
            size: [1024.0, 1024.0],
            time_unit: None,
        }
    }
}

/// Unit of the column t.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeUnit {
    /// Seconds.
    S,
    /// Milliseconds.
    Ms,
    /// Microseconds.
    Us,
    /// Nanoseconds.
    Ns,
}

impl TimeUnit {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::S, Self::Ms, Self::Us, Self::Ns];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::S => "s",
            Self::Ms => "ms",
            Self::Us => "us",
            Self::Ns => "ns",
        }
    }

    const fn ns(self) -> f64 {
        match self {
            Self::S => 1e9,
            Self::Ms => 1e6,
            Self::Us => 1e3,
            Self::Ns => 1.0,
        }
    }
}

impl std::str::FromStr for TimeUnit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|unit| unit.name() == text);
        known.ok_or_else(|| format!("'{text}' is no unit of time: s, ms, us or ns"))
    }
}

/// A table as a take.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The take.
    pub take: Take,
    /// What was guessed, and what of the table paints nothing: a sentence each.
    pub notes: Vec<String>,
}

/// Where a column stands, by its number in [`COLUMNS`].
type Places = [Option<usize>; COLUMNS.len()];

/// A sample as it stands in the table.
struct Row {
    line: usize,
    /// In the order of [`COLUMNS`]; NaN where there is none.
    values: [f64; COLUMNS.len()],
}

impl Row {
    fn touches(&self) -> bool {
        self.values[3] > 0.0
    }
}

/// Reads a table as a take of the device `device`.
///
/// # Errors
/// A [`Fault`] with the line and the column, and what to do.
pub fn import(path: &Path, layout: TableLayout, device: &str) -> Result<Imported, Fault> {
    let text = std::fs::read_to_string(path).map_err(|error| Fault::reading(path, &error))?;
    parse(&text, &path.display().to_string(), layout, device)
}

/// As [`import`], from a text that errors call `name`.
///
/// # Errors
/// A [`Fault`] with the line and the column, and what to do.
pub fn parse(text: &str, name: &str, layout: TableLayout, device: &str) -> Result<Imported, Fault> {
    let rows = rows(text, name)?;
    let Some(first) = rows.first() else {
        return Err(Fault::usage("the table holds no samples")
            .at(name)
            .help("each line is: t x y pressure [tilt_x tilt_y [twist]]"));
    };
    let mut notes = Vec::new();
    let unit = time_unit(&rows, name, layout, &mut notes)?;
    let start = first.values[0];
    let mut samples = Vec::with_capacity(rows.len());
    for row in &rows {
        let sample = pen(&row.values, layout);
        if sample.fault().is_some() {
            return Err(too_far(row, &rows, name, layout));
        }
        samples.push(TakeSample {
            time_ns: ((row.values[0] - start) * unit.ns()).round() as u64,
            sample,
        });
    }
    notes.extend(unpainted(&rows, &samples, layout));
    Ok(Imported {
        take: Take {
            kit: None,
            device: device.to_owned(),
            samples,
        },
        notes,
    })
}

/// The rows, of those of the same time the last.
fn rows(text: &str, name: &str) -> Result<Vec<Row>, Fault> {
    let mut places: Option<Places> = None;
    let mut rows: Vec<Row> = Vec::new();
    // Spreadsheets begin a table with a byte order mark.
    let text = text.trim_start_matches('\u{feff}');
    for (line, row) in text.lines().enumerate().map(|(i, row)| (i + 1, row.trim())) {
        if row.is_empty() || row.starts_with('#') {
            continue;
        }
        let place = format!("{name}:{line}");
        let cells: Vec<&str> = row
            .split([',', ' ', '\t', ';'])
            .filter(|cell| !cell.is_empty())
            .collect();
        let columns = match places {
            Some(columns) => columns,
            None => {
                let words = cells
                    .iter()
                    .any(|cell| COLUMNS.contains(&cell.to_lowercase().as_str()));
                let columns = if words {
                    header(&cells, &place)?
                } else {
                    in_order(cells.len())
                };
                places = Some(columns);
                if words {
                    continue;
                }
                columns
            }
        };
        let values = numbers(&cells, &columns, &place)?;
        let last = rows.last().map_or(f64::NEG_INFINITY, |row| row.values[0]);
        if values[0] < last {
            let what = format!("time runs backward: {} after {last}", values[0]);
            return Err(Fault::usage(what).at(place).help("sort the table by time"));
        }
        if values[0] == last {
            rows.pop();
        }
        rows.push(Row { line, values });
    }
    Ok(rows)
}

/// The unit of the column t: as given, or such that a pen's samples lie as far apart as pens report them.
fn time_unit(
    rows: &[Row],
    name: &str,
    layout: TableLayout,
    notes: &mut Vec<String>,
) -> Result<TimeUnit, Fault> {
    let pairs = rows
        .windows(2)
        .filter(|two| two[0].touches() && two[1].touches());
    let mut steps: Vec<f64> = pairs
        .map(|two| two[1].values[0] - two[0].values[0])
        .collect();
    let given = layout.time_unit;
    if steps.is_empty() {
        return Ok(given.unwrap_or(TimeUnit::S));
    }
    let middle = steps.len() / 2;
    let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    let median = *median;
    let seconds = |unit: TimeUnit| median * unit.ns() * 1e-9;
    let longest = *PEN_PERIODS_S.end();
    if seconds(given.unwrap_or(TimeUnit::S)) <= longest {
        return Ok(given.unwrap_or(TimeUnit::S));
    }
    let fits = |unit: &TimeUnit| PEN_PERIODS_S.contains(&seconds(*unit));
    if let (None, Some(unit)) = (given, TimeUnit::ALL.into_iter().find(fits)) {
        notes.push(format!(
            "t is taken to be in {}: samples of a stroke lie {median} apart (--time-unit s says otherwise)",
            unit.name()
        ));
        return Ok(unit);
    }
    let apart = seconds(given.unwrap_or(TimeUnit::S));
    Err(Fault::usage(format!(
        "samples of a stroke lie {apart} s apart; nothing is painted over more than {longest} s"
    ))
    .at(name)
    .help("give the unit of t by --time-unit ms, us or ns, or sample the strokes at 10 Hz or more"))
}

/// Why a point is out of reach.
fn too_far(row: &Row, rows: &[Row], name: &str, layout: TableLayout) -> Fault {
    let most = |column: usize| {
        rows.iter()
            .map(|row| row.values[column])
            .fold(0.0, f64::max)
            .ceil()
    };
    let (x, y) = (row.values[1], row.values[2]);
    Fault::usage(format!(
        "({x}, {y}) lies more than {FARTHEST_M} m from the middle of the desk, at {} mm a unit",
        layout.unit_mm
    ))
    .at(format!("{name}:{}", row.line))
    .help(format!(
        "raw tablet units? give the tablet's area and unit: --size {}x{} --unit-mm 0.005 (200 a mm) or as it is",
        most(1),
        most(2)
    ))
}

/// What of a table paints nothing.
fn unpainted(rows: &[Row], samples: &[TakeSample], layout: TableLayout) -> Vec<String> {
    let mut notes = Vec::new();
    let outside = |row: &&Row| {
        let within = |axis: usize| (0.0..=layout.size[axis]).contains(&row.values[1 + axis]);
        !(within(0) && within(1))
    };
    let beyond = rows.iter().filter(outside).count();
    if beyond > 0 {
        let [width, height] = layout.size;
        notes.push(format!(
            "{beyond} of {} samples lie outside of {width}x{height} units: give the tablet's area by --size",
            rows.len()
        ));
    }
    let touching = |i: &usize| rows[i - 1].touches() && rows[*i].touches();
    let pairs: Vec<usize> = (1..rows.len()).filter(touching).collect();
    if pairs.is_empty() {
        notes.push("no two samples in a row have pressure, so the take paints nothing".into());
    }
    let torn = |i: &&usize| samples[**i].time_ns - samples[**i - 1].time_ns > RESTART_NS;
    let torn: Vec<usize> = pairs.iter().filter(torn).copied().collect();
    if let Some(first) = torn.first() {
        notes.push(format!(
            "line {}: the sample before is more than {} s older, as in {} places: nothing is painted between",
            rows[*first].line,
            RESTART_NS as f64 * 1e-9,
            torn.len()
        ));
    }
    notes
}

fn in_order(count: usize) -> Places {
    std::array::from_fn(|column| (column < count).then_some(column))
}

/// The places of the columns that a header names.
fn header(cells: &[&str], place: &str) -> Result<Places, Fault> {
    let mut places = [None; COLUMNS.len()];
    for (at, cell) in cells.iter().enumerate() {
        let word = cell.to_lowercase();
        match COLUMNS.iter().position(|column| *column == word) {
            Some(column) => places[column] = Some(at),
            None => {
                let what = format!("there is no column '{cell}'");
                return Err(Fault::unknown(what, &word, COLUMNS).at(place));
            }
        }
    }
    Ok(places)
}

/// The numbers of a row in the order of [`COLUMNS`]; what is missing and not needed is NaN.
fn numbers(cells: &[&str], places: &Places, place: &str) -> Result<[f64; 7], Fault> {
    let mut values = [f64::NAN; COLUMNS.len()];
    for (column, value) in values.iter_mut().enumerate() {
        let fault = |what: String| Fault::usage(what).at(place);
        let Some(cell) = places[column].and_then(|at| cells.get(at)) else {
            if column < NEEDED || (places[column].is_some()) {
                let what = format!("column {} ({}) is missing", column + 1, COLUMNS[column]);
                return Err(
                    fault(what).help("each line is: t x y pressure [tilt_x tilt_y [twist]]")
                );
            }
            continue;
        };
        let where_ = format!("column {} ({})", column + 1, COLUMNS[column]);
        let number: f64 = cell.parse().map_err(|_| {
            fault(format!("{where_}: '{cell}' is not a number")).help("correct it or drop the line")
        })?;
        if !number.is_finite() {
            return Err(fault(format!("{where_}: '{cell}' is not finite")).help("drop the line"));
        }
        let range = match column {
            3 => Some((0.0, 1.0)),
            4 | 5 => Some((-STEEPEST, STEEPEST)),
            _ => None,
        };
        if let Some((low, high)) = range
            && !(low..=high).contains(&number)
        {
            return Err(
                fault(format!("{where_}: {number} is not within {low} and {high}"))
                    .help("scale the column"),
            );
        }
        *value = number;
    }
    Ok(values)
}

fn pen(values: &[f64; 7], layout: TableLayout) -> StylusSample {
    let [_, x, y, pressure, tilt_x, tilt_y, twist] = *values;
    let unit_m = layout.unit_mm * 1e-3;
    let mut senses = axes::POSITION | axes::PRESSURE | axes::PROXIMITY;
    let mut tilt_rad = DEFAULT_TILT_RAD;
    if !tilt_x.is_nan() && !tilt_y.is_nan() {
        senses |= axes::TILT;
        // The table's y points down, and with it the tilt about x.
        tilt_rad = [tilt_x.to_radians(), -tilt_y.to_radians()];
    }
    let mut twist_rad = 0.0;
    if !twist.is_nan() {
        senses |= axes::TWIST;
        twist_rad = twist.to_radians();
    }
    StylusSample {
        senses,
        pose: StylusPose::Contact {
            point_m: [
                (x - 0.5 * layout.size[0]) * unit_m,
                (0.5 * layout.size[1] - y) * unit_m,
                0.0,
            ],
            tilt_rad,
            twist_rad,
            pressure,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn imported(text: &str) -> Result<Imported, Fault> {
        parse(text, "strokes.dat", TableLayout::default(), "table")
    }

    fn read(text: &str) -> Result<Take, Fault> {
        imported(text).map(|imported| imported.take)
    }

    fn fault(text: &str) -> String {
        read(text).expect_err(text).to_string()
    }

    #[test]
    fn the_middle_is_the_origin_and_y_is_flipped() {
        let take = read("5.0 512 512 0\n5.008 516 508 0.5\n").expect("a take");
        assert_eq!(take.samples[1].time_ns, 8_000_000);
        let point = |i: usize| match take.samples[i].sample.pose {
            StylusPose::Contact { point_m, .. } => point_m,
            StylusPose::Ferrule { .. } => panic!("a pen"),
        };
        assert_eq!(point(0), [0.0; 3]);
        assert!((point(1)[0] - 1e-3).abs() < 1e-15 && (point(1)[1] - 1e-3).abs() < 1e-15);
    }

    #[test]
    fn tilt_twist_commas_and_headers_are_read() {
        let take = read("# by hand\npressure,t,x,y,tilt_x,tilt_y\n0.5,0,1,2,10,20\n").expect("one");
        match &take.samples[0].sample.pose {
            StylusPose::Contact {
                tilt_rad, pressure, ..
            } => {
                assert_eq!(*pressure, 0.5);
                assert!((tilt_rad[0].to_degrees() - 10.0).abs() < 1e-9);
                assert!((tilt_rad[1].to_degrees() + 20.0).abs() < 1e-9);
            }
            StylusPose::Ferrule { .. } => panic!("a pen"),
        }
        assert_ne!(take.samples[0].sample.senses & axes::TILT, 0);
    }

    #[test]
    fn bad_tables_name_line_and_column() {
        let good = "0 1 1 0\n";
        let text = fault(&format!("{good}0.1 1 1\n"));
        assert!(
            text.contains("strokes.dat:2") && text.contains("pressure) is missing"),
            "{text}"
        );
        let text = fault(&format!("{good}0.1 one 1 0\n"));
        assert!(
            text.contains("column 2 (x): 'one' is not a number"),
            "{text}"
        );
        assert!(fault(&format!("{good}0.1 1 1 NaN\n")).contains("'NaN' is not finite"));
        assert!(fault(&format!("{good}-1 1 1 0\n")).contains("time runs backward"));
        assert!(fault("0 1 1 1.5\n").contains("1.5 is not within 0 and 1"));
        assert!(fault("0 1 1 1 89 0\n").contains("tilt_x"));
        assert!(fault("t x y presure\n0 1 1 1\n").contains("'pressure'"));
        assert!(fault("# nothing\n").contains("no samples"));
    }

    #[test]
    fn of_two_samples_of_a_time_the_last_counts() {
        let take = read("0 1 1 0\n0 2 2 0\n0.1 3 3 0\n").expect("a take");
        assert_eq!(take.samples.len(), 2);
    }

    /// Twenty samples of a stroke, `step` apart.
    fn stroke(step: f64) -> String {
        let row = |i: u32| format!("{} {} 512 0.5\n", step * f64::from(i), 400 + i);
        (0..20).map(row).collect()
    }

    #[test]
    fn a_byte_order_mark_is_passed_over() {
        assert_eq!(
            read("\u{feff}0 1 1 0\n0.1 3 3 0\n")
                .expect("a take")
                .samples
                .len(),
            2
        );
        assert!(read("\u{feff}t,x,y,pressure\n0,1,1,0\n").is_ok());
    }

    #[test]
    fn a_unit_of_time_is_guessed_only_where_it_is_safe() {
        for (step, unit) in [(8.0, "ms"), (16.7, "ms"), (8000.0, "us"), (8e6, "ns")] {
            let imported = imported(&stroke(step)).expect("a take");
            let [note] = imported.notes.as_slice() else {
                panic!("{step}: {:?}", imported.notes);
            };
            assert!(note.contains(&format!("in {unit}:")), "{note}");
            let period = imported.take.samples[1].time_ns;
            assert!(
                (5_000_000..20_000_000).contains(&period),
                "{step}: {period}"
            );
        }
        assert!(imported(&stroke(0.008)).expect("seconds").notes.is_empty());
        // An index, or a second a sample; a polyline by hand; 5 Hz.
        for step in [1.0, 0.2, 0.15, 500.0, 1e4 * 15.0] {
            let said = fault(&stroke(step));
            assert!(
                said.contains("apart") && said.contains("--time-unit"),
                "{step}: {said}"
            );
        }
        let layout = TableLayout {
            time_unit: Some(TimeUnit::Ms),
            ..TableLayout::default()
        };
        let read = |step| parse(&stroke(step), "a", layout, "table");
        assert_eq!(
            read(1.0).expect("a take").take.samples[1].time_ns,
            1_000_000
        );
        assert!(read(200.0).is_err());
    }

    #[test]
    fn raw_tablet_units_are_refused_with_the_options_that_fit() {
        let said = fault("0 100 100 0.5\n0.008 44000 27900.2 0.5\n");
        for part in ["strokes.dat:2", "10 m", "--size 44000x27901", "--unit-mm"] {
            assert!(said.contains(part), "{said}");
        }
        let note = &imported("0 100 100 0.5\n0.008 2000 900 0.5\n")
            .expect("near")
            .notes[0];
        assert!(note.contains("1 of 2") && note.contains("--size"), "{note}");
    }

    #[test]
    fn what_paints_nothing_is_said() {
        let gap = format!("{}1 420 512 0.5\n1.008 421 512 0.5\n", stroke(0.008));
        let notes = imported(&gap).expect("a take").notes;
        assert!(
            notes[0].contains("line 21") && notes[0].contains("0.1 s"),
            "{notes:?}"
        );
        let notes = imported("0 1 1 0\n0.1 2 2 0\n").expect("a take").notes;
        assert!(notes[0].contains("paints nothing"), "{notes:?}");
        // The pen is lifted in between.
        let lifted = format!("{}0.2 420 512 0\n1 420 512 0.5\n", stroke(0.008));
        assert!(imported(&lifted).expect("a take").notes.is_empty());
    }
}
