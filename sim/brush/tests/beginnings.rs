//! A stroke of constant pressure has a constant mark from its beginning.

use std::collections::BTreeSet;
use std::f64::consts::FRAC_PI_2;

use glam::DVec2;
use maulstick_num::{atan2, sin_cos};
use maulstick_types::brush::solve_flags;

mod desk;
#[allow(
    dead_code,
    reason = "shared by test programs, each of which uses a part"
)]
mod patch;
use patch::{Bench, CELL_M};

const START: DVec2 = DVec2::splat(0.1);
/// Path of a sample, m: 60 mm/s.
const SAMPLE_M: f64 = 0.48e-3;
/// Length of a stroke, m.
const LENGTH_M: f64 = 0.03;
/// Length of the beginning of a stroke, m, and of the slices across which its mark is measured.
const BEGINNING_M: f64 = 0.008;
const SLICE_M: f64 = 5e-4;
/// Weight of differences in a mark of a few hairs.
const SPARSE: f64 = 0.3;
/// Number of slices before the point where the pen is set down.
const BEFORE: usize = 40;

/// A mark: the cells to the left and right of the way that it covers, slice after slice.
struct Slices(Vec<BTreeSet<i64>>);

impl Slices {
    fn new() -> Self {
        let slices = BEFORE + (BEGINNING_M / SLICE_M) as usize;
        Self(vec![BTreeSet::new(); slices])
    }

    /// Adds cells of a mark, relative to the first point; the way goes to the right.
    fn add(&mut self, cells: impl Iterator<Item = DVec2>) {
        for p in cells {
            let slice = (p.x / SLICE_M).floor() + BEFORE as f64;
            if slice >= 0.0
                && let Some(slice) = self.0.get_mut(slice as usize)
            {
                slice.insert((p.y / CELL_M).floor() as i64);
            }
        }
    }

    /// Number of its cells of a slice that are not even neighbours of the other's.
    fn beyond(&self, other: &Self, slice: usize) -> f64 {
        let near = |cell: i64| (-1..=1).any(|off| other.0[slice].contains(&(cell + off)));
        self.0[slice].iter().filter(|cell| !near(**cell)).count() as f64
    }
}

/// The beginning of a mark beside that of a head that is bent from the first point on as it is at the end.
#[derive(Clone, Copy, Debug)]
struct Beginning {
    /// Greatest excess of its width, by that of the even mark.
    excess: f64,
    /// Greatest lack.
    lack: f64,
}

/// A stroke of constant pressure in the direction `along`, its broad side across, with a pen that rests for some
/// samples before it moves.
fn beginning(
    bench: &mut Bench,
    (tilt, along): ([f64; 2], f64),
    pressure: f64,
    rests: u32,
) -> Beginning {
    let (sine, cosine) = sin_cos(along);
    let way = DVec2::new(cosine, sine);
    let turned = |p: DVec2| DVec2::new(p.dot(way), way.perp_dot(p));
    let hold = (tilt, along + FRAC_PI_2);
    for _ in 0..3 {
        bench.pen_turned(START, hold, 0.0);
    }
    for _ in 0..rests {
        bench.pen_turned(START, hold, pressure);
    }
    let samples = (LENGTH_M / SAMPLE_M) as u32;
    let point = |sample: u32| START + way * (SAMPLE_M * f64::from(sample));
    let (mut mark, mut last) = (Slices::new(), None);
    for sample in 0..=samples {
        for solve in bench.pen_turned(point(sample), hold, pressure) {
            let is_painted = solve.flags & solve_flags::PREVIEW == 0;
            // The mark reaches farther than the point.
            if is_painted && point(sample).distance(START) < 2.0 * BEGINNING_M {
                let cells = bench.patch(&solve).into_iter();
                mark.add(cells.map(|p| turned(p - START)));
            }
            last = Some(solve);
        }
    }
    let even = bench.patch(&last.expect("a solve"));
    let even: Vec<DVec2> = even
        .into_iter()
        .map(|p| turned(p - point(samples)))
        .collect();
    let mut expected = Slices::new();
    for step in 0..(2.0 * BEGINNING_M / SLICE_M) as u32 {
        let gone = DVec2::new(SLICE_M * f64::from(step), 0.0);
        expected.add(even.iter().map(|p| *p + gone));
    }
    let slices = 0..mark.0.len();
    let widths = expected.0.iter().map(BTreeSet::len);
    let whole = widths.max().unwrap_or(0) as f64;
    let mut found = Beginning {
        excess: 0.0,
        lack: 0.0,
    };
    for slice in slices {
        found.excess = found.excess.max(mark.beyond(&expected, slice) / whole);
        if expected.0[slice].len() as f64 > 0.5 * whole {
            found.lack = found.lack.max(expected.beyond(&mark, slice) / whole);
        }
    }
    found
}

/// Tilts of a pen that leans by `lean` degrees toward the azimuth `toward`, rad.
fn tilts(lean: f64, toward: f64) -> [f64; 2] {
    let (sine, cosine) = sin_cos(lean.to_radians());
    let (y, x) = sin_cos(toward);
    [x, y].map(|part| atan2(part * sine, cosine))
}

#[test]
fn a_stroke_of_constant_pressure_has_a_constant_mark_from_its_beginning() {
    let mut faults = Vec::new();
    let mut resting = 0.0_f64;
    for kind in ["round", "flat", "filbert", "badger", "liner", "mop", "fude"] {
        let mut bench = Bench::new(kind);
        let mut worst = Beginning {
            excess: 0.0,
            lack: 0.0,
        };
        for lean in [0.0, 30.0] {
            for along in [0.3, 3.6] {
                for pressure in [0.2, 0.5, 1.0] {
                    let way = (tilts(lean, -0.785), along);
                    let at_once = beginning(&mut bench, way, pressure, 0);
                    println!(
                        "{kind:8} {lean:2}° {along:4.1} {pressure:.1}: excess {:.2} lack {:.2}",
                        at_once.excess, at_once.lack
                    );
                    // An upright head in light contact marks with a few hairs, irregularly.
                    let share = if lean == 0.0 && pressure < 0.5 {
                        SPARSE
                    } else {
                        1.0
                    };
                    worst.excess = worst.excess.max(share * at_once.excess);
                    worst.lack = worst.lack.max(share * at_once.lack);
                }
            }
        }
        // The seeded fault: the head is lowered straight down, and dragged then.
        let way = (tilts(0.0, -0.785), 0.3);
        resting = resting.max(beginning(&mut bench, way, 1.0, 16).excess);
        println!("{kind:8} worst {worst:.2?}");
        if worst.excess > 0.25 || worst.lack > 0.25 {
            faults.push(format!("{kind}: {worst:.2?}"));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(resting > 0.7, "an anvil passes: {resting}");
}
