//! From raw spectra to reflectances (Baxter 2004, § 7.5).
//!
//! A spectroradiometer gives energies. With those of the sample E, of the reflectance standard W, and
//! of a darker sample without and with the neutral-density filter, D and D_f, the standard's being
//! too bright and read through the filter as W_f:
//!
//! ```text
//! a = D_f/D      W = W_f/a      R = R_standard·E/W
//! ```
//!
//! Rows of one kind are averaged. Where no row measures the standard, readings are reflectances.

use crate::error::MeasureError;
use crate::headings::Headings;
use crate::reading::{Kind, Reading};
use crate::table::Table;

/// Converts readings of samples and grounds to reflectances, where the table has raw spectra.
/// `standard` is the reflectance of the standard itself.
///
/// # Errors
/// One of the pair of filter readings is missing, a divisor is 0, or the filter's transmittance exceeds 1.
pub(crate) fn to_reflectances(
    readings: &mut [Reading],
    table: &Table,
    headings: &Headings,
    standard: f64,
) -> Result<(), MeasureError> {
    if !readings.iter().any(|reading| is_raw(reading.kind)) {
        return Ok(());
    }
    let light = light(readings, table, headings)?;
    let line = readings
        .iter()
        .find(|reading| matches!(reading.kind, Kind::Standard | Kind::FilteredStandard))
        .map_or(1, |reading| reading.line);
    for ((column, nm), value) in headings.wavelengths.iter().zip(&light) {
        if *value <= 0.0 {
            let help = "delete this wavelength's column: the lamp or the instrument ends before it";
            let what = format!("the standard reads 0 at {nm} nm");
            return Err(table.fault(line, *column, what, help));
        }
    }
    for reading in readings.iter_mut() {
        if matches!(reading.kind, Kind::Sample | Kind::Ground) {
            for (value, light) in reading.values.iter_mut().zip(&light) {
                *value *= standard / light;
            }
        }
    }
    Ok(())
}

/// True for the readings of raw spectra that are no samples.
fn is_raw(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Standard | Kind::FilteredStandard | Kind::Dark | Kind::FilteredDark
    )
}

/// Reading of the standard at each wavelength, without the filter.
fn light(
    readings: &[Reading],
    table: &Table,
    headings: &Headings,
) -> Result<Vec<f64>, MeasureError> {
    let plain = mean(readings, Kind::Standard);
    Ok(match (plain, mean(readings, Kind::FilteredStandard)) {
        (Some((_, plain)), None) => plain,
        (Some((line, _)), Some(_)) => {
            let help = "delete the rows of kind standard, or those of kind standard+filter";
            return Err(MeasureError::new(
                "the standard was read with and without the filter",
                help,
            )
            .line(line));
        }
        (None, Some((line, filtered))) => {
            let attenuation = attenuation(readings, table, headings, line)?;
            filtered
                .iter()
                .zip(&attenuation)
                .map(|(value, a)| value / a)
                .collect()
        }
        (None, None) => {
            let line = readings
                .iter()
                .find(|reading| is_raw(reading.kind))
                .map_or(1, |reading| reading.line);
            let help = "add a row of kind standard or standard+filter";
            return Err(
                MeasureError::new("raw spectra, but none of the standard", help).line(line),
            );
        }
    })
}

/// Attenuation of the filter at each wavelength, 0 to 1.
fn attenuation(
    readings: &[Reading],
    table: &Table,
    headings: &Headings,
    line: usize,
) -> Result<Vec<f64>, MeasureError> {
    let (Some((_, dark)), Some((filtered_line, filtered))) = (
        mean(readings, Kind::Dark),
        mean(readings, Kind::FilteredDark),
    ) else {
        let help = "add rows of kind dark and dark+filter: a darker sample, read without and with the filter";
        let what = "the standard was read through a filter whose attenuation is not measured";
        return Err(MeasureError::new(what, help).line(line));
    };
    let mut attenuation = Vec::new();
    for (((column, nm), dark), filtered) in headings.wavelengths.iter().zip(&dark).zip(&filtered) {
        if !(*filtered > 0.0 && filtered <= dark) {
            let what = format!("the filter passes {filtered} of {dark} at {nm} nm");
            let help = "a filter passes more than nothing and at most everything: check both rows";
            return Err(table.fault(filtered_line, *column, what, help));
        }
        attenuation.push(filtered / dark);
    }
    Ok(attenuation)
}

