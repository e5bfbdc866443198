//! Spectra from CSV files: a wavelength a row, on any grid.
//!
//! ```text
//! # comment
//! nm,power
//! 380,49.98
//! 385,52.31
//! ```

use crate::spectrum::{Spectrum, bin};

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
            if !(*value >= 0.0 && value.is_finite()) {
                return Err(fault(format!("column 2: {value} is not 0 or more")));
            }
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
        Ok(bin(&table))
    }
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
}
