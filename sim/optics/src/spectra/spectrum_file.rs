//! Spectra from CSV files: a wavelength a row, on any grid.
//!
//! ```text
//! # comment
//! nm,power
//! 380,49.98
//! 385,52.31
//! ```

use crate::spectrum::{Spectrum, bin, resample};
use crate::surface::SurfaceCorrection;

/// What is wrong with a table, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct TableError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong, with the column.
    pub what: String,
}

/// A spectrum covers this at least, nm: beyond its ends it is held.
const COVERED: [f64; 2] = [420.0, 680.0];

impl Spectrum {
    /// Reads the power of a light: a column of values of 0 or more over wavelengths in nm, which must
    /// rise; see [`bin`].
    ///
    /// # Errors
    /// [`TableError`] with line and column.
    pub fn parse(text: &str) -> Result<Self, TableError> {
        let table = rows(text, |value| match value >= 0.0 && value.is_finite() {
            true => Ok(()),
            false => Err(format!("{value} is not 0 or more")),
        })?;
        Ok(bin(&table))
    }
}

/// What a surface reflects, as an instrument reads it.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflectance {
    /// The readings, 0 to 1.
    pub reading: Spectrum,
    /// Whether the gloss of the surface went past the instrument.
    pub specular_excluded: bool,
}

impl Reflectance {
    /// Reads a column of reflectances of 0 to 1 over wavelengths in nm, which must rise; see
    /// [`resample`]. As in tables of measurements, `# specular: excluded` says that the gloss was left
    /// out; else it counts as read.
    ///
    /// # Errors
    /// [`TableError`] with line and column.
    pub fn parse(text: &str) -> Result<Self, TableError> {
        let mut specular_excluded = false;
        for (line, row) in text.lines().enumerate() {
            let note = row.trim().trim_start_matches('#').to_lowercase();
            let Some(value) = note.trim().strip_prefix("specular:") else {
                continue;
            };
            specular_excluded = match value.trim() {
                "excluded" => true,
                "included" => false,
                other => {
                    let what = format!("'{other}' is not `included` or `excluded`");
                    let line = line + 1;
                    return Err(TableError { line, what });
                }
            };
        }
        let table = rows(text, |value| match (0.0..=1.0).contains(&value) {
            true => Ok(()),
            false => Err(format!("{value} is not a reflectance of 0 to 1")),
        })?;
        Ok(Self {
            reading: resample(&table),
            specular_excluded,
        })
    }

    /// Internal reflectance: without what the surface does (Saunderson 1942), 0 to 1.
    #[must_use]
    pub fn internal(&self, surface: &SurfaceCorrection) -> Spectrum {
        let gloss = if self.specular_excluded {
            surface.k1
        } else {
            0.0
        };
        let internal = |reading: &f64| surface.internal(reading + gloss).clamp(0.0, 1.0);
        Spectrum(std::array::from_fn(|i| internal(&self.reading.0[i])))
    }
}

