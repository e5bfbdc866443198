//! The fit on synthetic mixtures and drawdowns of the measured paints.

mod support;

use maulstick_measure::normal::NormalEquations;
use maulstick_measure::program::{Bound, minimise};
use maulstick_measure::{Fit, FitOptions, Warning, fit, paint_file};
use maulstick_optics::colour::{delta_e_2000, lab};
use maulstick_optics::spectrum::wavelength;
use maulstick_optics::{Illuminant, Observer, PaintLibrary, Spectrum, km};
use proptest::prelude::*;
use support::{Bench, Noise, Sample};

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
const THREE: [&str; 3] = ["Titanium White", "Ultramarine Blue", "Hansa Yellow Opaque"];

fn fitted(bench: &Bench, readings: &[Vec<f64>]) -> Fit {
    fit(&bench.table(readings, 10), &FitOptions::default()).expect("fitted")
}

/// The 71 samples of Baxter 2004, § 7.6: masstones and mixtures of eleven paints.
fn seventy_one(seed: u64) -> Bench {
    let mut bench = Bench::new(&ELEVEN, seed);
    bench.mixtures(71);
    assert_eq!(bench.samples.len(), 71);
    bench
}

/// ΔE₀₀ of each sample between the colour that the fit's paint file gives and the true one.
fn off_truth(bench: &Bench, fitted: &Fit) -> Vec<f64> {
    let (light, observer) = (Illuminant::d65(), Observer::default());
    let white = light.xyz(observer, &Spectrum::flat(1.0));
    let library = PaintLibrary::parse(&paint_file(fitted)).expect("the file is read");
    let mut other = Bench::new(&[], 0);
    other.paints = library.paints().to_vec();
    let seen = |bench: &Bench, sample: &Sample| {
        let spectrum = Spectrum::from_fn(|nm| bench.reading(sample, nm));
        lab(light.xyz(observer, &spectrum), white)
    };
    let samples = bench.samples.iter();
    samples
        .map(|sample| delta_e_2000(seen(bench, sample), seen(&other, sample)))
        .collect()
}

