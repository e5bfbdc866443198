//! Residuals: readings less those of the fitted paints.

use maulstick_optics::colour::{delta_e_2000, lab};
use maulstick_optics::spectrum::{SAMPLES, Spectrum, resample};
use maulstick_optics::{Illuminant, Observer, Paint, km};

use crate::influence::Suspect;
use crate::measurements::{Ground, Layer, Measurements, Sample};
use crate::surface::{Surface, internal_ground};

/// Residual of a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// The sample.
    pub name: String,
    /// Its line.
    pub line: usize,
    /// ΔE₀₀ between reading and fit, average daylight, 2° observer.
    pub delta_e: f64,
    /// Root mean square of their difference over the spectrum, in reflectance.
    pub rms: f64,
}

/// The residual of each sample, with K and S as the paint file will hold them.
#[must_use]
pub fn residuals(measured: &Measurements, paints: &[Paint], surface: &Surface) -> Vec<Residual> {
    let (light, observer) = (Illuminant::d65(), Observer::default());
    let white = light.xyz(observer, &Spectrum::flat(1.0));
    let lab = |spectrum: &Spectrum| lab(light.xyz(observer, spectrum), white);
    let dense = |readings: &[f64]| {
        let pairs = measured.wavelengths_nm.iter().zip(readings);
        resample(&pairs.map(|(nm, r)| [*nm, *r]).collect::<Vec<_>>())
    };
    let residual = |sample: &Sample| {
        let read = dense(&sample.readings);
        let ground = match &sample.layer {
            Layer::Film {
                ground: Ground::Read(readings),
                ..
            } => dense(readings).0.map(|r| internal_ground(r, surface)),
            _ => [0.0; SAMPLES],
        };
        let fitted = predicted(sample, paints, &ground, surface);
        let squares = fitted.0.iter().zip(&read.0).map(|(a, b)| (a - b) * (a - b));
        Residual {
            name: sample.name.clone(),
            line: sample.line,
            delta_e: delta_e_2000(lab(&read), lab(&fitted)),
            rms: (squares.sum::<f64>() / SAMPLES as f64).sqrt(),
        }
    };
    measured.samples.iter().map(residual).collect()
}

fn predicted(
    sample: &Sample,
    paints: &[Paint],
    ground: &[f64; SAMPLES],
    surface: &Surface,
) -> Spectrum {
    Spectrum(std::array::from_fn(|i| {
        let (mut k, mut s) = (0.0, 0.0);
        for (paint, share) in paints.iter().zip(&sample.shares) {
            k += share * paint.k.0[i];
            s += share * paint.s.0[i];
        }
        let inner = match sample.layer {
            Layer::Opaque => km::opaque(k, s),
            Layer::Film { thickness_m: d, .. } => km::over(km::film(k * d, s * d), ground[i]),
        };
        surface.reading(inner).0
    }))
}

/// A sentence for each suspect row, with a remedy.
#[must_use]
pub fn warnings(residuals: &[Residual], suspects: &[Suspect]) -> Vec<String> {
    let suspects = suspects.iter().map(|suspect| {
        let one = &residuals[suspect.sample];
        format!(
            "line {}: '{}' is off by ΔE₀₀ {:.1}, and without it the others fit {:.1} times as well: check \
             its shares and its reading",
            one.line, one.name, one.delta_e, suspect.gain
        )
    });
    suspects.collect()
}
