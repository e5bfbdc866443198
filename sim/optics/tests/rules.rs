//! Sampling rules beside all 101 samples, over mixtures that they were not fitted to.

mod support;

use maulstick_optics::colour::{delta_e_2000, lab};
use maulstick_optics::surface::SurfaceCorrection;
use maulstick_optics::{Illuminant, Observer, Paint, PaintLibrary, SamplingRule, Spectrum};

use support::held_out;

/// Errors of a rule, ΔE₀₀.
#[derive(Debug)]
struct Off {
    sorted: Vec<f64>,
}

impl Off {
    fn of(rule: &SamplingRule, observer: Observer, light: &Illuminant, all: &[Spectrum]) -> Self {
        let white = light.xyz(observer, &Spectrum::flat(1.0));
        let mut sorted: Vec<f64> = all
            .iter()
            .map(|reflectance| {
                let seen: Vec<f64> = rule
                    .wavelengths_nm
                    .iter()
                    .map(|nm| reflectance.at(*nm))
                    .collect();
                let exact = lab(light.xyz(observer, reflectance), white);
                delta_e_2000(exact, lab(rule.xyz(&seen), white))
            })
            .collect();
        sorted.sort_by(f64::total_cmp);
        Self { sorted }
    }

    fn mean(&self) -> f64 {
        self.sorted.iter().sum::<f64>() / self.sorted.len() as f64
    }

    fn at(&self, share: f64) -> f64 {
        self.sorted[(share * (self.sorted.len() - 1) as f64).round() as usize]
    }
}

fn paints() -> Vec<Paint> {
    PaintLibrary::measured().expect("whole").paints().to_vec()
}

fn fitted(n: usize, light: &str, paints: &[Paint]) -> (SamplingRule, Illuminant) {
    let light = Illuminant::named(light).expect("known");
    (
        SamplingRule::fitted(n, Observer::Cie1931, &light, paints),
        light,
    )
}

#[test]
fn sixteen_fitted_samples_stand_for_all() {
    let paints = paints();
    let held_out = held_out(&paints, 5000, 20_26);
    let seen = |surface: &SurfaceCorrection| -> Vec<Spectrum> {
        let through = |r: &Spectrum| Spectrum(r.0.map(|r| surface.measured(r)));
        held_out.iter().map(through).collect()
    };
    let through = seen(&SurfaceCorrection::default());
    for name in ["D65", "D50", "A", "FL11"] {
        let (rule, light) = fitted(16, name, &paints);
        for set in [&held_out, &through] {
            let off = Off::of(&rule, Observer::Cie1931, &light, set);
            let (mean, high, most) = (off.mean(), off.at(0.999), off.at(1.0));
            println!("{name}: mean {mean:.3}, 99.9 % {high:.3}, most {most:.3}");
            assert!(mean <= 0.1 && high <= 1.0 && most <= 2.0, "{name}");
        }
        // The same wavelengths, each 4 nm off, are another rule.
        let mut shifted = rule.clone();
        shifted.wavelengths_nm.iter_mut().for_each(|nm| *nm += 4.0);
        let off = Off::of(&shifted, Observer::Cie1931, &light, &held_out);
        assert!(off.mean() > 0.1, "a fault would pass: {}", off.mean());
    }
}

#[test]
fn eight_fitted_samples_do_for_weak_machines_and_gauss_does_not() {
    let paints = paints();
    let held_out = held_out(&paints, 5000, 7);
    for name in ["D65", "D50", "A", "FL11"] {
        let (rule, light) = fitted(8, name, &paints);
        let off = Off::of(&rule, Observer::Cie1931, &light, &held_out);
        let gauss = SamplingRule::gauss(8, Observer::Cie1931, &light);
        let gauss = Off::of(&gauss, Observer::Cie1931, &light, &held_out);
        let (mean, high) = (off.mean(), off.at(0.95));
        println!(
            "{name}: mean {mean:.3}, 95 % {high:.3}; gauss {:.3}",
            gauss.mean()
        );
        assert!(mean <= 1.0 && high <= 3.0, "{name}");
        assert!(gauss.mean() > 2.0 * mean, "{name}");
    }
}

#[test]
fn a_rule_is_exact_for_white_and_stays_between_black_and_white() {
    let paints = paints();
    for observer in [Observer::Cie1931, Observer::Cie1964] {
        for name in ["D65", "FL11"] {
            let light = Illuminant::named(name).expect("known");
            for n in [4, 7, 16] {
                let rule = SamplingRule::fitted(n, observer, &light, &paints);
                assert_eq!(rule.len(), n);
                let exact = light.xyz(observer, &Spectrum::flat(1.0));
                for (got, want) in rule.xyz(&vec![1.0; n]).iter().zip(exact) {
                    assert!((got - want).abs() < 1e-12, "{name} {n}");
                }
                assert!(rule.weights.iter().flatten().all(|weight| *weight >= 0.0));
                assert!(rule.wavelengths_nm.is_sorted_by(|a, b| a < b));
            }
        }
    }
}

#[test]
fn more_samples_are_better_and_other_paints_get_another_rule() {
    let paints = paints();
    let held_out = held_out(&paints, 1000, 3);
    let mean = |n: usize| {
        let (rule, light) = fitted(n, "D65", &paints);
        Off::of(&rule, Observer::Cie1931, &light, &held_out).mean()
    };
    let means = [4, 6, 8, 10, 12, 14, 16].map(mean);
    println!("{means:.3?}");
    assert!(means.is_sorted_by(|a, b| a > b));
    assert_ne!(
        fitted(8, "D65", &paints[..3]).0,
        fitted(8, "D65", &paints).0
    );
    assert_eq!(fitted(8, "D65", &paints).0, fitted(8, "D65", &paints).0);
    let (none, light) = fitted(8, "D65", &[]);
    assert_eq!(none, SamplingRule::gauss(8, Observer::Cie1931, &light));
}
