//! The whole fit: wavelength by wavelength, in several passes.
//!
//! The first pass assumes an instrument's usual noise; its residuals give the actual noise and, with drawdowns, the
//! mean of the white's S over the spectrum. The next passes use both.
//!
//! A mistake in a sample's shares or thickness shows at all wavelengths, and least squares would bend
//! every paint in it. So samples are trusted after Huber (1964, *Robust estimation of a location
//! parameter*): one whose residual, root mean square over the spectrum, is more than `OUTLIER_RATIO`
//! times the median's and the noise counts as much less.

use maulstick_num::{exp, ln};
use maulstick_optics::Paint;
use maulstick_optics::body::PaintBody;
use maulstick_optics::paints::WHITE_S_PER_M;
use maulstick_optics::spectrum::{Spectrum, resample};
use maulstick_optics::surface::SurfaceCorrection;

use crate::determined;
use crate::error::MeasureError;
use crate::influence;
use crate::links::check_links;
use crate::measurements::{Ground, Layer, Measurements};
use crate::notes::paint_called;
use crate::prior::Prior;
use crate::residuals::{Residual, residuals};
use crate::surface::{Surface, internal_ground};
use crate::warning::Warning;
use crate::wavelength::{Observation, Unknowns, Wavelength};

/// Noise of a reading that the first pass assumes: a good instrument repeats within it.
const USUAL_NOISE: f64 = 2e-3;

/// No instrument reads as well as this.
const LEAST_NOISE: f64 = 5e-5;
/// Ratio of a residual to the usual one beyond which it is not noise alone.
const OUTLIER_RATIO: f64 = 4.0;
/// Readings have to reach from here to here, nm.
const NARROWEST_RANGE_NM: [f64; 2] = [420.0, 680.0];
/// Passes after the first.
const PASSES: usize = 6;

/// Choices of a caller, before the notes of the table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FitOptions {
    /// The reference white, whose S is 1.
    pub white: Option<String>,
    /// k₁ and k₂ of the samples' surface; both 0 where readings are internal reflectances.
    pub surface: Option<SurfaceCorrection>,
    /// True if readings leave out the gloss k₁.
    pub specular_excluded: Option<bool>,
}

/// Measured paints.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The paints in the order of the table's columns, K and S per metre.
    pub paints: Vec<Paint>,
    /// Name of the reference white.
    pub white: String,
    /// Mean of its S per metre, where drawdowns say it. Without them it is taken to be
    /// [`WHITE_S_PER_M`] at each wavelength.
    pub white_s_per_m: Option<f64>,
    /// Residual of each sample, in the order of the rows.
    pub residuals: Vec<Residual>,
    /// Standard deviation of the readings, estimated from the residuals of the fit.
    pub noise: f64,
    /// Warnings about the paints.
    pub warnings: Vec<Warning>,
}

/// Refuses readings that leave most of a colour to guessing.
fn check_reach<T>(spectrum: &[(f64, T)]) -> Result<(), MeasureError> {
    match spectrum {
        [(first, _), .., (last, _)]
            if *first > NARROWEST_RANGE_NM[0] || *last < NARROWEST_RANGE_NM[1] =>
        {
            let what = format!("readings from {first} to {last} nm are too few for a colour");
            let help = "measure from 420 nm or less to 680 nm or more";
            Err(MeasureError::new(what, help))
        }
        _ => Ok(()),
    }
}

/// Fits K and S to a table of measurements.
///
/// # Errors
/// A [`MeasureError`] with line and column for a table that cannot be used, or for a singular fit.
pub fn fit(text: &str, options: &FitOptions) -> Result<Fit, MeasureError> {
    let measured = Measurements::parse(text)?;
    let white = reference_white(&measured, options)?;
    check_links(&measured, white)?;
    let surface = surface(&measured, options);
    let mut warnings = measured.warnings.clone();
    warnings.extend(strange_readings(&measured, &surface));

    let mut spectrum = wavelengths(&measured, white, surface)?;
    check_reach(&spectrum)?;
    let mut found: Vec<Unknowns> = spectrum
        .iter()
        .map(|(_, one)| one.refine(one.start()))
        .collect();
    let noise = estimate_noise(&spectrum, &found).unwrap_or(USUAL_NOISE);
    let unit = mean_unit(&spectrum, &found);
    for (_, one) in &mut spectrum {
        one.noise = noise;
        one.prior.unit = unit.unwrap_or(1.0);
    }
    for pass in 0..PASSES {
        let settled = !trust(&mut spectrum, &found, noise);
        if settled && pass > 0 {
            break;
        }
        for ((_, one), found) in spectrum.iter().zip(&mut found) {
            *found = one.refine(found.clone());
        }
    }
    let noise = estimate_noise(&spectrum, &found).unwrap_or(noise);
    for (_, one) in &mut spectrum {
        one.noise = noise;
    }

    let films = measured
        .samples
        .iter()
        .any(|sample| sample.layer != Layer::Opaque);
    let paints = paints(&measured, &spectrum, &found);
    warnings.extend(determined::warnings(&measured, &spectrum, &found));
    let residuals = residuals(&measured, &paints, &surface);
    let suspects = influence::suspects(&spectrum, &found);
    warnings.extend(crate::residuals::warnings(&residuals, &suspects));
    Ok(Fit {
        white: measured.paints[white].clone(),
        white_s_per_m: mean_unit(&spectrum, &found)
            .filter(|_| films)
            .map(|unit| unit * WHITE_S_PER_M),
        paints,
        residuals,
        noise,
        warnings,
    })
}

