//! CIE observers and illuminants, from the tables in `data/` (which state their source).

use std::sync::OnceLock;

use crate::spectrum::{Spectrum, interpolate};
use crate::spectrum_file::TableError;

/// A standard observer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Observer {
    /// CIE 1931, 2°.
    #[default]
    Cie1931,
    /// CIE 1964, 10°.
    Cie1964,
}

/// The spectrum of the light in the studio.
#[derive(Clone, Debug, PartialEq)]
pub struct Illuminant {
    /// Its name.
    pub name: String,
    /// Relative power.
    pub power: Spectrum,
}

/// A light has power at this many of the samples or more: the most that a rule takes.
const NARROWEST: usize = 16;

/// Errors of a light under which no colours are visible.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DarkError {
    /// Too few wavelengths.
    #[error(
        "the light has power at {0} of the 101 wavelengths from 380 to 780 nm, 4 nm apart; colours take {NARROWEST}"
    )]
    Narrow(usize),
    /// A cone response that it does not excite.
    #[error("the light leaves one of X, Y and Z dark, so no colour is seen by it")]
    Response,
}

/// Names of the illuminants that come with the crate.
pub const ILLUMINANTS: [&str; 6] = ["A", "D50", "D65", "FL2", "FL8", "FL11"];

/// Reads the columns of one of our own tables: comments, a header line, numbers.
fn columns<const N: usize>(text: &str) -> [Vec<f64>; N] {
    let mut table: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    for line in text
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
    {
        for (column, cell) in table.iter_mut().zip(line.split(',')) {
            column.push(cell.parse().unwrap_or(f64::NAN));
        }
    }
    table
}

fn observers() -> &'static [Vec<f64>; 7] {
    static TABLE: OnceLock<[Vec<f64>; 7]> = OnceLock::new();
    TABLE.get_or_init(|| columns(include_str!("../../data/observers.csv")))
}

fn illuminants() -> &'static [Vec<f64>; 7] {
    static TABLE: OnceLock<[Vec<f64>; 7]> = OnceLock::new();
    TABLE.get_or_init(|| columns(include_str!("../../data/illuminants.csv")))
}

impl Observer {
    /// x̄, ȳ, z̄ at `nm`, linear between the 1 nm steps of the table.
    #[must_use]
    pub fn at(self, nm: f64) -> [f64; 3] {
        let first = match self {
            Self::Cie1931 => 1,
            Self::Cie1964 => 4,
        };
        std::array::from_fn(|i| interpolate(&observers()[first + i], nm - 380.0))
    }
}

