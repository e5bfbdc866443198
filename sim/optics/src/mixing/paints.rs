//! The measured paints: K and S at 101 wavelengths, relative to titanium white, in `data/`, and their bodies.

use std::collections::BTreeMap;

use maulstick_tables::{HeadingLine, Table, shown};
use maulstick_types::{Mixture, MixtureError};

use crate::body::PaintBody;
use crate::light::gloss::dry_gloss;
use crate::oil::oil_share;
use crate::spectrum::Spectrum;

/// Scattering of titanium white, per metre: over black 25 µm reflect .79, 100 µm .94.
pub const WHITE_S_PER_M: f64 = 150_000.0;

mod rows;

use self::rows::{COLUMNS, Said, check_header, fault_of};

/// A measured paint.
#[derive(Clone, Debug, PartialEq)]
pub struct Paint {
    /// Name by which mixtures are written.
    pub name: String,
    /// Colour index of its pigments.
    pub colour_index: String,
    /// Source of the measurement.
    pub source: String,
    /// Absorption by wavelength, per metre.
    pub k: Spectrum,
    /// Scattering by wavelength, per metre.
    pub s: Spectrum,
    /// How it sets.
    pub body: PaintBody,
}

/// Name of the thinner, which every palette has: a medium without absorption and scattering.
pub const THINNER: &str = "Thinner";

/// The varnishes, clear like the thinner, and their gloss once dry.
pub const VARNISHES: [(&str, f32); 2] = [("Gloss Varnish", 0.95), ("Matt Varnish", 0.1)];

/// Names of what every palette has besides the paints of a file.
const MEDIUMS: [&str; 3] = [THINNER, VARNISHES[0].0, VARNISHES[1].0];

impl Paint {
    fn medium(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            colour_index: String::new(),
            source: "transparent by definition".to_owned(),
            k: Spectrum::flat(0.0),
            s: Spectrum::flat(0.0),
            body: PaintBody::FLUID,
        }
    }

    /// Gloss of its dry film, 0 to 1: a varnish's own, else by the oil that its pigments need.
    #[must_use]
    pub fn dry_gloss(&self) -> f32 {
        let varnish = VARNISHES.iter().find(|(name, _)| *name == self.name);
        varnish.map_or_else(
            || dry_gloss(oil_share(&self.colour_index)),
            |(_, gloss)| *gloss,
        )
    }

    /// True if it is a varnish.
    #[must_use]
    pub fn is_varnish(&self) -> bool {
        VARNISHES.iter().any(|(name, _)| *name == self.name)
    }

    /// True if it is the thinner.
    #[must_use]
    pub fn is_thinner(&self) -> bool {
        self.name == THINNER
    }
}

/// Error of a paint library or a mixture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PaintError {
    /// No such paint; the nearest name is proposed.
    #[error("there is no paint called '{name}'{}", meant(.nearest.as_deref()))]
    Unknown {
        /// The name as it was given.
        name: String,
        /// The nearest name, if one is near.
        nearest: Option<String>,
    },
    /// The mixture itself is wrong.
    #[error(transparent)]
    Mixture(#[from] MixtureError),
    /// A line of a paint file cannot be read.
    #[error("line {line}: {fault}")]
    File {
        /// The line, from 1.
        line: usize,
        /// Defect of this line.
        fault: FileFault,
    },
}

/// A defect of a paint file. Columns are counted from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FileFault {
    /// The text is no table.
    #[error("{}", .0.what())]
    Table(maulstick_tables::TableError),
    /// Columns of a row that has not one for each value.
    #[error("{0} columns instead of {COLUMNS}")]
    Columns(usize),
    /// A heading that is not the wavelength of its column.
    #[error("column {column}: wavelength '{cell}' instead of {nm}")]
    Wavelength {
        /// The column, from 1.
        column: usize,
        /// Heading of the column.
        cell: String,
        /// Wavelength that belongs to the column, nm.
        nm: f64,
    },
    /// A row of a body that has not two values.
    #[error("a body has two values: a yield stress, Pa, and a recovery, s")]
    BodyColumns,
    /// A value out of range.
    #[error("column {column}: {} is not 0 to {most:.0}", shown(.cell))]
    Value {
        /// The column, from 1.
        column: usize,
        /// Text of the cell.
        cell: String,
        /// The largest.
        most: f64,
    },
    /// A quantity that is not K, S or body.
    #[error("quantity '{}' is not K, S or body", shown(.0))]
    Quantity(String),
    /// A name that no paint may have.
    #[error(transparent)]
    Name(#[from] PaintNameError),
    /// A second row of K, of S or of the body.
    #[error("a second row of {quantity} of '{paint}'")]
    Twice {
        /// The quantity: K, S or body.
        quantity: String,
        /// Name of the paint.
        paint: String,
    },
    /// The paint without a row of K or of S.
    #[error("'{0}' lacks its row of K or of S")]
    Half(String),
    /// A file without a paint.
    #[error("the file holds no paint")]
    Empty,
}

