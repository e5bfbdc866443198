//! Rows of a paint file.

use maulstick_tables::Row;

use super::{COEFFICIENT_MAX, FileFault, PaintError, WHITE_S_PER_M};
use crate::body::PaintBody;
use crate::spectrum::{SAMPLES, Spectrum};

/// Columns before the values.
const NAMED: usize = 4;
/// Columns of a row.
pub(super) const COLUMNS: usize = NAMED + SAMPLES;

/// A fault in a row of a paint file.
pub(super) fn fault_of(row: Row<'_>, fault: FileFault) -> PaintError {
    let line = row.line();
    PaintError::File { line, fault }
}

/// The header names the wavelengths of the samples.
pub(super) fn check_header(row: Row<'_>) -> Result<(), PaintError> {
    for column in NAMED..row.len() {
        let nm = crate::spectrum::wavelength(column - NAMED);
        if row.number(column)? != nm {
            let fault = FileFault::Wavelength {
                column: column + 1,
                cell: row.cell(column).to_owned(),
                nm,
            };
            return Err(fault_of(row, fault));
        }
    }
    Ok(())
}

/// What a row says of its paint.
pub(super) enum Said {
    K(Spectrum),
    S(Spectrum),
    Body(PaintBody),
}

impl Said {
    pub(super) fn of(row: Row<'_>) -> Result<Self, PaintError> {
        match row.cell(3) {
            "K" => coefficients(row).map(Self::K),
            "S" => coefficients(row).map(Self::S),
            "body" => body(row).map(Self::Body),
            other => Err(fault_of(row, FileFault::Quantity(other.to_owned()))),
        }
    }
}

/// K or S of a row, per metre.
fn coefficients(row: Row<'_>) -> Result<Spectrum, PaintError> {
    if row.len() != COLUMNS {
        return Err(fault_of(row, FileFault::Columns(row.len())));
    }
    let mut values = [0.0; SAMPLES];
    for (column, value) in (NAMED..).zip(&mut values) {
        *value = number(row, column, COEFFICIENT_MAX)? * WHITE_S_PER_M;
    }
    Ok(Spectrum(values))
}

/// A number of a row, 0 to `most`.
fn number(row: Row<'_>, column: usize, most: f64) -> Result<f64, PaintError> {
    let number = row.number(column)?;
    if (0.0..=most).contains(&number) {
        return Ok(number);
    }
    let (column, cell) = (column + 1, row.cell(column).to_owned());
    Err(fault_of(row, FileFault::Value { column, cell, most }))
}

/// The body in a row, which a spreadsheet may have filled up with empty cells.
fn body(row: Row<'_>) -> Result<PaintBody, PaintError> {
    let is_empty = |column: usize| row.cell(column).is_empty();
    if row.len() < NAMED + 2 || !(NAMED + 2..row.len()).all(is_empty) {
        return Err(fault_of(row, FileFault::BodyColumns));
    }
    let [rest_pa, recovers_s] = PaintBody::MOST;
    Ok(PaintBody {
        rest_pa: number(row, NAMED, rest_pa)?,
        recovers_s: number(row, NAMED + 1, recovers_s)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paints::PaintLibrary;

    #[test]
    fn a_paint_has_the_body_of_its_row_or_of_its_pigments() {
        let row = |quantity: &str, values: &str| format!("X,PB29,me,{quantity}{values}\n");
        let spectra = ["K", "S"].map(|quantity| row(quantity, &",1".repeat(SAMPLES)));
        let spectra = spectra.concat();
        let body = |text: &str| PaintLibrary::parse(text).expect("whole").paints()[0].body;
        let own = PaintBody {
            rest_pa: 1e5,
            recovers_s: 86_400.0,
        };
        let with_own = spectra.clone() + &row("body", ",1e5,86400,,");
        assert_eq!(body(&with_own), own);
        assert_eq!(body(&spectra), PaintBody::of_pigments("PB29"));
    }

    #[test]
    fn refuses_broken_bodies() {
        let value = |column: usize, cell: &str, most: f64| FileFault::Value {
            column,
            cell: cell.to_owned(),
            most,
        };
        let row = |quantity: &str, cells: &str| format!("X,PX,me,{quantity},{cells}\n");
        let paint = || "X".to_owned();
        let twice = FileFault::Twice {
            quantity: "body".to_owned(),
            paint: paint(),
        };
        for (text, line, fault) in [
            (row("body", "200,0.1"), 1, FileFault::Half(paint())),
            (row("body", "200"), 1, FileFault::BodyColumns),
            (row("body", "200,0.1,3"), 1, FileFault::BodyColumns),
            (row("body", "1e6,0.1"), 1, value(5, "1e6", 1e5)),
            (row("body", "200,-1"), 1, value(6, "-1", 86_400.0)),
            (row("body", "9,1").repeat(2), 2, twice),
            (
                row("Body", "9,1"),
                1,
                FileFault::Quantity("Body".to_owned()),
            ),
        ] {
            let found = PaintLibrary::parse(&text);
            assert_eq!(found, Err(PaintError::File { line, fault }));
        }
    }
}
