//! Samples of a table of measurements: their composition, and the instrument's readings.

use maulstick_tables::{Fault, Row, shown};
use maulstick_types::nearest::{choice, nearest};

use crate::error::MeasureError;
use crate::headings::Headings;
use crate::instrument;
use crate::notes::Notes;
use crate::reading::{Kind, Reading};
use crate::table::Table;
use crate::warning::Warning;

/// Reflectances above this are taken for a mistake.
pub const GREATEST_READING: f64 = 1.2;
/// Shares of a sample sum to 1 within this.
pub const SHARE_TOLERANCE: f64 = 2e-3;
/// Reading of the ground called `white` where it was not measured: opacity
/// charts are made to it (ISO 6504-3).
pub const CHART_WHITE: f64 = 0.8;

/// Everything that was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurements {
    /// Wavelengths of the readings, nm, ascending.
    pub wavelengths_nm: Vec<f64>,
    /// Names of the paints, in the order of their columns.
    pub paints: Vec<String>,
    /// Line and columns of their headings, for errors.
    pub headings: Headings,
    /// Line of the headings.
    pub heading_line: usize,
    /// The samples, in the order of their rows.
    pub samples: Vec<Sample>,
    /// Its notes.
    pub notes: Notes,
    /// Guesses that were made.
    pub warnings: Vec<Warning>,
}

/// A sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Its name.
    pub name: String,
    /// Line of the sample in the file.
    pub line: usize,
    /// Share of each paint; they sum to 1.
    pub shares: Vec<f64>,
    /// Its thickness and ground.
    pub layer: Layer,
    /// Reflectance at each wavelength, as the instrument reads it.
    pub readings: Vec<f64>,
}

/// Thickness and ground of a sample.
#[derive(Clone, Debug, PartialEq)]
pub enum Layer {
    /// An opaque layer.
    Opaque,
    /// A film: a drawdown.
    Film {
        /// Thickness, m.
        thickness_m: f64,
        /// Its ground.
        ground: Ground,
    },
}

/// Ground of a drawdown.
#[derive(Clone, Debug, PartialEq)]
pub enum Ground {
    /// A ground without reflection.
    Black,
    /// Something bare, of this reading at each wavelength.
    Read(Vec<f64>),
}

const KINDS: [(&str, Kind); 6] = [
    ("sample", Kind::Sample),
    ("ground", Kind::Ground),
    ("standard", Kind::Standard),
    ("standard+filter", Kind::FilteredStandard),
    ("dark", Kind::Dark),
    ("dark+filter", Kind::FilteredDark),
];

impl Measurements {
    /// Reads a table of measurements, described in `docs/measuring.md`.
    ///
    /// # Errors
    /// A [`MeasureError`] with line and column.
    pub fn parse(text: &str) -> Result<Self, MeasureError> {
        let table = Table::parse(text)?;
        let headings = Headings::of(&table)?;
        let notes = Notes::of(&table, &headings)?;
        let mut readings = Vec::new();
        for row in table.rows() {
            readings.push(reading(&table, &headings, row)?);
        }
        let mut warnings = headings.warnings();
        instrument::to_reflectances(&mut readings, &table, &headings, notes.standard)?;
        for reading in &readings {
            check_range(&table, &headings, reading)?;
        }
        let grounds: Vec<(&str, &[f64])> = table
            .rows()
            .zip(&readings)
            .filter(|(_, reading)| reading.kind == Kind::Ground)
            .map(|(row, reading)| (name(&headings, row), reading.values.as_slice()))
            .collect();
        let mut samples = Vec::new();
        for (row, reading) in table.rows().zip(&readings) {
            if reading.kind != Kind::Sample {
                continue;
            }
            let shares = shares(&table, &headings, row)?;
            let layer = layer(&table, &headings, row, &grounds, &mut warnings)?;
            let given = name(&headings, row);
            let name = if given.is_empty() {
                described(&headings, &shares)
            } else {
                given.to_owned()
            };
            samples.push(Sample {
                name,
                line: row.line(),
                shares,
                layer,
                readings: reading.values.clone(),
            });
        }
        if samples.is_empty() {
            let help = "give rows with shares of paints and their reflectances";
            return Err(MeasureError::new("no row measures a paint", help).line(table.first_line()));
        }
        Ok(Self {
            wavelengths_nm: headings.wavelengths.iter().map(|(_, nm)| *nm).collect(),
            paints: headings
                .paints
                .iter()
                .map(|(_, name)| name.clone())
                .collect(),
            heading_line: table.first_line(),
            headings,
            samples,
            notes,
            warnings,
        })
    }
}