fn meant(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |name| format!("; did you mean '{name}'?"))
}

/// Largest K or S relative to titanium white's S: a black of which 0.02 µm hide.
const COEFFICIENT_MAX: f64 = 1e6;
/// The name of a paint has at most this many bytes.
const NAME_MAX: usize = maulstick_types::limits::PAINT_NAME_MAX;

/// A name that no paint may have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PaintNameError {
    /// A name of blanks alone.
    #[error("a paint has no name")]
    Blank,
    /// More bytes than messages can carry.
    #[error("a paint's name has {0} bytes, more than {NAME_MAX}")]
    Long(usize),
    /// A character with which mixtures are written, or a control character.
    #[error("the name '{0}' has one of = , \" in it, with which mixtures are written")]
    Character(String),
    /// The name of a medium.
    #[error("'{0}' is a medium that every palette has; choose another name for the paint")]
    Medium(&'static str),
}

/// Checks that a paint may have this name: mixtures are written with it.
///
/// # Errors
/// [`PaintNameError`].
pub fn check_paint_name(name: &str) -> Result<(), PaintNameError> {
    if name.trim().is_empty() {
        Err(PaintNameError::Blank)
    } else if name.len() > NAME_MAX {
        Err(PaintNameError::Long(name.len()))
    } else if name.contains(['=', ',', '"']) || name.contains(char::is_control) {
        Err(PaintNameError::Character(name.to_owned()))
    } else if let Some(medium) = MEDIUMS.iter().find(|own| name.eq_ignore_ascii_case(own)) {
        Err(PaintNameError::Medium(medium))
    } else {
        Ok(())
    }
}

impl From<maulstick_tables::TableError> for PaintError {
    fn from(error: maulstick_tables::TableError) -> Self {
        Self::File {
            line: error.line,
            fault: FileFault::Table(error),
        }
    }
}

/// What a paint file says of one paint.
#[derive(Default)]
struct Found {
    k: Option<Spectrum>,
    s: Option<Spectrum>,
    body: Option<PaintBody>,
}

/// The paints to choose from.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintLibrary {
    paints: Vec<Paint>,
    mediums: [Paint; 3],
    hash: u32,
    text: std::sync::Arc<str>,
}

/// The paints that come with the crate: 28 acrylic artists' paints (Berns 2016, Okumura 2005).
pub const MEASURED: &str = include_str!("../../data/paints.csv");

impl PaintLibrary {
    /// The 28 measured paints.
    ///
    /// # Errors
    /// None in practice: the file is part of the crate and tested.
    pub fn measured() -> Result<Self, PaintError> {
        Self::parse(MEASURED)
    }

    /// Reads a paint file, a table of `paint,colour_index,source,quantity`, then 101 values of K or S relative
    /// to titanium white's S, 380 to 780 nm; or a `body`: its yield stress at rest, Pa, and its recovery, s.
    ///
    /// # Errors
    /// [`PaintError::File`] with the line.
    pub fn parse(text: &str) -> Result<Self, PaintError> {
        let table = Table::parse(text, HeadingLine::Row)?;
        let mut found: BTreeMap<String, Found> = BTreeMap::new();
        let mut order: Vec<(String, String, String)> = Vec::new();
        for row in table.rows() {
            if row.cell(0).eq_ignore_ascii_case("paint") {
                check_header(row)?;
                continue;
            }
            let [name, colour_index, source] = [0, 1, 2].map(|column| row.cell(column));
            if !found.contains_key(name) {
                check_paint_name(name).map_err(|error| fault_of(row, error.into()))?;
                order.push((name.into(), colour_index.into(), source.into()));
            }
            let own = found.entry(name.to_owned()).or_default();
            let is_second = match Said::of(row)? {
                Said::K(k) => own.k.replace(k).is_some(),
                Said::S(s) => own.s.replace(s).is_some(),
                Said::Body(body) => own.body.replace(body).is_some(),
            };
            if is_second {
                let (quantity, paint) = (row.cell(3).to_owned(), name.to_owned());
                return Err(fault_of(row, FileFault::Twice { quantity, paint }));
            }
        }
        let mut paints = Vec::new();
        for (name, colour_index, source) in order {
            let own = found.remove(&name).unwrap_or_default();
            let (Some(k), Some(s)) = (own.k, own.s) else {
                return Err(PaintError::File {
                    line: table.last_line(),
                    fault: FileFault::Half(name),
                });
            };
            let by_pigment = || PaintBody::of_pigments(&colour_index);
            let body = own.body.unwrap_or_else(by_pigment);
            paints.push(Paint {
                name,
                colour_index,
                source,
                k,
                s,
                body,
            });
        }
        if paints.is_empty() {
            return Err(PaintError::File {
                line: 1,
                fault: FileFault::Empty,
            });
        }
        Ok(Self {
            paints,
            mediums: MEDIUMS.map(Paint::medium),
            hash: maulstick_types::name_hash(text),
            text: text.into(),
        })
    }

