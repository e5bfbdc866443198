//! Rules of few wavelengths compared with all 101 samples, on other mixtures than the fitted ones: of one to four of
//! the measured paints with Dirichlet shares, half masstones, half films of 5 to 200 µm over black and white.

use std::time::Instant;

use maulstick_optics::colour::{delta_e_2000, lab};
use maulstick_optics::{Illuminant, Observer, PaintLibrary, SamplingRule, Spectrum};
use maulstick_rig::UserError;

use super::mixtures::held_out;
use crate::report::{Report, quantile, sorted};

const COUNT: usize = 5000;
const OBSERVER: Observer = Observer::Cie1931;
const LIGHTS: [&str; 4] = ["D65", "D50", "A", "FL11"];
/// Fits of which the median time is reported.
const FITS: usize = 7;

/// ΔE₀₀ of each mixture from its colour with all samples, sorted.
fn off(rule: &SamplingRule, light: &Illuminant, mixtures: &[Spectrum]) -> Vec<f64> {
    let white = light.xyz(OBSERVER, &Spectrum::flat(1.0));
    let one = |reflectance: &Spectrum| {
        let at = rule.wavelengths_nm.iter().map(|nm| reflectance.at(*nm));
        let seen: Vec<f64> = at.collect();
        let exact = lab(light.xyz(OBSERVER, reflectance), white);
        delta_e_2000(exact, lab(rule.xyz(&seen), white))
    };
    sorted(mixtures.iter().map(one).collect())
}

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let library =
        PaintLibrary::measured().map_err(|error| UserError::failure(error.to_string()))?;
    let paints = library.paints();
    let mixtures = held_out(paints, COUNT);
    for name in LIGHTS {
        let light = Illuminant::named(name).ok_or_else(|| UserError::failure("no such light"))?;
        let fitted = |n| SamplingRule::fitted(n, OBSERVER, &light, paints);
        let gauss = SamplingRule::gauss(8, OBSERVER, &light);
        let mut rows = |rule_name: &str, rule: &SamplingRule, shares: &[(&str, f64)]| {
            let off = off(rule, &light, &mixtures);
            let mean = off.iter().sum::<f64>() / off.len() as f64;
            report.row(&format!("{rule_name}.{name}.mean"), mean, "ΔE₀₀");
            for (share_name, share) in shares {
                let row = format!("{rule_name}.{name}.{share_name}");
                report.row(&row, quantile(&off, *share), "ΔE₀₀");
            }
        };
        rows("fitted16", &fitted(16), &[("p999", 0.999), ("max", 1.0)]);
        rows("fitted8", &fitted(8), &[("p95", 0.95)]);
        rows("gauss8", &gauss, &[("p95", 0.95)]);
    }
    let light = Illuminant::d65();
    let mut paints = paints.to_vec();
    let mut time = |_| {
        // Fits are cached: slightly different paints are not in the cache.
        paints[0].k.0.iter_mut().for_each(|k| *k *= 1.0 + 1e-12);
        let clock = Instant::now();
        std::hint::black_box(SamplingRule::fitted(16, OBSERVER, &light, &paints));
        1e3 * clock.elapsed().as_secs_f64()
    };
    let times = sorted((0..FITS).map(&mut time).collect());
    report.row("fit16.time", quantile(&times, 0.5), "ms");
    Ok(())
}
