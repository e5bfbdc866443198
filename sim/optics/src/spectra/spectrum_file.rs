//! Spectra from tables: a wavelength a row, on any grid, as [`maulstick_tables`] reads them.
//!
//! ```text
//! # comment
//! nm,power
//! 380,49.98
//! 385,52.31
//! ```

use maulstick_tables::{HeadingLine, Table};

use crate::spectrum::{Spectrum, bin, resample};
use crate::spectrum_error::{COVERED, Range, SpectrumFault, TableError};
use crate::surface::SurfaceCorrection;

/// Instruments read nothing as a little less than nothing, by this share of the greatest reading at most.
const DARK: f64 = 0.01;
/// Greatest excess of a white over the instrument's standard.
const MOST_ABOVE_WHITE: f64 = 0.05;

impl Spectrum {
    /// Reads the power of a light: a column of values of 0 or more over wavelengths in nm, which must
    /// rise; see [`bin`]. Values below 0 by no more than an instrument's noise are 0.
    ///
    /// # Errors
    /// [`TableError`] with line and column.
    pub fn parse(text: &str) -> Result<Self, TableError> {
        let table = parsed(text)?;
        let mut rows = rows(&table)?;
        let greatest = rows.iter().map(|row| row.value).fold(0.0, f64::max);
        for row in &mut rows {
            row.within([-DARK * greatest, f64::MAX], [0.0, f64::MAX], Range::Power)?;
        }
        Ok(bin(&whole(&table, &rows)?))
    }
}

/// Reflectance of a surface, as an instrument reads it.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflectance {
    /// The readings, 0 to 1.
    pub reading: Spectrum,
    /// True if the instrument leaves out the gloss of the surface.
    pub specular_excluded: bool,
    /// Number of readings that were beyond 0 to 1, by no more than instruments err, and were taken as 0 or 1.
    pub limited: usize,
}

impl Reflectance {
    /// Reads a column of reflectances of 0 to 1 over ascending wavelengths in nm; see [`resample`]. As in tables of
    /// measurements, `# specular: excluded` means without the gloss; otherwise it is included.
    ///
    /// # Errors
    /// [`TableError`] with line and column.
    pub fn parse(text: &str) -> Result<Self, TableError> {
        let table = parsed(text)?;
        let mut specular_excluded = false;
        for note in table.notes().iter().filter(|note| note.key == "specular") {
            specular_excluded = match note.value.to_lowercase().as_str() {
                "excluded" => true,
                "included" => false,
                other => {
                    let (line, fault) = (note.line, SpectrumFault::Specular(other.to_owned()));
                    return Err(TableError { line, fault });
                }
            };
        }
        let mut rows = rows(&table)?;
        let mut limited = 0;
        for row in &mut rows {
            let is_limited = row.within(
                [-DARK, 1.0 + MOST_ABOVE_WHITE],
                [0.0, 1.0],
                Range::Reflectance,
            )?;
            limited += usize::from(is_limited);
        }
        Ok(Self {
            reading: resample(&whole(&table, &rows)?),
            specular_excluded,
            limited,
        })
    }

    /// Internal reflectance, without the effect of the surface (Saunderson 1942), 0 to 1.
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

/// A row of a spectrum.
struct Reading {
    line: usize,
    nm: f64,
    /// Its column, from 1.
    column: usize,
    value: f64,
}

impl Reading {
    /// Brings a value within `used` that lies within `given`; true if it was not.
    fn within(
        &mut self,
        given: [f64; 2],
        used: [f64; 2],
        range: Range,
    ) -> Result<bool, TableError> {
        let Self {
            line,
            column,
            value,
            ..
        } = *self;
        if !(given[0]..=given[1]).contains(&value) {
            let fault = SpectrumFault::Value {
                column,
                value,
                range,
            };
            return Err(TableError { line, fault });
        }
        self.value = value.clamp(used[0], used[1]);
        Ok(self.value != value)
    }
}

fn parsed(text: &str) -> Result<Table, TableError> {
    Ok(Table::parse(text, HeadingLine::Words)?)
}

/// The rows of a table of two columns.
fn rows(table: &Table) -> Result<Vec<Reading>, TableError> {
    let is_wavelength = |heading: &String| {
        let heading = heading.to_lowercase();
        ["nm", "wavelength", "lambda", "λ"]
            .iter()
            .any(|name| heading.starts_with(name))
    };
    let first = table.headings().iter().position(is_wavelength).unwrap_or(0);
    let mut rows: Vec<Reading> = Vec::with_capacity(table.rows().len());
    for row in table.rows() {
        let line = row.line();
        let numbers = row.numbers::<2>()?;
        let [nm, value] = [numbers[first.min(1)], numbers[1 - first.min(1)]];
        let column = first + 1;
        if !(100.0..=5000.0).contains(&nm) {
            let fault = SpectrumFault::Wavelength { column, nm };
            return Err(TableError { line, fault });
        }
        if let Some(before) = rows.last().map(|row| row.nm).filter(|before| *before >= nm) {
            let fault = SpectrumFault::Falling { column, nm, before };
            return Err(TableError { line, fault });
        }
        rows.push(Reading {
            line,
            nm,
            column: 2 - first.min(1),
            value,
        });
    }
    Ok(rows)
}

/// Wavelengths and values, if they cover the visible.
fn whole(table: &Table, rows: &[Reading]) -> Result<Vec<[f64; 2]>, TableError> {
    let line = table.last_line();
    let fault = |fault| TableError { line, fault };
    let [first, .., last] = rows else {
        return Err(fault(SpectrumFault::Short));
    };
    if first.nm > COVERED[0] || last.nm < COVERED[1] {
        return Err(fault(SpectrumFault::Part(first.nm, last.nm)));
    }
    Ok(rows.iter().map(|row| [row.nm, row.value]).collect())
}

#[cfg(test)]
mod tests {
    use maulstick_tables::Fault;