impl Fit {
    /// The worst residual, ΔE₀₀.
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.residuals
            .iter()
            .map(|one| one.delta_e)
            .fold(0.0, f64::max)
    }

    /// The mean residual, ΔE₀₀.
    #[must_use]
    pub fn mean(&self) -> f64 {
        let sum: f64 = self.residuals.iter().map(|one| one.delta_e).sum();
        sum / self.residuals.len().max(1) as f64
    }
}

fn reference_white(measured: &Measurements, options: &FitOptions) -> Result<usize, MeasureError> {
    let names: Vec<&str> = measured.paints.iter().map(String::as_str).collect();
    if let Some(name) = &options.white {
        return paint_called(name, &names);
    }
    if let Some((line, name)) = &measured.notes.white {
        return paint_called(name, &names).map_err(|error| error.line(*line));
    }
    let whites = |is: &dyn Fn(&str) -> bool| -> Vec<usize> {
        (0..names.len())
            .filter(|i| is(&names[*i].to_lowercase()))
            .collect()
    };
    for candidates in [
        whites(&|name| name == "titanium white"),
        whites(&|name| name.contains("white")),
    ] {
        if let [one] = candidates.as_slice() {
            return Ok(*one);
        }
    }
    let what = "which paint is the reference white, whose S is 1?";
    let help = "name it: --white NAME, or a line `# reference white: NAME`";
    Err(MeasureError::new(what, help).line(measured.heading_line))
}

fn surface(measured: &Measurements, options: &FitOptions) -> Surface {
    let correction = options
        .surface
        .or(measured.notes.surface)
        .unwrap_or_default();
    let excluded = options
        .specular_excluded
        .or(measured.notes.specular_excluded);
    if excluded.unwrap_or(false) {
        Surface::without_gloss(correction)
    } else {
        Surface::with_gloss(correction)
    }
}

/// Readings that no paint gives, though noise or a wrong surface may.
fn strange_readings(measured: &Measurements, surface: &Surface) -> Vec<Warning> {
    let allowance = 5.0 * USUAL_NOISE;
    let (least, most) = (surface.reading(0.0).0 - allowance, 1.0 + 2.0 * allowance);
    let mut warnings = Vec::new();
    for sample in &measured.samples {
        let low = sample.readings.iter().any(|r| *r < least);
        if low {
            warnings.push(Warning::Low {
                line: sample.line,
                sample: sample.name.clone(),
                gloss: surface.gloss,
            });
        }
        if let Some(reading) = sample.readings.iter().copied().find(|r| *r > most) {
            warnings.push(Warning::High {
                line: sample.line,
                sample: sample.name.clone(),
                reading,
            });
        }
    }
    warnings
}

/// The programs within the visible spectrum, and one beyond each of its ends.
fn wavelengths(
    measured: &Measurements,
    white: usize,
    surface: Surface,
) -> Result<Vec<(f64, Wavelength<'_>)>, MeasureError> {
    let nm = &measured.wavelengths_nm;
    let first = nm.partition_point(|nm| *nm <= 380.0).saturating_sub(1);
    let last = nm.partition_point(|nm| *nm < 780.0).min(nm.len() - 1);
    let usual = Prior::measured().map_err(|error| {
        MeasureError::new(error.to_string(), "the program is broken: rebuild it")
    })?;
    let at = |i: usize| {
        let observe = |sample| observation(sample, i, &surface);
        let one = Wavelength {
            observations: measured.samples.iter().map(observe).collect(),
            prior: usual.at(nm[i], measured.paints.len(), white),
            white,
            surface,
            noise: USUAL_NOISE,
        };
        (nm[i], one)
    };
    Ok((first..=last).map(at).collect())
}

