//! Identification of a single wrong row, and none where all are right.

mod support;

use maulstick_measure::{FitOptions, Warning, fit};
use support::{Bench, Noise};

const ELEVEN: [&str; 11] = [
    "Titanium White",
    "Hansa Yellow Opaque",
    "Cadmium Orange",
    "Pyrrole Red",
    "Quinacridone Magenta",
    "Ultramarine Blue",
    "Cobalt Blue",
    "Phthalo Green Blue Shade",
    "Yellow Ochre",
    "Burnt Umber",
    "Bone Black",
];
/// Factor by which a share of the wrong row is misreported.
const FACTOR: f64 = 1.6;

/// A difference of reflectance that shows, root mean square over the spectrum: ΔE₀₀ 1 and more.
const SHOWS: f64 = 0.01;
/// Standard deviations of the white standard and of stray light from row to row.
const DRIFT: f64 = 2e-3;
const STRAY: f64 = 2e-3;

/// Tables like those of painters: two of each paint alone and with white 1:1, 1:4 and 1:9, and one of random mixtures.
/// Every 10 nm, with readings.
fn table(seed: u64) -> (Bench, Vec<Vec<f64>>) {
    let (paints, noise) = ([5, 8, 6][seed as usize % 3], NOISES[seed as usize / 3 % 3]);
    let mut bench = Bench::new(&ELEVEN[..paints], seed);
    bench.wavelengths_nm = support::grid(380.0, 730.0, 10.0);
    if seed % 3 == 2 {
        bench.mixtures(24);
    } else {
        bench.mix(&[(0, 1.0)]);
        for paint in 1..paints {
            for share in [1.0, 0.5, 0.2, 0.1] {
                bench.mix(&[(paint, share), (0, 1.0 - share)]);
            }
        }
    }
    let mut readings = bench.read(noise);
    // Systematic errors of an instrument in a row: its white, and stray light.
    for row in &mut readings {
        let (white, stray) = (DRIFT * bench.normal(), STRAY * bench.normal());
        row.iter_mut()
            .for_each(|r| *r = (*r * (1.0 + white) + stray).max(0.0));
    }
    (bench, readings)
}

/// Samples that the fit blames, in its order.
fn blamed(bench: &Bench, readings: &[Vec<f64>]) -> Vec<usize> {
    let found = fit(&bench.table(readings, 4), &FitOptions::default()).expect("fitted");
    let accusations = found.warnings.iter().filter_map(|warning| match warning {
        // Behind the headings.
        Warning::Suspect { line, .. } => Some(line - 2),
        _ => None,
    });
    accusations.collect()
}

/// Makes one share of a mixture too large and the others correspondingly smaller, where that is detectable: a share of
/// a paint that hardly colours the mixture may be anything.
fn spoil(bench: &mut Bench) -> usize {
    loop {
        let sample = (bench.uniform() * bench.samples.len() as f64) as usize;
        let pick = bench.uniform();
        let shares = &bench.samples[sample].shares;
        let parts: Vec<usize> = (0..shares.len()).filter(|j| shares[*j] > 0.0).collect();
        let part = parts[(pick * parts.len() as f64) as usize];
        let (was, becomes) = (shares[part], FACTOR * shares[part]);
        if parts.len() < 2 || !(0.08..0.95).contains(&becomes) {
            continue;
        }
        let others = (1.0 - becomes) / (1.0 - was);
        let right = bench.samples[sample].clone();
        let shares = &mut bench.samples[sample].shares;
        shares.iter_mut().for_each(|share| *share *= others);
        shares[part] = becomes;
        let wrong = &bench.samples[sample];
        let off = |nm: &f64| bench.reading(wrong, *nm) - bench.reading(&right, *nm);
        let squares: f64 = bench.wavelengths_nm.iter().map(|nm| off(nm).powi(2)).sum();
        if (squares / bench.wavelengths_nm.len() as f64).sqrt() > SHOWS {
            return sample;
        }
        bench.samples[sample] = right;
    }
}

const NOISES: [Noise; 3] = [
    Noise::Relative(2e-3),
    Noise::Absolute(2e-3),
    Noise::Absolute(5e-4),
];

#[test]
fn the_wrong_row_is_blamed_first() {
    let mut right = 0;
    for seed in 1..=6 {
        let (mut bench, readings) = table(seed);
        let sample = spoil(&mut bench);
        let blamed = blamed(&bench, &readings);
        println!("{seed}: {sample} is wrong, {blamed:?} are blamed");
        right += usize::from(blamed.first() == Some(&sample));
    }
    println!("first in {right} of 6");
    assert_eq!(right, 6);
}

#[test]
fn nobody_is_blamed_for_a_right_table() {
    let mut accused = 0;
    for seed in 101..=108 {
        let (bench, readings) = table(seed);
        accused += usize::from(!blamed(&bench, &readings).is_empty());
    }
    println!("{accused} of 8 accuse somebody");
    assert_eq!(accused, 0);
}
