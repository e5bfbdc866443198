//! Any number of threads paints the same bytes, with a brush of any size.

use maulstick_impasto::Impasto;
use maulstick_model::interface::{PaintModel, Step, StepReport};
use maulstick_num::fork_join::{threads, with_threads};
use maulstick_painting::PaintingSetup;

use crate::studio::{BRUSH, WetPlane, fill, load, painting, round, solve, state, wet_paint};

const FILM: &str = "Ultramarine Blue=0.25,Titanium White=0.25,Yellow Ochre=0.25,Pyrrole Red=0.25";
/// More than one, up to more than any machine gives.
const MANY: [usize; 5] = [2, 4, 8, 16, 64];

/// Width of a brush, its strips, and the steps of its stroke.
#[derive(Clone, Copy)]
struct Size {
    mm: f64,
    strips: usize,
    solves: usize,
}

/// Its footprint needs one or two cores.
const SMALL: Size = Size {
    mm: 5.0,
    strips: 48,
    solves: 60,
};
/// Its footprint has work for dozens.
const LARGE: Size = Size {
    mm: 70.0,
    strips: 512,
    solves: 12,
};

/// All wet paint of the canvas after a stroke over a wet film, levelled once it has ended: slot, tile and counts.
fn painted(size: Size, model: Option<Box<dyn PaintModel>>) -> Vec<WetPlane> {
    let file = round(size.mm, size.strips);
    let side = if size.mm > 20.0 { 512 } else { 128 };
    let setup = PaintingSetup {
        cells: [side; 2],
        ..PaintingSetup::default()
    };
    let mut painting = painting(&setup);
    if let Some(model) = model {
        painting.set_model(model);
    }
    painting.define_brush(BRUSH, file.clone());
    painting.apply(load(FILM)).expect("known");
    painting.apply(fill(FILM, 120.0)).expect("a canvas");
    let size_mm = 1e3 * f64::from(side) * setup.cell_m;
    let solves = (0..=size.solves).map(|at| {
        let along = at as f64 / size.solves as f64;
        let place = [0.35 + 0.3 * along, 0.5 + 0.1 * along * along];
        // The brush is lifted at the end, and its paint levels.
        let lifted = at == size.solves;
        let height = 0.45 + 2.0 * f64::from(u8::from(lifted));
        let place_mm = place.map(|share| share * size_mm);
        solve(&file, u64::from(!lifted), place_mm, height, [0.3, 0.2])
    });
    painting.state(BRUSH, 1, &state(solves)).expect("it fits");
    painting.commit();
    assert_eq!(painting.report().quanta_missing, 0);
    assert!(painting.work().0 > 20, "{:?}", painting.work());
    wet_paint(&painting)
}

#[test]
fn any_number_of_threads_paints_the_same_bytes() {
    for (size, counts) in [(SMALL, &MANY[..]), (LARGE, &[64])] {
        let alone = painted(size, None);
        for &count in counts {
            let shared = with_threads(count, || painted(size, None));
            assert!(
                alone == shared,
                "{count} threads, a brush of {} mm",
                size.mm
            );
        }
    }
}

/// A model that adds up in another order with each number of threads.
struct Unordered(Impasto);

impl PaintModel for Unordered {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn step(&mut self, step: &mut Step<'_>) -> StepReport {
        let quanta = step
            .window
            .planes()
            .flat_map(|(_, plane)| plane.chunks(plane.len() / threads()));
        let sum: f32 = quanta.map(|share| share.iter().sum::<f32>()).sum();
        step.stain += sum % 1024.0;
        self.0.step(step)
    }
}

#[test]
fn an_order_that_depends_on_the_threads_is_found_out() {
    let painted = || painted(SMALL, Some(Box::new(Unordered(Impasto::default()))));
    let alone = painted();
    assert!(alone == painted(), "one thread does the same again");
    assert!(
        MANY.iter()
            .any(|count| with_threads(*count, painted) != alone)
    );
}