fn worst(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

#[test]
fn seventy_one_mixtures_of_eleven_paints_are_reproduced() {
    for seed in [1, 2, 3] {
        let mut bench = seventy_one(seed);
        let readings = bench.read(Noise::Relative(2e-3));
        let found = fitted(&bench, &readings);
        println!(
            "seed {seed}: mean {:.3}, worst {:.3}",
            found.mean(),
            found.worst()
        );
        assert!(found.worst() <= 0.5 && worst(&off_truth(&bench, &found)) <= 0.5);
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        assert_eq!(found.white_s_per_m, None);
        assert!(
            found.paints[0]
                .s
                .0
                .iter()
                .all(|s| (s / 150_000.0 - 1.0).abs() < 1e-9)
        );
    }
}

/// .2 % of the perfect white is 6 % of the reflectance of black paint: the noise alone is up to ΔE₀₀ 1.2 of a reading,
/// and the test is for the fitted colour below it.
#[test]
fn noise_as_large_in_black_as_in_white_is_seen_through() {
    for seed in [1, 2, 3] {
        let mut bench = seventy_one(seed);
        let readings = bench.read(Noise::Absolute(2e-3));
        let found = fitted(&bench, &readings);
        let off = off_truth(&bench, &found);
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        println!(
            "seed {seed}: truth mean {mean:.3}, worst {:.3}",
            worst(&off)
        );
        assert!(worst(&off) <= 0.7 && mean < 0.15);
        assert!((found.noise - 2e-3).abs() < 2e-4, "{}", found.noise);
    }
}

#[test]
fn swapped_shares_are_found() {
    let mut bench = seventy_one(1);
    let readings = bench.read(Noise::Relative(2e-3));
    // Sample 14 is Pyrrole Red and white 1:1; it becomes 1:9 in the table.
    bench.samples[13].shares[3] = 0.1;
    bench.samples[13].shares[0] = 0.9;
    let found = fitted(&bench, &readings);
    assert!(found.worst() > 0.5, "a fault would pass");
    assert_eq!(found.worst(), found.residuals[13].delta_e);
    assert!(
        matches!(&found.warnings[0], Warning::Suspect { line: 15, sample, .. } if sample == "14"),
        "{:?}",
        found.warnings
    );
}

#[test]
fn exact_readings_give_k_and_s_back() {
    let mut bench = seventy_one(7);
    let readings = bench.read(Noise::None);
    let off = |found: &Fit| {
        let mut worst = 0.0f64;
        for (paint, got) in bench.paints.iter().zip(&found.paints) {
            for (want, got) in [(&paint.k, &got.k), (&paint.s, &got.s)] {
                for (want, got) in want.0.iter().zip(&got.0) {
                    worst = worst.max((got / want - 1.0).abs());
                }
            }
        }
        worst
    };
    let found = fitted(&bench, &readings);
    println!("{:e}", off(&found));
    assert!(off(&found) < 1e-4);
    let mut faulty = readings.clone();
    faulty[20].iter_mut().for_each(|r| *r *= 1.001);
    assert!(off(&fitted(&bench, &faulty)) > 1e-4, "a fault would pass");
}

/// Eq. 7.7 as printed, with unweighted rows: root mean square of R − R_fit over the dark samples.
#[test]
fn weighted_rows_keep_dark_and_light_samples_apart() {
    let mut bench = seventy_one(4);
    let readings = bench.read(Noise::Absolute(2e-3));
    let found = fitted(&bench, &readings);
    let n = ELEVEN.len();
    let (mut plain, mut ours, mut count) = (0.0, 0.0, 0.0);
    for i in (5..101).step_by(8) {
        let mut equations = NormalEquations::new(2 * n);
        for (sample, row) in bench.samples.iter().zip(&readings) {
            let r = bench.surface.internal(row[i]).clamp(1e-3, 0.9999);
            let q = (1.0 - r) * (1.0 - r) / (2.0 * r);
            let terms = |j: usize| [(j, sample.shares[j]), (n + j, -q * sample.shares[j])];
            equations.add(&(0..n).flat_map(terms).collect::<Vec<_>>(), 0.0);
        }
        let mut bounds = vec![Bound::Above(0.0); 2 * n];
        bounds[n] = Bound::Fixed(1.0);
        let x = minimise(&equations, &bounds).expect("solved");
        assert!(x.iter().all(|value| *value >= -1e-9));
        for (sample, row) in bench.samples.iter().zip(&readings) {
            let sum = |values: &[f64]| {
                values
                    .iter()
                    .zip(&sample.shares)
                    .map(|(v, c)| v * c)
                    .sum::<f64>()
            };
            let read = |k, s| bench.surface.reading(km::opaque(k, s)).0 - row[i];
            let at = |which: fn(&maulstick_optics::Paint) -> &Spectrum| {
                sum(&found
                    .paints
                    .iter()
                    .map(|paint| which(paint).0[i])
                    .collect::<Vec<_>>())
            };
            let off = read(sum(&x[..n]).max(0.0), sum(&x[n..]).max(1e-9));
            plain += off * off;
            let off = read(at(|paint| &paint.k), at(|paint| &paint.s));
            ours += off * off;
            count += 1.0;
        }
    }
    let rms = |sum: f64| (sum / count).sqrt();
    println!("unweighted {:.5}, weighted {:.5}", rms(plain), rms(ours));
    assert!(rms(ours) < 2.2e-3 && rms(plain) > 3.0 * rms(ours));
}

#[test]
fn a_coarse_grid_is_enough() {
    let mut bench = seventy_one(2);
    bench.wavelengths_nm = support::grid(380.0, 730.0, 10.0);
    let readings = bench.read(Noise::Relative(2e-3));
    let found = fitted(&bench, &readings);
    println!(
        "10 nm: worst {:.3}, truth {:.3}",
        found.worst(),
        worst(&off_truth(&bench, &found))
    );
    assert!(found.worst() <= 0.5 && worst(&off_truth(&bench, &found)) <= 0.5);
}

/// Three paints by masstone, three drawdowns each, and a mixture each; their white scatters .7 times
/// as much as that of the paint files.
fn drawdowns() -> Bench {
    let mut bench = Bench::new(&THREE, 5);
    for paint in &mut bench.paints {
        let values = paint.k.0.iter_mut().chain(&mut paint.s.0);
        values.for_each(|value| *value *= 0.7);
    }
    for j in 0..3 {
        bench.mix(&[(j, 1.0)]);
        for (um, over, ground) in [
            (30.0, "0.04", 0.04),
            (30.0, "0.8", 0.8),
            (80.0, "0.04", 0.04),
        ] {
            bench.mix(&[(j, 1.0)]).film = Some((um, over.into(), ground));
        }
    }
    bench.mix(&[(0, 0.5), (1, 0.5)]);
    bench.mix(&[(0, 0.5), (2, 0.5)]);
    bench
}

#[test]
fn drawdowns_give_k_and_s_per_metre() {
    let mut bench = drawdowns();
    let exact = bench.read(Noise::None);
    let found = fitted(&bench, &exact);
    for (paint, got) in bench.paints.iter().zip(&found.paints) {
        for i in 0..101 {
            let off = got.s.0[i] / paint.s.0[i] - 1.0;
            assert!(
                off.abs() < 1e-3,
                "{} {}: {off:e}",
                paint.name,
                wavelength(i)
            );
        }
    }
    let s_per_m = found.white_s_per_m.expect("measured");
    assert!((s_per_m / 105_000.0 - 1.0).abs() < 1e-4, "{s_per_m}");
    let file = paint_file(&found);
    let mut notes = file
        .lines()
        .filter_map(|line| line.strip_prefix("# white S per m: "));
    let mean = notes.next().and_then(|note| note.split(' ').next());
    assert_eq!(mean, Some("105000"));
    let noisy = bench.read(Noise::Relative(2e-3));
    let found = fitted(&bench, &noisy);
    assert!(
        worst(&off_truth(&bench, &found)) < 0.3,
        "{:?}",
        off_truth(&bench, &found)
    );
    // Thicker by a fifth than reported.
    for sample in &mut bench.samples {
        if let Some((um, _, _)) = &mut sample.film {
            *um *= 1.2;
        }
    }
    let s_per_m = fitted(&bench, &noisy).white_s_per_m.expect("measured");
    assert!(
        (s_per_m / 105_000.0 - 1.0 / 1.2).abs() < 1e-2,
        "a fault would pass: {s_per_m}"
    );
}

#[test]
fn a_paint_known_by_its_masstone_alone_is_told_and_guessed() {
    let mut bench = Bench::new(&THREE, 5);
    (0..3).for_each(|j| {
        bench.mix(&[(j, 1.0)]);
    });
    bench.mix(&[(0, 0.5), (2, 0.5)]);
    let readings = bench.read(Noise::Absolute(1e-3));
    let found = fitted(&bench, &readings);
    let [warning] = found.warnings.as_slice() else {
        panic!("{:?}", found.warnings);
    };
    let Warning::Indeterminate { paint, white, .. } = warning else {
        panic!("{warning:?}");
    };
    assert_eq!([paint, white], ["Ultramarine Blue", "Titanium White"]);
    assert!(found.worst() < 0.5, "{:?}", found.residuals);
    let scattering = found.paints[1].s.0.map(|s| s / 150_000.0);
    assert!(
        scattering.iter().all(|s| (0.005..0.5).contains(s)),
        "{scattering:?}"
    );
    // With its tints the warning goes.
    bench.mix(&[(0, 0.5), (1, 0.5)]);
    bench.mix(&[(0, 0.9), (1, 0.1)]);
    let readings = bench.read(Noise::Absolute(1e-3));
    assert!(fitted(&bench, &readings).warnings.is_empty());
}

#[test]
fn the_example_of_the_guide_is_what_it_says() {
    let table = support::guide::table();
    assert_eq!(
        table,
        include_str!("../../../docs/examples/measurements.csv"),
        "print it anew: cargo run --release -p maulstick-measure --example measurements"
    );
    let found = fit(&table, &FitOptions::default()).expect("fitted");
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    assert!(found.worst() < 0.7, "{:?}", found.residuals);
    let s_per_m = found.white_s_per_m.expect("drawdowns");
    assert!((s_per_m / 150_000.0 - 1.0).abs() < 0.05, "{s_per_m}");
    let library = PaintLibrary::parse(&paint_file(&found)).expect("read");
    let umber = library.find("burnt umber").expect("there");
    assert_eq!(umber.colour_index, "PBr7");
    assert_eq!(library.paints()[0].source, "example");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn neither_the_order_of_rows_nor_any_noise_matters(seed in 0u64..1000, turn in 1usize..13) {
        let mut bench = drawdowns();
        bench.random = rand_pcg::Pcg32::new(seed, 2);
        bench.wavelengths_nm = support::grid(400.0, 700.0, 25.0);
        let mut readings = bench.read(Noise::Absolute(1e-2));
        let one = fitted(&bench, &readings);
        for paint in &one.paints {
            prop_assert!(paint.k.0.iter().chain(&paint.s.0).all(|v| *v >= 0.0 && v.is_finite()));
        }
        prop_assert!(PaintLibrary::parse(&paint_file(&one)).is_ok());
        bench.samples.rotate_left(turn);
        readings.rotate_left(turn);
        let other = fitted(&bench, &readings);
        for (a, b) in one.paints.iter().zip(&other.paints) {
            for (a, b) in a.k.0.iter().chain(&a.s.0).zip(b.k.0.iter().chain(&b.s.0)) {
                prop_assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
            }
        }
    }
}