fn name<'a>(headings: &Headings, row: Row<'a>) -> &'a str {
    headings
        .column("sample")
        .map_or("", |column| row.cell(column))
}

/// A sample without a name is called by its mixture.
fn described(headings: &Headings, shares: &[f64]) -> String {
    let parts: Vec<String> = headings
        .paints
        .iter()
        .zip(shares)
        .filter(|(_, share)| **share > 0.0)
        .map(|((_, paint), share)| {
            if *share == 1.0 {
                paint.clone()
            } else {
                format!("{paint}={}", (share * 1e4).round() * 1e-4)
            }
        })
        .collect();
    parts.join(",")
}

fn reading(table: &Table, headings: &Headings, row: Row<'_>) -> Result<Reading, MeasureError> {
    let mut kind = Kind::Sample;
    if let Some(column) = headings.column("kind")
        && !row.cell(column).is_empty()
    {
        let given = row.cell(column).to_lowercase().replace(' ', "");
        let known = KINDS.iter().find(|(name, _)| *name == given);
        let Some((_, found)) = known else {
            let help = choice(&given, KINDS.map(|(name, _)| name));
            let what = format!("'{}' is not a kind of row", shown(row.cell(column)));
            return Err(table.fault(row.line(), column, what, &help));
        };
        kind = *found;
    }
    let mut values = Vec::new();
    for (column, nm) in &headings.wavelengths {
        let cell = row.cell(*column);
        let fault = |what: String, help: &str| Err(table.fault(row.line(), *column, what, help));
        if cell.is_empty() {
            let help = "measure it, or delete this wavelength's column in all rows";
            return fault(format!("the reading at {nm} nm is missing"), help);
        }
        let value = match table.number(cell) {
            Ok(value) => value,
            Err(wrong) => return fault(wrong.to_string(), wrong.help()),
        };
        if value < 0.0 {
            let help = "measure it again, or write 0 where noise made it negative";
            return fault(format!("{cell} at {nm} nm is negative"), help);
        }
        values.push(value);
    }
    Ok(Reading {
        kind,
        line: row.line(),
        values,
    })
}

/// Refuses reflectances that none can be.
fn check_range(table: &Table, headings: &Headings, reading: &Reading) -> Result<(), MeasureError> {
    if !matches!(reading.kind, Kind::Sample | Kind::Ground) {
        return Ok(());
    }
    for ((column, nm), value) in headings.wavelengths.iter().zip(&reading.values) {
        if *value > GREATEST_READING {
            let what =
                format!("a reflectance of {value:.4} at {nm} nm is above {GREATEST_READING}");
            let help = if *value > 2.0 {
                "are these per cent? divide by 100; are they raw spectra? add the rows of the standard"
            } else {
                "check the reading of the standard, and that no gloss shone into the instrument"
            };
            return Err(table.fault(reading.line, *column, what, help));
        }
    }
    Ok(())
}

fn shares(table: &Table, headings: &Headings, row: Row<'_>) -> Result<Vec<f64>, MeasureError> {
    let mut shares = Vec::new();
    for (column, paint) in &headings.paints {
        let cell = row.cell(*column);
        let fault = |what: String, help: &str| Err(table.fault(row.line(), *column, what, help));
        let share = match table.number(cell) {
            Ok(share) => share,
            Err(Fault::Missing) => 0.0,
            Err(wrong @ Fault::TwoReadings { .. }) => {
                return fault(wrong.to_string(), wrong.help());
            }
            Err(wrong) => {
                let what = format!("'{}' is not a share of '{paint}'", shown(cell));
                return fault(what, wrong.help());
            }
        };
        if share < 0.0 {
            return fault(format!("the share {cell} is negative"), "shares are 0 to 1");
        }
        shares.push(share);
    }
    let sum: f64 = shares.iter().sum();
    if (sum - 1.0).abs() <= SHARE_TOLERANCE {
        return Ok(shares.iter().map(|share| share / sum).collect());
    }
    let used = |(share, _): &(&f64, &(usize, String))| **share > 0.0;
    let last = shares.iter().zip(&headings.paints).rfind(used);
    let column = last.map_or(headings.paints[0].0, |(_, (column, _))| *column);
    let help = if (sum - 100.0).abs() < 1.0 {
        "are these per cent? divide by 100".to_owned()
    } else if sum > 1.0 + SHARE_TOLERANCE && last.is_some_and(|(share, _)| *share > 1.0) {
        let name = &table.headings()[column];
        let divide = "shares are 0 to 1: divide weights by their sum";
        match nearest(name, crate::headings::RESERVED) {
            Some(nearest) => {
                format!("{divide}; if '{name}' is no paint, did you mean '{nearest}'?")
            }
            None => divide.to_owned(),
        }
    } else {
        "divide each weight by the sum of the row's weights".to_owned()
    };
    let what = format!("the shares sum to {sum:.4}, not to 1");
    Err(table.fault(row.line(), column, what, &help))
}

