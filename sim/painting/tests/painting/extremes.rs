//! Brushes of one cell and of thousands, leaps and very long steps, on one thread and on many: nothing panics, no
//! quantum is lost, and every cell holds a valid number of quanta.

use maulstick_brush::BrushFile;
use maulstick_canvas::quantum::CELL_MAX;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_num::fork_join::with_threads;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::brush::{Solve, solve_flags};
use maulstick_types::scene::CANVAS;

use crate::studio::{BRUSH, load, painting, round, solve, state};

/// A brush on a canvas, and where it goes.
#[derive(Clone, Copy, Debug)]
struct Case {
    cell_m: f64,
    /// Cells of the canvas either way.
    side: u32,
    brush_mm: f64,
    strips: usize,
    flags: u32,
    /// Ways from the middle of the canvas, m.
    ways_m: &'static [[f64; 2]],
}

/// The round brush on reference cells.
const USUAL: Case = Case {
    cell_m: 2.5e-4,
    side: 128,
    brush_mm: 10.0,
    strips: 48,
    flags: 0,
    ways_m: &[[-0.008, 0.0], [0.008, 0.002], [0.0, 0.0]],
};

impl Case {
    fn brush(&self) -> BrushFile {
        round(self.brush_mm, self.strips)
    }

    /// A painting with two strokes of a full brush, lifted in between.
    fn painted(&self) -> Painting {
        let mut painting = painting(&PaintingSetup {
            cells: [self.side; 2],
            cell_m: self.cell_m,
            ..PaintingSetup::default()
        });
        let file = self.brush();
        painting.define_brush(BRUSH, file.clone());
        let middle_mm = 0.5e3 * f64::from(self.side) * self.cell_m;
        for (stroke, paint) in (1..).zip(["Titanium White", "Ultramarine Blue"]) {
            painting.apply(load(paint)).expect("known");
            let solves = self.ways_m.iter().map(|way| Solve {
                flags: self.flags,
                ..solve(
                    &file,
                    stroke,
                    way.map(|m| middle_mm + 1e3 * m),
                    0.5,
                    [0.1, 0.2],
                )
            });
            painting.state(BRUSH, 1, &state(solves)).expect("it fits");
        }
        painting.commit();
        painting
    }

    /// Paints on one thread and on many, with the same result and without loss.
    fn holds(&self) {
        let counts = |painting: &mut Painting| {
            assert_eq!(painting.report().quanta_missing, 0, "{self:?}");
            let [steps, cells] = <[u64; 2]>::from(painting.work());
            assert!(
                steps > 0 && cells > 0,
                "{self:?}: {steps} steps, {cells} cells"
            );
            let store = painting.store(CANVAS).expect("a canvas");
            let tiles = store
                .iter()
                .filter_map(|(_, version)| version.tile.as_ref());
            let planes = tiles.flat_map(|tile| tile.wet().to_vec());
            let counts: Vec<f32> = planes.flat_map(|(_, plane)| plane.to_vec()).collect();
            let fine =
                |count: &f32| (0.0..=CELL_MAX as f32).contains(count) && count.fract() == 0.0;
            assert!(counts.iter().all(fine), "{self:?}");
            assert!(counts.iter().any(|count| *count > 0.0), "{self:?} paints");
            counts
        };
        let alone = counts(&mut self.painted());
        let shared = with_threads(64, || counts(&mut self.painted()));
        assert!(alone == shared, "{self:?}");
    }
}

#[test]
fn a_brush_of_one_cell_paints() {
    let case = Case {
        cell_m: 2e-3,
        brush_mm: 2.0,
        ways_m: &[[-0.04, 0.0], [0.04, 0.01], [0.0, 0.0]],
        ..USUAL
    };
    case.holds();
}

#[test]
fn a_brush_of_4096_cells_paints() {
    let case = Case {
        cell_m: 1e-5,
        side: 320,
        brush_mm: 40.96,
        strips: 480,
        ways_m: &[[-0.001, 0.0], [0.001, 0.0]],
        ..USUAL
    };
    case.holds();
}

#[test]
fn a_leap_of_a_metre_and_back_paints() {
    let case = Case {
        ways_m: &[
            [0.0, 0.0],
            [1.0, 0.0],
            [0.002, 0.001],
            [0.0, -1.0],
            [0.0, 0.0],
        ],
        ..USUAL
    };
    case.holds();
}

#[test]
fn a_step_of_64_cells_paints() {
    let case = Case {
        cell_m: 2.5e-4 * 4.0 / 64.0,
        side: 512,
        flags: solve_flags::FOUR_TIMES,
        ways_m: &[[-0.002, 0.0], [0.002, 0.0005]],
        ..USUAL
    };
    let traits = BrushTraits::of(&case.brush(), case.cell_m, 1.0).doubled(2);
    assert!((traits.step_cells - 64.0).abs() < 1e-3, "{traits:?}");
    case.holds();
}
