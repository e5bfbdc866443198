//! Warnings of a fit: guesses, strange readings, paints and rows that are to be measured again.

use std::fmt;

/// A warning. Lines are counted from 1, samples and paints are called by name.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// Readings that end early, nm.
    Range {
        /// The shortest wavelength.
        first: f64,
        /// The longest wavelength.
        last: f64,
    },
    /// Wavelengths between which a reading is missing, nm.
    Gap {
        /// The wavelength before it.
        from: f64,
        /// The wavelength after it.
        to: f64,
        /// Usual distance of wavelengths.
        usual: f64,
    },
    /// The black of an opacity chart, which was not measured.
    BlackGround,
    /// The white of an opacity chart, which was not measured, and its supposed reflectance.
    WhiteGround(f64),
    /// A reading below the gloss of its surface.
    Low {
        /// Line of the sample.
        line: usize,
        /// The sample.
        sample: String,
        /// The gloss.
        gloss: f64,
    },
    /// A reading above a perfect white.
    High {
        /// Line of the sample.
        line: usize,
        /// The sample.
        sample: String,
        /// The reading.
        reading: f64,
    },
    /// A paint whose readings are too few.
    Indeterminate {
        /// The paint.
        paint: String,
        /// The reference white.
        white: String,
        /// Standard deviation of the reflectance of its tints, root mean square over the spectrum.
        rms: f64,
        /// The largest.
        most: f64,
        /// Wavelength of that, nm.
        nm: f64,
    },
    /// A row without which the others fit better.
    Suspect {
        /// Line of the sample.
        line: usize,
        /// The sample.
        sample: String,
        /// Its residual, ΔE₀₀.
        delta_e: f64,
        /// How many times as well the others fit.
        gain: f64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range { first, last } => write!(
                f,
                "the readings end at {first} and {last} nm: beyond, K and S of the ends are held"
            ),
            Self::Gap { from, to, usual } => write!(
                f,
                "no reading between {from} and {to} nm, where others are {usual} nm apart: interpolated"
            ),
            Self::BlackGround => f.write_str(
                "no row of kind ground is called 'black': it is taken to reflect nothing",
            ),
            Self::WhiteGround(reflectance) => write!(
                f,
                "no row of kind ground is called 'white': it is taken to reflect {reflectance}, as opacity charts do"
            ),
            Self::Low {
                line,
                sample,
                gloss,
            } => write!(
                f,
                "line {line}: '{sample}' reads less than its surface alone reflects ({gloss}): if gloss stayed out \
                 of the instrument, say so with --specular-excluded"
            ),
            Self::High {
                line,
                sample,
                reading,
            } => write!(
                f,
                "line {line}: '{sample}' reads {reading:.3}, more than a perfect white: K is taken as almost 0 there"
            ),
            Self::Indeterminate { .. } => self.indeterminate(f),
            Self::Suspect {
                line,
                sample,
                delta_e,
                gain,
            } => write!(
                f,
                "line {line}: '{sample}' is off by ΔE₀₀ {delta_e:.1}, and without it the others fit {gain:.1} times \
                 as well: check its shares and its reading"
            ),
        }
    }
}

impl Warning {
    fn indeterminate(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Indeterminate {
            paint,
            white,
            rms,
            most,
            nm,
        } = self
        else {
            return Ok(());
        };
        write!(
            f,
            "'{paint}' is ill-determined: its tints may be off by {rms:.2} in reflectance \
             ({most:.2} near {nm:.0} nm); what is missing was filled in from a usual paint; \
             add readings of it by itself"
        )?;
        if paint == white {
            Ok(())
        } else {
            write!(f, ", and mixed 1:1 and 1:10 with '{white}'")
        }
    }
}