fn layer(
    table: &Table,
    headings: &Headings,
    row: Row<'_>,
    grounds: &[(&str, &[f64])],
    warnings: &mut Vec<Warning>,
) -> Result<Layer, MeasureError> {
    let cell = |reserved: &str| {
        let column = headings.column(reserved)?;
        let cell = row.cell(column);
        (!cell.is_empty()).then_some((column, cell))
    };
    let (thickness, over) = match (cell("thickness_um"), cell("over")) {
        (None, None) => return Ok(Layer::Opaque),
        (Some((column, _)), None) => {
            let help = "name the ground in the column `over`: black, white, a reflectance, or a row of kind ground";
            return Err(table.fault(row.line(), column, "a thickness, but over what?", help));
        }
        (None, Some((column, _))) => {
            let help =
                "measure the wet thickness and write it, or leave `over` empty if the sample hides";
            return Err(table.fault(
                row.line(),
                column,
                "a drawdown without `thickness_um`",
                help,
            ));
        }
        (Some(thickness), Some(over)) => (thickness, over),
    };
    let (column, text) = thickness;
    let thickness_um = table
        .number(text)
        .ok()
        .filter(|um| (0.1..=1e5).contains(um))
        .ok_or_else(|| {
            let what = format!("'{text}' is not a thickness");
            table.fault(row.line(), column, what, "give it in µm, 0.1 to 100000")
        })?;
    let ground = ground(table, headings, (row.line(), over), grounds, warnings)?;
    Ok(Layer::Film {
        thickness_m: thickness_um * 1e-6,
        ground,
    })
}

fn ground(
    table: &Table,
    headings: &Headings,
    (line, (column, text)): (usize, (usize, &str)),
    grounds: &[(&str, &[f64])],
    warnings: &mut Vec<Warning>,
) -> Result<Ground, MeasureError> {
    let wavelengths = headings.wavelengths.len();
    let named: Vec<&[f64]> = grounds
        .iter()
        .filter(|(name, _)| name.eq_ignore_ascii_case(text))
        .map(|(_, values)| *values)
        .collect();
    if !named.is_empty() {
        let mean =
            |i: usize| named.iter().map(|values| values[i]).sum::<f64>() / named.len() as f64;
        return Ok(Ground::Read((0..wavelengths).map(mean).collect()));
    }
    let mut guessed = |guess: Warning| {
        if !warnings.contains(&guess) {
            warnings.push(guess);
        }
    };
    if text.eq_ignore_ascii_case("black") {
        guessed(Warning::BlackGround);
        return Ok(Ground::Black);
    }
    if text.eq_ignore_ascii_case("white") {
        guessed(Warning::WhiteGround(CHART_WHITE));
        return Ok(Ground::Read(vec![CHART_WHITE; wavelengths]));
    }
    match table.number(text).ok() {
        Some(r) if (0.0..=GREATEST_READING).contains(&r) => Ok(Ground::Read(vec![r; wavelengths])),
        Some(r) => {
            let help = "a ground reflects 0 to 1; are these per cent? divide by 100";
            Err(table.fault(line, column, format!("no ground reflects {r}"), help))
        }
        None => {
            let names = grounds
                .iter()
                .map(|(name, _)| *name)
                .chain(["black", "white"]);
            let what = format!("no row of kind ground is called '{text}'");
            Err(table.fault(line, column, what, &choice(text, names)))
        }
    }
}
