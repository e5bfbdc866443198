//! Tables of strokes as takes.
//!
//! Columns t (s, or what `TimeUnit` says), x, y (table units, y down), pressure (0 to 1), and if there are any tilt x, tilt y
//! and twist (degrees), and the stroke, as [`maulstick_tables`] reads them. A first line of words names the columns in another
//! order. An empty line, another value in the column `stroke`, and time that begins anew begin another stroke.

mod columns;
mod note;
mod strokes;

use std::path::Path;

use maulstick_brush::model::BRIDGED_NS;
use maulstick_rig::UserError;
use maulstick_rig::table_file::{MOST_BYTES, read_table};
use maulstick_types::limits::FARTHEST_M;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};

use columns::Row;

use crate::take::{Take, TakeSample};
pub use note::Note;

/// Median times between samples of a stroke from which a unit of time is guessed, s: pens report 10 to 500
/// times a second.
const PEN_PERIODS_S: std::ops::RangeInclusive<f64> = 0.002..=0.1;

/// Steepest tilt that a brush is held at, degrees.
const STEEPEST_TILT_DEG: f64 = 85.0;
/// Shortest time between strokes, ns: contacts that are less far apart are one stroke to a brush.
const PAUSE_NS: f64 = 200e6;

/// Layout of a table on the desk.
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

/// A text that is not a unit of time.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is not a unit of time: s, ms, us or ns")]
pub struct TimeUnitError(pub String);

impl std::str::FromStr for TimeUnit {
    type Err = TimeUnitError;

    fn from_str(text: &str) -> Result<Self, TimeUnitError> {
        let known = Self::ALL.into_iter().find(|unit| unit.name() == text);
        known.ok_or_else(|| TimeUnitError(text.to_owned()))
    }
}

/// A table as a take.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The take.
    pub take: Take,
    /// Guesses, and parts of the table that paint nothing.
    pub notes: Vec<Note>,
}

/// Reads a table as a take of the device `device`.
///
/// # Errors
/// A [`UserError`] with the line and the column, and what to do.
pub fn import(path: &Path, layout: TableLayout, device: &str) -> Result<Imported, UserError> {
    let text = read_table(path, MOST_BYTES)?;
    parse(&text, &path.display().to_string(), layout, device)
}

/// As [`import`], from a text that errors call `name`.
///
/// # Errors
/// A [`UserError`] with the line and the column, and what to do.
pub fn parse(
    text: &str,
    name: &str,
    layout: TableLayout,
    device: &str,
) -> Result<Imported, UserError> {
    let mut notes = Vec::new();
    let mut rows = columns::rows(text, name, &mut notes)?;
    strokes::part(&mut rows, name)?;
    strokes::spread(&mut rows, name, &mut notes)?;
    let unit = time_unit(&rows, name, layout, &mut notes)?;
    let times_ns = strokes::times_ns(&rows, unit.ns(), name, &mut notes)?;
    let mut samples = Vec::with_capacity(rows.len());
    for (row, time_ns) in rows.iter().zip(&times_ns) {
        let sample = pen(&row.values, layout);
        if sample.fault().is_some() {
            return Err(too_far(row, &rows, name, layout));
        }
        samples.push(TakeSample {
            time_ns: *time_ns,
            sample,
        });
    }
    notes.extend(unpainted(&rows, &times_ns, layout));
    Ok(Imported {
        take: Take {
            setup: None,
            device: device.to_owned(),
            samples: strokes::lifted(&rows, samples),
        },
        notes,
    })
}

/// The unit of the column t: as given, or such that a pen's samples lie as far apart as pens report them.
fn time_unit(
    rows: &[Row],
    name: &str,
    layout: TableLayout,
    notes: &mut Vec<Note>,
) -> Result<TimeUnit, UserError> {
    let pairs = rows.windows(2).filter(|two| two[0].paints_to(&two[1]));
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
        notes.push(Note::Unit { unit, median });
        return Ok(unit);
    }
    let apart = seconds(given.unwrap_or(TimeUnit::S));
    Err(UserError::usage(format!(
        "samples of a stroke lie {apart} s apart; nothing is painted over more than {longest} s"
    ))
    .at(name)
    .help("give the unit of t by --time-unit ms, us or ns, or sample the strokes at 10 Hz or more"))
}

/// The error that a point is out of reach.
fn too_far(row: &Row, rows: &[Row], name: &str, layout: TableLayout) -> UserError {
    let most = |column: usize| {
        rows.iter()
            .map(|row| row.values[column])
            .fold(0.0, f64::max)
            .ceil()
    };
    let (x, y) = (row.values[1], row.values[2]);
    UserError::usage(format!(
        "({x}, {y}) lies more than {FARTHEST_M} m from the middle of the desk, at {} mm a unit",
        layout.unit_mm
    ))
    .at(format!("{name}:{}", row.line))
    .help(format!(
        "are these raw tablet units? give the tablet's size and unit: --size {}x{} --unit-mm 0.005 (200 per mm), or whatever it is",
        most(1),
        most(2)
    ))
}

/// Parts of a table that paint nothing.
fn unpainted(rows: &[Row], times_ns: &[u64], layout: TableLayout) -> Vec<Note> {
    let mut notes = Vec::new();
    let outside = |row: &&Row| {
        let within = |axis: usize| (0.0..=layout.size[axis]).contains(&row.values[1 + axis]);
        !(within(0) && within(1))
    };
    let beyond = rows.iter().filter(outside).count();
    if beyond > 0 {
        notes.push(Note::Outside {
            beyond,
            samples: rows.len(),
            size: layout.size,
        });
    }
    let touching = |i: &usize| rows[i - 1].paints_to(&rows[*i]);
    let pairs: Vec<usize> = (1..rows.len()).filter(touching).collect();
    if pairs.is_empty() {
        notes.push(Note::Unpainted);
    }
    let torn = |i: &&usize| times_ns[**i] - times_ns[**i - 1] > BRIDGED_NS;
    let torn: Vec<usize> = pairs.iter().filter(torn).copied().collect();
    if let Some(first) = torn.first() {
        notes.push(Note::Torn {
            line: rows[*first].line,
            places: torn.len(),
        });
    }
    notes
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
mod tests;
