//! Columns of a table of measurements.

use maulstick_optics::paints::check_paint_name;

use crate::error::MeasureError;
use crate::table::Table;
use crate::warning::Warning;

/// Columns that are neither a paint nor a wavelength.
pub const RESERVED: [&str; 4] = ["sample", "kind", "thickness_um", "over"];

/// Most columns of a table: an instrument's readings at each fifth of a nanometre, and some paints.
pub const MOST_COLUMNS: usize = 2500;

/// Columns of the table, counted from 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Headings {
    /// Columns of [`RESERVED`].
    pub reserved: [Option<usize>; 4],
    /// Columns of shares with the paints' names.
    pub paints: Vec<(usize, String)>,
    /// Columns of readings with their wavelengths, nm, rising.
    pub wavelengths: Vec<(usize, f64)>,
}

/// Checks that a heading can name a paint; otherwise the fault, and advice.
fn check_paint(heading: &str) -> Result<(), (String, &'static str)> {
    let help = "choose another name for the paint";
    check_paint_name(heading).map_err(|error| (error.to_string(), help))?;
    if heading.starts_with('#') || heading.eq_ignore_ascii_case("paint") {
        let help = "choose another name, without a leading #";
        return Err((format!("'{heading}' cannot name a paint"), help));
    }
    Ok(())
}

impl Headings {
    /// Reads the headings of `table`.
    ///
    /// # Errors
    /// A column without a heading or with a repeated one, wavelengths that are not ascending, more than
    /// [`MOST_COLUMNS`], a paint whose name does not fit a paint file, or missing paints or wavelengths.
    pub fn of(table: &Table) -> Result<Self, MeasureError> {
        let columns = table.headings().len();
        if columns > MOST_COLUMNS {
            let what = format!("{columns} columns; a table has at most {MOST_COLUMNS}");
            let help = "average the readings to a wavelength each nm or more, 380 to 780 nm";
            return Err(MeasureError::new(what, help).line(table.first_line()));
        }
        let mut found = Self::default();
        for (column, heading) in table.headings().iter().enumerate() {
            let fault =
                |what: String, help: &str| table.fault(table.first_line(), column, what, help);
            if heading.is_empty() {
                let help = "name the paint or the wavelength, or delete the column";
                return Err(fault("the column has no heading".into(), help));
            }
            let lower = heading.to_lowercase();
            if table.headings()[..column]
                .iter()
                .any(|other| other.to_lowercase() == lower)
            {
                let help = "keep one of the two columns";
                return Err(fault(
                    format!("two columns have the heading '{heading}'"),
                    help,
                ));
            }
            if let Some(place) = RESERVED.iter().position(|name| *name == lower) {
                found.reserved[place] = Some(column);
                continue;
            }
            let number = table.number(lower.trim_end_matches("nm").trim_end());
            let Ok(nm) = number else {
                check_paint(heading).map_err(|(what, help)| fault(what, help))?;
                found.paints.push((column, heading.clone()));
                continue;
            };
            if !(200.0..=3000.0).contains(&nm) {
                let help = "columns of readings are headed by their wavelength in nm";
                return Err(fault(format!("{nm} is no wavelength in nm"), help));
            }
            if let Some((_, before)) = found.wavelengths.last()
                && *before >= nm
            {
                let help = "order the columns by rising wavelength";
                return Err(fault(format!("{nm} nm after {before} nm"), help));
            }
            found.wavelengths.push((column, nm));
        }
        found.check(table)?;
        Ok(found)
    }

    /// Checks that there are paints and wavelengths enough.
    fn check(&self, table: &Table) -> Result<(), MeasureError> {
        let fault =
            |what: &str, help: &str| Err(MeasureError::new(what, help).line(table.first_line()));
        if self.paints.is_empty() {
            return fault(
                "no column names a paint",
                "head a column with each paint's name, and write its shares below",
            );
        }
        let visible = |(_, nm): &&(usize, f64)| (380.0..=780.0).contains(nm);
        if self.wavelengths.iter().filter(visible).count() < 3 {
            return fault(
                "fewer than three wavelengths between 380 and 780 nm",
                "head the columns of readings with their wavelengths in nm",
            );
        }
        Ok(())
    }

    /// Column of a reserved heading.
    #[must_use]
    pub fn column(&self, reserved: &str) -> Option<usize> {
        let place = RESERVED.iter().position(|name| *name == reserved)?;
        self.reserved[place]
    }

    /// Warnings about the grid: it ends early, or it skips a wavelength.
    #[must_use]
    pub fn warnings(&self) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let nm: Vec<f64> = self.wavelengths.iter().map(|(_, nm)| *nm).collect();
        if let [first, .., last] = nm.as_slice()
            && (*first > 400.0 || *last < 700.0)
        {
            let (first, last) = (*first, *last);
            warnings.push(Warning::Range { first, last });
        }
        let mut steps: Vec<f64> = nm.windows(2).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_by(f64::total_cmp);
        let usual = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
        for pair in nm.windows(2) {
            let step = pair[1] - pair[0];
            if step > 1.5 * usual && step > 5.0 {
                let (from, to) = (pair[0], pair[1]);
                warnings.push(Warning::Gap { from, to, usual });
            }
        }
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headings(line: &str) -> Result<Headings, MeasureError> {
        Headings::of(&Table::parse(&format!("{line}\nx\n")).expect("a table"))
    }

    #[test]
    fn any_order_and_any_rising_grid_is_read() {
        let found = headings("380 nm,Over,White,431.5,700nm,Sample").expect("good");
        assert_eq!(found.column("over"), Some(1));
        assert_eq!(found.column("sample"), Some(5));
        assert_eq!(found.column("kind"), None);
        assert_eq!(found.paints, [(2, "White".to_owned())]);
        assert_eq!(found.wavelengths, [(0, 380.0), (3, 431.5), (4, 700.0)]);
    }

    #[test]
    fn bad_headings_are_named() {
        let error = |line: &str| headings(line).expect_err("bad").to_string();
        assert_eq!(
            error("White,500,490,700"),
            "line 1, column 3 (490): 490 nm after 500 nm"
        );
        assert_eq!(
            error("White,4,500,600"),
            "line 1, column 2 (4): 4 is no wavelength in nm"
        );
        assert_eq!(
            error("White,white,500"),
            "line 1, column 2 (white): two columns have the heading 'white'"
        );
        assert_eq!(
            error("White,,500"),
            "line 1, column 2: the column has no heading"
        );
        assert_eq!(
            error("\"a,b\",500"),
            "line 1, column 1 (a,b): the name 'a,b' has one of = , \" in it, with which mixtures are written"
        );
        assert_eq!(
            error("sample,500,600,700"),
            "line 1: no column names a paint"
        );
        assert!(headings("White,500,600").is_err());
        assert!(headings("White,500,600,700").is_ok());
    }

    #[test]
    fn gaps_and_short_grids_are_told() {
        let warned = headings("White,400,410,420,440,450,690")
            .expect("good")
            .warnings();
        assert_eq!(warned.len(), 3, "{warned:?}");
        assert!(matches!(warned[1], Warning::Gap { from, to, .. } if (from, to) == (420.0, 440.0)));
        assert!(
            headings("White,380,390,400,700")
                .expect("good")
                .warnings()
                .len()
                == 1
        );
    }
}
