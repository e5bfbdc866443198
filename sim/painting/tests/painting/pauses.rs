//! Pauses between the samples of a stroke: a short one leaves no hole, a long one no scar.

use std::ops::Range;

use maulstick_brush::BrushFile;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_painting::Painting;
use maulstick_painting::edits::Undo;
use maulstick_types::paint::TILE;
use maulstick_types::scene::CANVAS;

use crate::studio::Drawing;

const CELL_MM: f64 = 0.25;
const SIZE_MM: [f64; 2] = [96.0, 32.0];
/// Interval of samples, ms.
const STEP_MS: u64 = 4;
/// Length of the stroke, ms.
const STROKE_MS: u64 = 1200;
/// Pace of the hand, mm a ms.
const PACE: f64 = 0.06;

/// Tolerated difference of a continued stroke's columns from those without a pause, as a share: a head that lands
/// straight down leaves .07 for a round and .14 for a flat.
const SCAR: f64 = 0.05;

/// The device after a pause.
#[derive(Clone, Copy, PartialEq)]
enum After {
    Same,
    /// Another one, for which the brush lands again.
    Another,
}

/// Motion of the hand in a pause.
#[derive(Clone, Copy, PartialEq)]
enum Hand {
    Moves,
    Rests,
}

struct Stroke {
    /// Film of each cell, row after row, µm.
    cells: Vec<f64>,
    /// Numbers of the strokes that the brush made of it.
    numbers: Vec<u64>,
    /// Steps that could be undone, the load among them.
    undone: usize,
}

/// Place of the pen's point along the canvas after a motion, mm.
fn along(moved_ms: u64) -> f64 {
    12.0 + PACE * moved_ms as f64
}

/// A stroke without the samples of a pause.
fn stroke(kind: &str, pause: Range<u64>, hand: Hand, after: After) -> Stroke {
    let mut drawing = Drawing::new(BrushFile::library(kind).expect(kind), SIZE_MM, CELL_MM);
    let rested = match hand {
        Hand::Moves => 0,
        Hand::Rests => pause.end - pause.start,
    };
    let mut numbers = Vec::new();
    let times = (0..=STROKE_MS + rested).step_by(STEP_MS as usize);
    for ms in times.filter(|ms| !(pause.start + 1..pause.end).contains(ms)) {
        let moved_ms = if ms > pause.start { ms - rested } else { ms };
        // A head that lands against the lean of the pen is bent opposite to a drawn one.
        let x = match hand {
            Hand::Moves => along(moved_ms),
            Hand::Rests => SIZE_MM[0] - along(moved_ms),
        };
        // A flat draws with its broad side.
        let twist_rad = std::f64::consts::FRAC_PI_2;
        let pressure = if ms == 0 { 0.0 } else { 0.4 };
        let epoch = 1 + u32::from(after == After::Another && ms > pause.start);
        let x_m = 1e-3 * (x - 0.5 * SIZE_MM[0]);
        numbers.extend(drawing.sample(ms, x_m, [twist_rad, pressure], epoch));
    }
    numbers.retain(|number| *number > 0);
    numbers.dedup();
    let film = film(drawing.sequencer.painting_mut());
    let undo = || Undo { brush: None };
    let undone = (0..8)
        .take_while(|_| drawing.sequencer.edit(undo()).is_ok())
        .count();
    Stroke {
        cells: film,
        numbers,
        undone,
    }
}

/// Wet film of each cell of a canvas, µm.
fn film(painting: &mut Painting) -> Vec<f64> {
    let cells = SIZE_MM.map(|mm| (mm / CELL_MM) as u32);
    painting.commit();
    let [width, height] = cells.map(|cells| cells as usize);
    let mut film = vec![0.0; width * height];
    let store = painting.store(CANVAS).expect("a canvas");
    for (id, version) in store.iter() {
        for (_, plane) in version.tile.iter().flat_map(|tile| tile.wet().to_vec()) {
            for (cell, count) in plane.iter().enumerate() {
                let x = id.x as usize * TILE + cell % TILE;
                let y = id.y as usize * TILE + cell / TILE;
                if x < width && y < height {
                    film[y * width + x] += f64::from(*count) * 1e6 * QUANTUM_M;
                }
            }
        }
    }
    film
}