/// The mean of the rows of a kind, with the line of the first.
fn mean(readings: &[Reading], kind: Kind) -> Option<(usize, Vec<f64>)> {
    let rows: Vec<&Reading> = readings
        .iter()
        .filter(|reading| reading.kind == kind)
        .collect();
    let first = rows.first()?;
    let sum = |i: usize| rows.iter().map(|row| row.values[i]).sum::<f64>() / rows.len() as f64;
    Some((first.line, (0..first.values.len()).map(sum).collect()))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use crate::measurements::Measurements;

    const REFLECTANCES: &str = "kind,White,Black,400,500,600\n\
         sample,1,,0.8,0.85,0.9\nsample,,1,0.04,0.05,0.06\n";

    fn readings(text: &str) -> Vec<Vec<f64>> {
        let found = Measurements::parse(text).expect("good");
        found
            .samples
            .into_iter()
            .map(|sample| sample.readings)
            .collect()
    }

    #[test]
    fn raw_spectra_give_the_reflectances() {
        // Light 200, 400, 100; a filter of .1, .11, .12; a standard of .99; two readings of the pair.
        let raw = "# standard reflectance: 0.99\nkind,White,Black,400,500,600\n\
             standard+filter,,,19.8,43.56,11.88\ndark,,,10,20,6\ndark,,,30,60,18\n\
             dark+filter,,,2,4.4,1.44\nsample,1,,160,340,90\nsample,,1,8,20,6\n";
        let far = |text: &str| {
            let (got, want) = (readings(text), readings(REFLECTANCES));
            let pairs = got.iter().flatten().zip(want.iter().flatten());
            pairs
                .map(|(got, want)| (got - want).abs())
                .fold(0.0, f64::max)
        };
        assert!(far(raw) < 1e-12, "{}", far(raw));
        assert!(
            far(&raw.replace("43.56", "43.57")) > 1e-5,
            "a fault would pass"
        );
        let plain = "kind,White,Black,400,500,600\nstandard,,,200,400,100\n\
             sample,1,,160,340,90\nsample,,1,8,20,6\n";
        assert!(far(plain) < 1e-12);
    }

    #[test]
    fn incomplete_or_impossible_spectra_are_named() {
        let error = |rows: &str| {
            let text = format!("kind,White,400,500,600\n{rows}\nsample,1,1,1,1\n");
            Measurements::parse(&text).expect_err("bad").to_string()
        };
        let mut faults = BTreeSet::new();
        for rows in [
            "dark,,1,1,1",
            "standard+filter,,1,1,1",
            "standard,,1,1,1\nstandard+filter,,1,1,1",
        ] {
            let text = format!("kind,White,400,500,600\n{rows}\nsample,1,1,1,1\n");
            let fault = Measurements::parse(&text).expect_err(rows);
            assert_eq!((fault.place.line, fault.place.column), (Some(2), None));
            faults.insert(fault.to_string());
        }
        assert_eq!(faults.len(), 3, "each says its own: {faults:?}");
        assert_eq!(
            error("standard,,1,0,1"),
            "line 2, column 4 (500): the standard reads 0 at 500 nm"
        );
        assert_eq!(
            error("standard+filter,,1,1,1\ndark,,1,1,1\ndark+filter,,.1,.1,2"),
            "line 4, column 5 (600): the filter passes 2 of 1 at 600 nm"
        );
        assert_eq!(
            error("standard,,1,1,0.5"),
            "line 3, column 5 (600): a reflectance of 2.0000 at 600 nm is above 1.2"
        );
    }
}