impl Illuminant {
    /// One of [`ILLUMINANTS`].
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let column = ILLUMINANTS
            .iter()
            .position(|known| known.eq_ignore_ascii_case(name))?;
        let table = &illuminants()[column + 1];
        let power = Spectrum::from_fn(|nm| interpolate(table, (nm - 380.0) / 5.0));
        Some(Self {
            name: ILLUMINANTS[column].to_owned(),
            power,
        })
    }

    /// A light of one's own from a CSV file `nm,power` (see [`Spectrum::parse`]).
    ///
    /// # Errors
    /// [`TableError`] with line and column.
    pub fn parse(name: &str, text: &str) -> Result<Self, TableError> {
        let light = Self {
            name: name.to_owned(),
            power: Spectrum::parse(text)?,
        };
        match light.check() {
            Ok(()) => Ok(light),
            Err(dark) => Err(TableError {
                line: text.lines().count().max(1),
                what: dark.to_string(),
            }),
        }
    }

    /// Checks that colours can be seen by it: it has power at as many wavelengths as a rule takes, and
    /// excites each of the three responses of either observer.
    ///
    /// # Errors
    /// [`DarkError`].
    pub fn check(&self) -> Result<(), DarkError> {
        let most = self.power.0.iter().copied().fold(0.0, f64::max);
        let shining = self
            .power
            .0
            .iter()
            .filter(|power| **power > 1e-6 * most)
            .count();
        if !(most > 0.0 && most.is_finite()) || shining < NARROWEST {
            return Err(DarkError::Narrow(shining));
        }
        for observer in [Observer::Cie1931, Observer::Cie1964] {
            let white = self.xyz(observer, &Spectrum::flat(1.0));
            if !white.iter().all(|value| (1e-4..1e4).contains(value)) {
                return Err(DarkError::Response);
            }
        }
        Ok(())
    }

    /// Average daylight, the default.
    #[must_use]
    pub fn d65() -> Self {
        Self::named("D65").unwrap_or_else(|| Self {
            name: "E".into(),
            power: Spectrum::flat(1.0),
        })
    }

    /// XYZ of a reflectance by the sum over the 101 samples, Y = 1 for the perfect diffuser
    /// (Baxter 2004, eq. 7.5).
    #[must_use]
    pub fn xyz(&self, observer: Observer, reflectance: &Spectrum) -> [f64; 3] {
        let mut sum = [0.0; 3];
        let mut white = 0.0;
        for (i, r) in reflectance.0.iter().enumerate() {
            let response = observer.at(crate::spectrum::wavelength(i));
            let power = self.power.0[i];
            for (total, value) in sum.iter_mut().zip(response) {
                *total += value * power * r;
            }
            white += response[1] * power;
        }
        sum.map(|total| total / white)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// XYZ of the perfect diffuser by sums at 5 nm.
    fn white(observer: Observer, name: &str) -> [f64; 3] {
        let column = ILLUMINANTS
            .iter()
            .position(|known| *known == name)
            .expect("known")
            + 1;
        let mut sum = [0.0; 3];
        for (nm, power) in illuminants()[0].iter().zip(&illuminants()[column]) {
            for (total, value) in sum.iter_mut().zip(observer.at(*nm)) {
                *total += value * power;
            }
        }
        sum.map(|total| 100.0 * total / sum[1])
    }

    #[test]
    fn whites_are_those_of_the_cie() {
        use Observer::{Cie1931, Cie1964};
        for (observer, name, x, z) in [
            (Cie1931, "A", 109.849, 35.5825),
            (Cie1931, "D50", 96.4197, 82.5123),
            (Cie1931, "D65", 95.0430, 108.8801),
            (Cie1964, "A", 111.1439, 35.1995),
            (Cie1964, "D50", 96.7198, 81.4267),
            (Cie1964, "D65", 94.8118, 107.3241),
        ] {
            let got = white(observer, name);
            println!("{name} {observer:?}: {got:?}, expected {x} {z}");
            assert!((got[0] - x).abs() < 1e-4 && (got[2] - z).abs() < 1e-4);
            assert!(
                (got[0] * 1.00001 - x).abs() > 1e-4,
                "a fault of 1e-5 would pass"
            );
        }
    }

    #[test]
    fn the_101_samples_see_nearly_the_same_white() {
        let xyz = Illuminant::d65().xyz(Observer::Cie1931, &Spectrum::flat(1.0));
        assert!(
            (xyz[0] - 0.950_430).abs() < 5e-4 && (xyz[2] - 1.088_801).abs() < 5e-4,
            "{xyz:?}"
        );
        assert_eq!(
            Illuminant::named("d50").map(|light| light.name),
            Some("D50".into())
        );
        assert_eq!(Illuminant::named("candle"), None);
    }

    #[test]
    fn a_light_by_which_no_colour_is_seen_is_refused() {
        for name in ILLUMINANTS {
            assert_eq!(Illuminant::named(name).expect("known").check(), Ok(()));
        }
        let error = |text: &str| {
            Illuminant::parse("l", text)
                .expect_err("no light")
                .to_string()
        };
        for (text, word) in [
            (
                "380,0\n588,0\n589,1\n590,0\n800,0",
                "of the 101 wavelengths",
            ),
            ("380,0\n780,0", "power at 0"),
            ("200,1\n300,0\n900,0", "power at 0"),
            ("380,0\n600,0\n610,1\n780,1", "X, Y and Z"),
            ("900,1\n1000,1", "from 900 to 1000 nm"),
            ("560,1\n565,1", "from 560 to 565 nm"),
        ] {
            assert!(error(text).contains(word), "{}", error(text));
        }
    }
}