/// The rows of a table, nm and value, of which `check` says whether it may be.
fn rows(
    text: &str,
    check: impl Fn(f64) -> Result<(), String>,
) -> Result<Vec<[f64; 2]>, TableError> {
    let mut table: Vec<[f64; 2]> = Vec::new();
    let mut headed = false;
    for (line, row) in text.lines().enumerate().map(|(i, row)| (i + 1, row.trim())) {
        if row.is_empty() || row.starts_with('#') {
            continue;
        }
        let fault = |what: String| TableError { line, what };
        // Spreadsheets of half the world separate by semicolons.
        let cells: Vec<&str> = row.split([',', ';']).map(str::trim).collect();
        let numbers: Vec<_> = cells.iter().map(|cell| cell.parse::<f64>()).collect();
        if table.is_empty() && !headed && numbers.iter().all(Result::is_err) {
            headed = true;
            continue;
        }
        let [Ok(nm), Ok(value)] = numbers.as_slice() else {
            let what = match numbers.iter().position(Result::is_err) {
                Some(column) if cells.len() == 2 => {
                    format!("column {}: '{}' is not a number", column + 1, cells[column])
                }
                _ => format!("{} columns; give two: nm, value", cells.len()),
            };
            return Err(fault(what));
        };
        if !(100.0..=5000.0).contains(nm) {
            return Err(fault(format!("column 1: {nm} is no wavelength in nm")));
        }
        check(*value).map_err(|what| fault(format!("column 2: {what}")))?;
        if let Some([before, _]) = table.last()
            && before >= nm
        {
            return Err(fault(format!(
                "column 1: {nm} nm after {before} nm; they must rise"
            )));
        }
        table.push([*nm, *value]);
    }
    let end = text.lines().count().max(1);
    let fault = |what: &str| TableError {
        line: end,
        what: what.into(),
    };
    if table.len() < 2 {
        return Err(fault("a spectrum takes two wavelengths or more"));
    }
    let [first, last] = [table[0][0], table[table.len() - 1][0]];
    if first > COVERED[0] || last < COVERED[1] {
        return Err(fault(&format!(
            "the spectrum goes from {first} to {last} nm; give it from {} or less to {} or more",
            COVERED[0], COVERED[1]
        )));
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_grid_is_read_and_a_bad_cell_is_named() {
        let spectrum = Spectrum::parse("# mine\nnm,power\n380, 1\n500,1\n780,1\n").expect("good");
        assert!(spectrum.0.iter().all(|v| (v - 1.0).abs() < 1e-12));
        let error = |text: &str| Spectrum::parse(text).expect_err("bad").to_string();
        assert_eq!(
            error("380,1\n390,x"),
            "line 2: column 2: 'x' is not a number"
        );
        assert_eq!(
            error("380,1\n370,1"),
            "line 2: column 1: 370 nm after 380 nm; they must rise"
        );
        assert_eq!(error("380,1,2"), "line 1: 3 columns; give two: nm, value");
        assert_eq!(error("380,-1"), "line 1: column 2: -1 is not 0 or more");
        assert_eq!(
            error("380,NaN\n390,1"),
            "line 1: column 2: NaN is not 0 or more"
        );
        assert_eq!(error("4,1"), "line 1: column 1: 4 is no wavelength in nm");
        assert_eq!(
            error(""),
            "line 1: a spectrum takes two wavelengths or more"
        );
    }

    #[test]
    fn reflectances_lie_between_nothing_and_all_and_lose_their_gloss() {
        let surface = SurfaceCorrection::STANDARD;
        let read = Reflectance::parse("nm,reflectance\n400,0.2\n700,0.8\n").expect("good");
        assert!((read.reading.at(550.0) - 0.5).abs() < 0.02);
        let internal = read.internal(&surface);
        for (internal, reading) in internal.0.iter().zip(&read.reading.0) {
            assert!((surface.measured(*internal) - reading).abs() < 1e-12);
        }
        let without = Reflectance::parse("# Specular: excluded\n400,0.2\n700,0.8\n").expect("good");
        for (internal, reading) in without.internal(&surface).0.iter().zip(&without.reading.0) {
            assert!((surface.leaving(*internal) - reading).abs() < 1e-12);
        }
        let white = Reflectance::parse("# specular: excluded\n400,1\n700,1").expect("good");
        let black = Reflectance::parse("400,0\n700,0").expect("good");
        assert_eq!(white.internal(&surface).0[50], 1.0);
        assert_eq!(
            black.internal(&surface).0[50],
            0.0,
            "no darker than its gloss"
        );
        let error = |text: &str| Reflectance::parse(text).expect_err("bad").to_string();
        assert_eq!(
            error("400,0.5\n410,1.5"),
            "line 2: column 2: 1.5 is not a reflectance of 0 to 1"
        );
        assert_eq!(
            error("400,0.5\n400,0.5"),
            "line 2: column 1: 400 nm after 400 nm; they must rise"
        );
        assert!(error("400,0.5").contains("two wavelengths"));
        assert!(error("500,0.5\n600,0.5").contains("420 or less"));
        assert!(error("# specular: some\n400,0.5").contains("line 1"));
    }
}
