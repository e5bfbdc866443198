//! Tables of strokes as takes.
//!
//! Columns t (s), x, y (table units, y down), pressure (0 to 1), and if there are any tilt x, tilt y
//! and twist (degrees), divided by white space or commas. A first line of words names the columns in
//! another order; lines that begin with `#` say nothing.

use std::path::Path;

use maulstick_rig::Fault;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};

use crate::take::{Take, TakeSample};

/// Names of the columns, the needed ones first.
const COLUMNS: [&str; 7] = ["t", "x", "y", "pressure", "tilt_x", "tilt_y", "twist"];
/// Columns that a table must have.
const NEEDED: usize = 4;
/// Steepest tilt, degrees.
const STEEPEST: f64 = 85.0;

/// How a table lies on the desk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableLayout {
    /// Length of a table unit, mm.
    pub unit_mm: f64,
    /// The tablet's area in table units; its middle becomes the desk's origin.
    pub size: [f64; 2],
}

impl Default for TableLayout {
    fn default() -> Self {
        Self {
            unit_mm: 0.25,
            size: [1024.0, 1024.0],
        }
    }
}

/// Where a column stands, by its number in [`COLUMNS`].
type Places = [Option<usize>; COLUMNS.len()];

/// Reads a table as a take of the device `device`.
///
/// # Errors
/// A [`Fault`] with the line and the column.
pub fn import(path: &Path, layout: TableLayout, device: &str) -> Result<Take, Fault> {
    let text = std::fs::read_to_string(path).map_err(|error| Fault::reading(path, &error))?;
    parse(&text, &path.display().to_string(), layout, device)
}

/// As [`import`], from a text that errors call `name`.
///
/// # Errors
/// A [`Fault`] with the line and the column.
pub fn parse(text: &str, name: &str, layout: TableLayout, device: &str) -> Result<Take, Fault> {
    let mut places: Option<Places> = None;
    let mut samples: Vec<TakeSample> = Vec::new();
    let mut start = None;
    let mut last = f64::NEG_INFINITY;
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
        let time = values[0];
        if time < last {
            let what = format!("time runs backward: {time} s after {last} s");
            return Err(Fault::usage(what).at(place).help("sort the table by time"));
        }
        let start = *start.get_or_insert(time);
        let sample = TakeSample {
            time_ns: ((time - start) * 1e9).round() as u64,
            sample: pen(&values, layout),
        };
        // Of samples of the same time the last one counts.
        if time == last {
            samples.pop();
        }
        last = time;
        samples.push(sample);
    }
    if samples.is_empty() {
        return Err(Fault::usage("the table holds no samples")
            .at(name)
            .help("each line is: t x y pressure [tilt_x tilt_y [twist]]"));
    }
    Ok(Take {
        kit: None,
        device: device.to_owned(),
        samples,
    })
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

    fn read(text: &str) -> Result<Take, Fault> {
        parse(text, "strokes.dat", TableLayout::default(), "table")
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
}
