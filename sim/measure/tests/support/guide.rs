//! The example of `docs/measuring.md`: readings of five paints by a 45°/0° hand spectrometer.

use maulstick_measure::surface::Surface;
use maulstick_optics::surface::SurfaceCorrection;

use super::{Bench, Noise, grid};

const PAINTS: [&str; 5] = [
    "Titanium White",
    "Hansa Yellow Opaque",
    "Pyrrole Red",
    "Ultramarine Blue",
    "Burnt Umber",
];
const SHORT: [&str; 5] = ["white", "yellow", "red", "blue", "umber"];

const NOTES: &str = "\
# Synthetic: computed from the paints that come with Maulstick, with noise of 0.001; nobody's tubes.
# `cargo run --release -p maulstick-measure --example measurements` prints this file.
# reference white: Titanium White
# surface: 0.03, 0.65
# specular: excluded
# source: example
# colour index: Titanium White = PW6; Hansa Yellow Opaque = PY74; Pyrrole Red = PR254
# colour index: Ultramarine Blue = PB29; Burnt Umber = PBr7
";

pub fn table() -> String {
    let mut bench = Bench::new(&PAINTS, 20);
    bench.wavelengths_nm = grid(380.0, 730.0, 10.0);
    bench.surface = Surface::without_gloss(SurfaceCorrection::default());
    bench.grounds = vec![("chart black".into(), 0.01), ("chart white".into(), 0.8)];
    let mut add = |name: String, parts: &[(usize, f64)]| bench.mix(parts).name = name;
    for (paint, short) in SHORT.iter().enumerate() {
        add((*short).to_owned(), &[(paint, 1.0)]);
    }
    for (paint, short) in SHORT.iter().enumerate().skip(1) {
        add(format!("{short} and white 1:1"), &[(paint, 0.5), (0, 0.5)]);
        add(format!("{short} and white 1:9"), &[(paint, 0.1), (0, 0.9)]);
    }
    add("blue and yellow 1:4".into(), &[(3, 0.2), (1, 0.8)]);
    add("red and umber 3:1".into(), &[(2, 0.75), (4, 0.25)]);
    add(
        "blue and umber 1:1 and white".into(),
        &[(3, 0.2), (4, 0.2), (0, 0.6)],
    );
    for (paint, um) in [(0, 40.0), (3, 60.0)] {
        for (name, over, ground) in [
            ("black", "chart black", 0.01),
            ("white", "chart white", 0.8),
        ] {
            let sample = bench.mix(&[(paint, 1.0)]);
            sample.name = format!("{} {um} um over {name}", SHORT[paint]);
            sample.film = Some((um, over.into(), ground));
        }
    }
    let readings = bench.read(Noise::Absolute(1e-3));
    NOTES.to_owned() + &bench.table(&readings, 4)
}
