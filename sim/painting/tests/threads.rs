//! However many threads share a step, and whatever size its brush, it paints the same bytes.

use maulstick_brush::BrushFile;
use maulstick_impasto::Impasto;
use maulstick_model::interface::{PaintModel, Step, StepReport};
use maulstick_num::fork_join::{threads, with_threads};
use maulstick_optics::PaintLibrary;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::edits::{Fill, FillPaint, Load};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{BrushName, FilmThickness};
use maulstick_types::{Mixture, Pose};

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

/// Its footprint is done by one core or two.
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
fn painted(size: Size, model: Option<Box<dyn PaintModel>>) -> Vec<(usize, u32, u32, Vec<f32>)> {
    let mut file = BrushFile::library("round").expect("round");
    file.strips.count = size.strips;
    let file = file.scaled_to(size.mm).expect("a size");
    let side = if size.mm > 20.0 { 512 } else { 128 };
    let setup = PaintingSetup {
        cells: [side; 2],
        ..PaintingSetup::default()
    };
    let library = PaintLibrary::measured().expect("whole");
    let mut painting = Painting::new(&setup, library).expect("a painting");
    if let Some(model) = model {
        painting.set_model(model);
    }
    painting.define_brush("main", file.clone());
    let mixture: Mixture = FILM.parse().expect("a mixture");
    let load = Load {
        mixture: mixture.clone(),
        beside: None,
        brush: BrushName::main(),
    };
    painting.apply(load).expect("known");
    let fill = Fill {
        paint: FillPaint::Mixture { mixture },
        thickness: FilmThickness::new(120e-6).expect("in range"),
        surface: CANVAS,
    };
    painting.apply(fill).expect("a canvas");
    let size_m = f64::from(side) * setup.cell_m;
    let solves = (0..=size.solves).map(|at| {
        let along = at as f64 / size.solves as f64;
        Solve {
            event_ns: 0,
            // The brush is lifted at the end, and what it left levels.
            stroke: u64::from(at < size.solves),
            surface: CANVAS,
            flags: 0,
            pose: Pose {
                position_m: [
                    (0.35 + 0.3 * along) * size_m,
                    (0.5 + 0.1 * along * along) * size_m,
                    (0.45 + 2.0 * f64::from(u8::from(at == size.solves))) * file.length_m(),
                ],
                orientation: [0.0, 0.0, 0.0, 1.0],
            },
            zoom: 1.0,
            angles_rad: vec![[0.3, 0.2]; file.spines.all_joints()],
            contacts: Vec::new(),
        }
    });
    let state = BrushState {
        device: 1,
        device_epoch: 1,
        device_seq: 0,
        solves: solves.collect(),
    };
    painting.state("main", 1, &state).expect("it fits");
    painting.commit();
    assert_eq!(painting.report().quanta_missing, 0);
    assert!(painting.work().0 > 20, "{:?}", painting.work());
    let store = painting.store(CANVAS).expect("a canvas");
    let tiles = store
        .iter()
        .filter_map(|(id, version)| Some((id, version.tile.as_ref()?)));
    tiles
        .flat_map(|(id, tile)| {
            let planes: Vec<_> = tile
                .wet()
                .iter()
                .map(|(slot, plane)| (*slot, plane.to_vec()))
                .collect();
            planes
                .into_iter()
                .map(move |(slot, plane)| (slot, id.x, id.y, plane))
        })
        .collect()
}

#[test]
fn any_number_of_threads_paints_the_same_bytes() {
    for size in [SMALL, LARGE] {
        let alone = painted(size, None);
        for count in MANY {
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