    /// All paints, in the order of the file; the mediums are none of them.
    #[must_use]
    pub fn paints(&self) -> &[Paint] {
        &self.paints
    }

    /// FNV-1a of the file.
    #[must_use]
    pub fn hash(&self) -> u32 {
        self.hash
    }

    /// Text of the file.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The paint called `name`, whatever its case.
    ///
    /// # Errors
    /// [`PaintError::Unknown`] with the nearest name.
    pub fn find(&self, name: &str) -> Result<&Paint, PaintError> {
        let all = || self.paints.iter().chain(&self.mediums);
        if let Some(paint) = all().find(|p| p.name.eq_ignore_ascii_case(name)) {
            return Ok(paint);
        }
        let names = all().map(|paint| paint.name.as_str());
        Err(PaintError::Unknown {
            name: name.to_owned(),
            nearest: maulstick_types::nearest(name, names).map(str::to_owned),
        })
    }

    /// Checks that a mixture's shares are valid and its paints exist, and spells their names like the file.
    ///
    /// # Errors
    /// [`PaintError::Mixture`] or [`PaintError::Unknown`].
    pub fn check(&self, mixture: &Mixture) -> Result<Mixture, PaintError> {
        mixture.check()?;
        let mut mixture = mixture.clone();
        for part in &mut mixture.parts {
            part.paint = self.find(&part.paint)?.name.clone();
        }
        Ok(mixture)
    }
}

#[cfg(test)]
mod tests {
    use maulstick_tables::Fault;

    use crate::spectrum::SAMPLES;

    use super::*;

    #[test]
    fn the_measured_paints_are_all_there() {
        let library = PaintLibrary::measured().expect("the file is whole");
        assert_eq!(library.paints().len(), 28);
        let white = library.find("titanium white").expect("white");
        assert_eq!(
            (white.s.0[40], white.colour_index.as_str()),
            (WHITE_S_PER_M, "PW6")
        );
    }

    #[test]
    fn an_unknown_paint_gets_the_nearest_name() {
        let library = PaintLibrary::measured().expect("the file is whole");
        for (name, nearest) in [("Colbat Blue", Some("Cobalt Blue")), ("zzz", None)] {
            let (name, nearest) = (name.to_owned(), nearest.map(str::to_owned));
            let found = library.find(&name).cloned();
            assert_eq!(found, Err(PaintError::Unknown { name, nearest }));
        }
    }

    #[test]
    fn refuses_broken_files() {
        let row = |quantity: &str, value: &str| {
            format!("X,PX,me,{quantity}{}", format!(",{value}").repeat(SAMPLES))
        };
        let named = |name: &str| row("K", "1").replacen('X', name, 1);
        let value = |cell: &str| FileFault::Value {
            column: 5,
            cell: cell.to_owned(),
            most: 1e6,
        };
        let twice = FileFault::Twice {
            quantity: "K".to_owned(),
            paint: "X".to_owned(),
        };
        let wavelength = FileFault::Wavelength {
            column: 6,
            cell: "380".to_owned(),
            nm: 384.0,
        };
        let character = PaintNameError::Character("a=b".to_owned());
        for (text, line, fault) in [
            ("X,PX,me,K,1".to_owned(), 1, FileFault::Columns(5)),
            (row("K", "-1"), 1, value("-1")),
            (row("K", "1e300"), 1, value("1e300")),
            (row("Q", "1"), 1, FileFault::Quantity("Q".to_owned())),
            (row("K", "1"), 1, FileFault::Half("X".to_owned())),
            (String::new(), 1, FileFault::Empty),
            (format!("{}\n{}", row("K", "1"), row("K", "2")), 2, twice),
            (named("a=b"), 1, character.into()),
            (named("thinner"), 1, PaintNameError::Medium(THINNER).into()),
            (named(" "), 1, PaintNameError::Blank.into()),
            (
                format!("paint,i,s,q{}", ",380".repeat(SAMPLES)),
                1,
                wavelength,
            ),
        ] {
            let found = PaintLibrary::parse(&text);
            assert_eq!(found, Err(PaintError::File { line, fault }));
        }
        for (cell, fault) in [
            (
                "x",
                Fault::NotANumber {
                    cell: "x".to_owned(),
                },
            ),
            (
                "NaN",
                Fault::NotFinite {
                    cell: "NaN".to_owned(),
                },
            ),
        ] {
            let found = PaintLibrary::parse(&row("K", cell));
            assert!(
                matches!(found, Err(PaintError::File { line: 1, fault: FileFault::Table(error) }) if error.column == Some(5) && error.fault == fault)
            );
        }
    }
}