    use super::*;

    #[test]
    fn any_grid() {
        let spectrum = Spectrum::parse("# mine\nnm,power\n380, 1\n500,1\n780,1\n").expect("good");
        assert!(spectrum.0.iter().all(|v| (v - 1.0).abs() < 1e-12));
    }

    fn falling(nm: f64, before: f64) -> SpectrumFault {
        SpectrumFault::Falling {
            column: 1,
            nm,
            before,
        }
    }

    fn out_of(range: Range, value: f64) -> SpectrumFault {
        SpectrumFault::Value {
            column: 2,
            value,
            range,
        }
    }

    #[test]
    fn refuses_bad_cells() {
        let (column, nm) = (1, 4.0);
        for (text, line, fault) in [
            ("380,1\n370,1", 2, falling(370.0, 380.0)),
            ("380,-1", 1, out_of(Range::Power, -1.0)),
            ("4,1", 1, SpectrumFault::Wavelength { column, nm }),
            ("", 1, SpectrumFault::Short),
        ] {
            assert_eq!(Spectrum::parse(text), Err(TableError { line, fault }));
        }
        let cell = |cell: &str| cell.to_owned();
        let wide = Fault::Wide {
            cells: 3,
            columns: 2,
        };
        for (text, at, fault) in [
            (
                "380,1\n390,x",
                (2, Some(2)),
                Fault::NotANumber { cell: cell("x") },
            ),
            (
                "380,NaN\n390,1",
                (1, Some(2)),
                Fault::NotFinite { cell: cell("NaN") },
            ),
            ("380,1,2", (1, None), wide),
        ] {
            let SpectrumFault::Table(error) = Spectrum::parse(text).expect_err(text).fault else {
                panic!("{text}");
            };
            assert_eq!((error.line, error.column), at, "{text}");
            assert_eq!(error.fault, fault, "{text}");
        }
    }

    #[test]
    fn refuses_what_is_no_reflectance() {
        let unknown = SpectrumFault::Specular("some".to_owned());
        for (text, line, fault) in [
            ("400,0.5\n410,1.5", 2, out_of(Range::Reflectance, 1.5)),
            ("400,0.5\n400,0.5", 2, falling(400.0, 400.0)),
            ("400,0.5", 1, SpectrumFault::Short),
            ("500,0.5\n600,0.5", 2, SpectrumFault::Part(500.0, 600.0)),
            ("# specular: some\n400,0.5", 1, unknown),
        ] {
            assert_eq!(Reflectance::parse(text), Err(TableError { line, fault }));
        }
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
    }

    #[test]
    fn spreadsheets_of_any_country_give_the_same_spectrum() {
        let rows = [(380, 50.25), (500, 62.5), (780, 90.75)];
        let plain: String = rows.iter().map(|(nm, p)| format!("{nm},{p}\n")).collect();
        let wanted = Spectrum::parse(&plain).expect("good");
        let commas = |text: &str| text.replace(',', ";").replace('.', ",");
        for text in [
            format!("nm;power\r\n{}", commas(&plain)),
            format!("nm\tpower\n{}", plain.replace(',', "\t")),
            format!("nm power\r{}", plain.replace(',', " ").replace('\n', "\r")),
            format!(
                "\u{feff}\"nm\",\"power\"\n\"{}",
                plain
                    .replace(',', "\",\"")
                    .trim_end()
                    .replace('\n', "\"\n\"")
                    + "\"\n"
            ),
            format!(
                "power,Wavelength [nm]\n{}",
                rows.map(|(nm, p)| format!("{p},{nm}\n")).concat()
            ),
        ] {
            assert_eq!(Spectrum::parse(&text).expect(&text), wanted, "{text:?}");
        }
        // One of thousands, or with decimals?
        assert!(Spectrum::parse("380;1,234\n780;2,345\n").is_err());
    }

    #[test]
    fn errors_of_instruments_are_taken_back_and_no_more() {
        let white = Reflectance::parse("380,1.003\n500,1\n780,-0.0002\n").expect("good");
        assert_eq!(white.limited, 2);
        assert_eq!((white.reading.0[0], white.reading.0[100]), (1.0, 0.0));
        let lamp = Spectrum::parse("380,−0.0002\n500,1\n780,0.5\n").expect("good");
        assert!(lamp.0.iter().all(|power| *power >= 0.0));
        for text in [
            "400,1.1\n700,1\n",
            "400,-0.02\n700,1\n",
            "400,50\n700,100\n",
        ] {
            let error = Reflectance::parse(text).expect_err(text);
            assert_eq!(error.line, 1, "{error}");
        }
        assert_eq!(
            Spectrum::parse("400,-0.02\n700,1\n")
                .expect_err("dark")
                .line,
            1
        );
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_a_reader_panic(text in "([0-9]{3}[,;\t ][0-9][.,]?[0-9]{0,3}[\r\n]|[0-9.,;e\t \"\r\n#:-]){0,40}") {
            drop(Spectrum::parse(&text));
            drop(Reflectance::parse(&text));
            drop(crate::paints::PaintLibrary::parse(&text));
        }
    }
}