impl Stroke {
    /// Mean film of each millimetre from left to right, µm.
    fn columns(&self) -> Vec<f64> {
        let width = (SIZE_MM[0] / CELL_MM) as usize;
        let mut columns = vec![0.0; SIZE_MM[0] as usize];
        for (cell, film) in self.cells.iter().enumerate() {
            columns[((cell % width) as f64 * CELL_MM) as usize] += film;
        }
        let in_column = self.cells.len() as f64 / columns.len() as f64;
        columns.iter().map(|film| film / in_column).collect()
    }

    /// The same with a third of the film of a millimetre gone: the fault that is seeded.
    fn notched(&self, place: f64) -> Self {
        let width = (SIZE_MM[0] / CELL_MM) as usize;
        let is_there = |cell: usize| ((cell % width) as f64 * CELL_MM) as usize == place as usize;
        let cells = self.cells.iter().enumerate();
        Self {
            cells: cells
                .map(|(cell, film)| film * if is_there(cell) { 2.0 / 3.0 } else { 1.0 })
                .collect(),
            numbers: self.numbers.clone(),
            undone: self.undone,
        }
    }

    /// Difference of the film of its columns from another's within 8 mm of a place, relative to the film there: each
    /// stroke has its own streaks.
    fn apart(&self, other: &Self, place: f64) -> f64 {
        let (mut apart, mut whole) = (0.0, 0.0);
        for (column, (a, b)) in self.columns().iter().zip(other.columns()).enumerate() {
            if (column as f64 - place).abs() < 8.0 {
                apart += (a - b).powi(2);
                whole += b.powi(2);
            }
        }
        (apart / whole).sqrt()
    }
}

/// The least and the most film from a place to another, mm, beside the mean of the 8 mm around them.
fn beside_neighbours(films: &[f64], from: f64, to: f64) -> [f64; 2] {
    let (from, to) = (from.floor() as usize, to.ceil() as usize);
    let within = &films[from..to];
    let around = [&films[from - 8..from], &films[to..to + 8]].concat();
    let mean = around.iter().sum::<f64>() / around.len() as f64;
    let least = within.iter().copied().fold(f64::MAX, f64::min);
    let most = within.iter().copied().fold(0.0, f64::max);
    [least / mean, most / mean]
}

#[test]
fn a_short_pause_leaves_no_hole() {
    for kind in ["round", "flat"] {
        for pause_ms in [110, 250] {
            let (from, to) = (600, 600 + pause_ms / STEP_MS * STEP_MS);
            let least = |after: After| {
                let stroke = stroke(kind, from..to, Hand::Moves, after);
                (
                    beside_neighbours(&stroke.columns(), along(from), along(to)),
                    stroke,
                )
            };
            let ([bridged, most], whole) = least(After::Same);
            let ([holed, _], _) = least(After::Another);
            println!("{kind}, {pause_ms} ms: {bridged:.2} to {most:.2}; landed anew {holed:.2}");
            assert!(bridged >= 0.7, "{kind}, {pause_ms} ms: a hole of {bridged}");
            assert!(most <= 1.4, "{kind}, {pause_ms} ms: a lump of {most}");
            assert!(holed < 0.3, "{kind}: a hole would not be seen: {holed}");
            assert_eq!((whole.numbers, whole.undone), (vec![1], 2));
        }
    }
}

#[test]
fn after_a_long_pause_the_stroke_begins_anew_without_a_scar() {
    for kind in ["round", "flat"] {
        let painted = |until_ms: u64, after: After| stroke(kind, 600..until_ms, Hand::Rests, after);
        let place = SIZE_MM[0] - along(600);
        let whole = painted(604, After::Same);
        let resumed = painted(1100, After::Same);
        let columns = resumed.columns();
        let [least, most] = beside_neighbours(&columns, place - 8.0, place + 8.0);
        let scar = resumed.apart(&whole, place);
        let landed = painted(1100, After::Another).apart(&whole, place);
        let notch = resumed.notched(place).apart(&whole, place);
        println!(
            "{kind}: {least:.2} to {most:.2}; scar {scar:.3}, landed anew {landed:.3}, a notch {notch:.3}"
        );
        assert!(least >= 0.7 && most <= 1.4, "{kind}: {least} to {most}");
        assert!(scar < SCAR && landed < SCAR, "{kind}: {scar} {landed}");
        assert!(notch > SCAR, "{kind}: the fault would pass: {notch}");
        assert_eq!((resumed.numbers, resumed.undone), (vec![1, 2], 3), "{kind}");
    }
}
