//! A stroke is the same painting however often the device samples it.

use maulstick_brush::BrushFile;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_num::{sin, sin_cos};
use maulstick_optics::PaintLibrary;
use maulstick_optics::colour::delta_e_2000;
use maulstick_painting::edits::Handle;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_session::Offline;
use maulstick_types::scene::{BrushHandling, BrushMode};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};

const SECONDS: f64 = 2.0;
/// Thinner paint in both pictures is not compared, m.
const THIN_M: f64 = 1e-6;

/// The pen at `t` seconds: an S of changing pressure that crosses itself once.
fn pen(t: f64) -> StylusSample {
    let u = t / SECONDS;
    let (s, c) = sin_cos(2.0 * std::f64::consts::PI * (1.3 * u - 0.15));
    let pressure = 0.15 + 0.5 * sin(std::f64::consts::PI * u);
    StylusSample {
        pose: StylusPose::Contact {
            point_m: [0.032 * c + 0.004 * (u - 0.5), 0.024 * s, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

fn painted(rate_hz: f64, length: f64) -> Painting {
    painted_on(1, rate_hz, length)
}

/// The stroke on a canvas whose cells are `finer` times as small.
fn painted_on(finer: u32, rate_hz: f64, length: f64) -> Painting {
    painted_as(BrushMode::Normal, finer, rate_hz, length)
}

fn painted_as(mode: BrushMode, finer: u32, rate_hz: f64, length: f64) -> Painting {
    let setup = PaintingSetup {
        cells: [finer * 384, finer * 320],
        cell_m: 2.5e-4 / f64::from(finer),
        ..PaintingSetup::default()
    };
    let painting = Painting::new(&setup, PaintLibrary::measured().expect("whole")).expect("one");
    let file = BrushFile::library("round").expect("round");
    let load = "Ultramarine Blue=0.6,Titanium White=0.4"
        .parse()
        .expect("a mixture");
    let mut offline = Offline::new(painting, "main", file, 0.5, vec![load]).expect("set up");
    let handling = BrushHandling {
        mode,
        ..BrushHandling::normal("main")
    };
    let command = Handle::try_from(&handling).expect("in range");
    offline.edit(command).expect("a mode");
    let count = (length * SECONDS * rate_hz) as u64;
    for i in 0..=count {
        let t = i as f64 / rate_hz;
        let ns = 1_000_000_000 + (t * 1e9) as u64;
        offline.sample(ns, &pen(t)).expect("painted");
    }
    offline.into_painting()
}

/// Films of every cell, m: blue and white.
fn films(painting: &Painting) -> Vec<[f64; 2]> {
    let store = painting.store(0).expect("a canvas");
    let mut films = Vec::new();
    for (_, version) in store.iter() {
        let mut cells = vec![[0.0; 2]; TILE_CELLS];
        for (slot, plane) in version.tile.iter().flat_map(|tile| tile.wet().to_vec()) {
            for (cell, count) in cells.iter_mut().zip(plane.iter()) {
                cell[slot] = f64::from(*count) * QUANTUM_M;
            }
        }
        films.extend(cells);
    }
    films
}

/// Relative difference of the deposited volumes; mean and 99th percentile of ΔE₀₀.
fn compare(one: &Painting, two: &Painting) -> [f64; 3] {
    let (a, b) = (films(one), films(two));
    let ground = one.bare(0).expect("a canvas").ground.mean().to_vec();
    let volume = |films: &[[f64; 2]]| films.iter().flatten().sum::<f64>();
    let lab = |film: &[f64; 2]| {
        one.look()
            .studio
            .lab(&[(0, film[0]), (1, film[1])], &ground)
    };
    let mut errors: Vec<f64> = a
        .iter()
        .zip(&b)
        .filter(|(p, q)| p[0] + p[1] > THIN_M || q[0] + q[1] > THIN_M)
        .map(|(p, q)| delta_e_2000(lab(p), lab(q)))
        .collect();
    errors.sort_by(f64::total_cmp);
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let worst = errors[errors.len() * 99 / 100];
    [(volume(&b) / volume(&a) - 1.0).abs(), mean, worst]
}

#[test]
fn the_sample_rate_does_not_show() {
    let finest = painted(1000.0, 1.0);
    for rate in [500.0, 250.0, 125.0] {
        let [volume, mean, worst] = compare(&finest, &painted(rate, 1.0));
        println!(
            "{rate} Hz: volume {:.3} %, ΔE₀₀ mean {mean:.3}, 99 % {worst:.3}",
            100.0 * volume
        );
        assert!(volume < 0.01, "{rate} Hz: volume differs by {volume}");
        assert!(mean < 1.0 && worst < 3.0, "{rate} Hz: ΔE₀₀ {mean}, {worst}");
    }
}

/// Half as large cells: a brush leaves the same by area within 5 %, whether it runs out or not.
#[test]
fn the_size_of_cells_hardly_shows() {
    let volume = |mode: &BrushMode, finer: u32, length: f64| {
        let painting = painted_as(mode.clone(), finer, 250.0, length);
        let metres: f64 = films(&painting).iter().flatten().sum();
        metres / f64::from(finer * finer)
    };
    let cases = [
        ("a brush that runs out", BrushMode::Normal, 0.6, 0.05),
        ("one that does not", BrushMode::Sponge, 0.6, 0.05),
    ];
    for (what, mode, shorter, most) in cases {
        let whole = volume(&mode, 1, 1.0);
        let apart = |length: f64| (volume(&mode, 2, length) / whole - 1.0).abs();
        let off = apart(1.0);
        println!("half as large cells, {what}: {:.2} %", 100.0 * off);
        assert!(off < most, "{what}: {off}");
        let fault = apart(shorter);
        assert!(fault > most, "{what}: a shorter stroke passes: {fault}");
    }
}

#[test]
fn a_stroke_that_ends_earlier_would_be_seen() {
    let finest = painted(1000.0, 1.0);
    let [volume, _, worst] = compare(&finest, &painted(1000.0, 0.8));
    assert!(volume > 0.01 && worst > 3.0, "{volume} {worst}");
}