fn observation<'a>(
    sample: &'a crate::measurements::Sample,
    wavelength: usize,
    surface: &Surface,
) -> Observation<'a> {
    let film = match &sample.layer {
        Layer::Opaque => None,
        Layer::Film {
            thickness_m,
            ground,
        } => {
            let ground = match ground {
                Ground::Black => 0.0,
                Ground::Read(readings) => internal_ground(readings[wavelength], surface),
            };
            Some((thickness_m * WHITE_S_PER_M, ground))
        }
    };
    Observation {
        shares: &sample.shares,
        film,
        reading: sample.readings[wavelength],
        trust: 1.0,
    }
}

/// Trusts each sample by how far it is off at all wavelengths; returns whether that changed.
fn trust(spectrum: &mut [(f64, Wavelength<'_>)], found: &[Unknowns], noise: f64) -> bool {
    let samples = spectrum
        .first()
        .map_or(0, |(_, one)| one.observations.len());
    let mut squares = vec![0.0; samples];
    for ((_, one), at) in spectrum.iter().zip(found) {
        for (sum, row) in squares.iter_mut().zip(&one.observations) {
            let off = row.model(at, &one.surface).value - row.reading;
            *sum += off * off;
        }
    }
    let off: Vec<f64> = squares
        .iter()
        .map(|sum| (sum / spectrum.len() as f64).sqrt())
        .collect();
    let mut sorted = off.clone();
    sorted.sort_by(f64::total_cmp);
    // Samples that alone determine something are met exactly, and carry no information about the others.
    let least = noise.min(USUAL_NOISE);
    let usual = sorted
        .get(samples / 2)
        .map_or(least, |median| median.max(least));
    let mut changed = false;
    for (_, one) in spectrum {
        for (row, off) in one.observations.iter_mut().zip(&off) {
            let trust = (OUTLIER_RATIO * usual / off.max(LEAST_NOISE)).min(1.0);
            changed |= (trust - row.trust).abs() > 1e-3;
            row.trust = trust;
        }
    }
    changed
}

/// The standard deviation of the readings from the residuals of all wavelengths; `None` where there
/// are hardly more readings than they determine unknowns.
fn estimate_noise(spectrum: &[(f64, Wavelength<'_>)], found: &[Unknowns]) -> Option<f64> {
    let (mut squares, mut freedom) = (0.0, 0.0);
    for ((_, one), at) in spectrum.iter().zip(found) {
        for row in &one.observations {
            let off = row.model(at, &one.surface).value - row.reading;
            squares += row.trust * off * off;
        }
        freedom += one.observations.len() as f64 - determined::effective_unknowns(one, at)?;
    }
    let enough = freedom > 0.5 * spectrum.len() as f64;
    enough.then(|| (squares / freedom).sqrt().clamp(LEAST_NOISE, 0.03))
}

/// The mean of the unit over the spectrum, by its logarithm, weighted by its certainty.
fn mean_unit(spectrum: &[(f64, Wavelength<'_>)], found: &[Unknowns]) -> Option<f64> {
    let (mut sum, mut weights) = (0.0, 0.0);
    for ((_, one), at) in spectrum.iter().zip(found) {
        let weight = determined::unit_information(one, at);
        sum += weight * ln(at.unit);
        weights += weight;
    }
    (weights > 0.0).then(|| exp(sum / weights))
}

/// K and S per metre on the grid of paint files: monotone cubic in their logarithms, as the measured
/// paints are resampled.
fn paints(
    measured: &Measurements,
    spectrum: &[(f64, Wavelength<'_>)],
    found: &[Unknowns],
) -> Vec<Paint> {
    let through = |value: &dyn Fn(&Unknowns) -> f64| {
        let points: Vec<[f64; 2]> = spectrum
            .iter()
            .zip(found)
            .map(|((nm, _), at)| [*nm, ln((value(at) * at.unit).max(1e-9))])
            .collect();
        Spectrum(resample(&points).0.map(|log| exp(log) * WHITE_S_PER_M))
    };
    let paint = |(j, name): (usize, &String)| {
        let indices = measured.notes.colour_indices.get(&j);
        let colour_index = indices.cloned().unwrap_or_default();
        Paint {
            body: PaintBody::of_pigments(&colour_index),
            name: name.clone(),
            colour_index,
            source: measured.notes.source.clone(),
            k: through(&|at| at.k[j]),
            s: through(&|at| at.s[j]),
        }
    };
    measured.paints.iter().enumerate().map(paint).collect()
}
