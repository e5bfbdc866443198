//! Every paint model in a painting: strokes, undo, drying, the ledger; and properties of the marker alone.

mod dab;

use maulstick_brush::BrushFile;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_marker::{FILM_M, Marker};
use maulstick_model::interface::{PaintModel, Step, StepReport};
use maulstick_models::model_names;
use maulstick_painting::edits::{Clean, Dry, Handle, Wet};
use maulstick_painting::picture::picture;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::brush::Solve;
use maulstick_types::scene::{BrushHandling, BrushMode, CANVAS, PALETTE};
use maulstick_types::values::{BrushName, Share};

use crate::studio::{BRUSH, fill, load, mixture, painting, round, solve, state};

const BLUE: &str = "Ultramarine Blue=0.6,Titanium White=0.4";

fn brush() -> BrushFile {
    round(6.0, 48)
}

fn easel(model: &str, palette_model: &str) -> Painting {
    let setup = PaintingSetup {
        cells: [150, 100],
        wells: vec![mixture(BLUE)],
        model: model.to_owned(),
        palette_model: palette_model.to_owned(),
        ..PaintingSetup::default()
    };
    let mut painting = painting(&setup);
    painting.define_brush(BRUSH, brush());
    painting
}

/// A stroke along `x` mm at `y`, pressed to that share of the head.
fn stroke(painting: &mut Painting, number: u64, surface: u32, x: &[f64], y: f64) {
    let file = brush();
    let solve = |stroke: u64, x: f64| Solve {
        surface,
        ..solve(&file, stroke, [x, y], 0.6, [0.2, 0.3])
    };
    let mut solves: Vec<Solve> = x.iter().map(|x| solve(number, *x)).collect();
    solves.push(solve(0, 0.0));
    painting.state(BRUSH, 1, &state(solves)).expect("it fits");
}

fn seen(painting: &mut Painting) -> Vec<u8> {
    picture(painting, CANVAS).rgb
}

fn missing(painting: &mut Painting) -> i64 {
    painting.report().quanta_missing
}

#[test]
fn whatever_the_model_strokes_are_undone_redone_and_booked() {
    let mut pictures = Vec::new();
    for model in model_names() {
        let mut painting = easel(model, "impasto");
        assert_eq!(painting.model(CANVAS), Some(model));
        assert_eq!(painting.model(PALETTE), Some("impasto"));
        let bare = seen(&mut painting);
        painting.apply(load(BLUE)).expect("loaded");
        stroke(&mut painting, 1, CANVAS, &[4.0, 12.0, 22.0], 6.0);
        let once = seen(&mut painting);
        painting.apply(load("Pyrrole Red")).expect("loaded");
        stroke(&mut painting, 2, CANVAS, &[22.0, 12.0, 4.0], 8.0);
        let twice = seen(&mut painting);
        assert!(once != bare && twice != once, "{model} paints");
        assert!(!pictures.contains(&twice), "{model} as another");
        pictures.push(twice.clone());
        assert_eq!(missing(&mut painting), 0, "{model}");
        for _ in 0..2 {
            painting.undo(None).expect("done");
        }
        assert!(
            seen(&mut painting) == once,
            "{model}: a stroke and its load"
        );
        for _ in 0..2 {
            painting.undo(None).expect("done");
        }
        assert!(seen(&mut painting) == bare, "{model}");
        assert_eq!(missing(&mut painting), 0, "{model} undone");
        for _ in 0..4 {
            painting.redo(None).expect("undone");
        }
        assert!(seen(&mut painting) == twice, "{model} redone");
        assert_eq!(missing(&mut painting), 0, "{model} redone");
        let half_dry = Dry {
            share: Share::new(0.5).expect("in range"),
            ..Dry::whole(CANVAS)
        };
        painting.apply(half_dry).expect("wet");
        painting.apply(fill("Yellow Ochre", 20.0)).expect("laid");
        painting
            .apply(Wet {
                layers: None,
                region: None,
                surface: CANVAS,
            })
            .expect("dried");
        assert_eq!(
            missing(&mut painting),
            0,
            "{model} dried, laid over, wet again"
        );
    }
}

/// Wet quanta of the most of a cell, and of all cells, of the canvas.
fn lying(painting: &mut Painting) -> (f32, u64) {
    painting.commit();
    let store = painting.store(CANVAS).expect("a canvas");
    let mut most = 0.0f32;
    for tile in store
        .iter()
        .filter_map(|(_, version)| version.tile.as_ref())
    {
        let wet = tile.wet();
        let cells = wet.first().map_or(0, |(_, plane)| plane.len());
        for cell in 0..cells {
            most = most.max(wet.iter().map(|(_, plane)| plane[cell]).sum());
        }
    }
    (most, store.counts().iter().sum())
}

#[test]
fn a_marker_lays_a_film_up_to_its_most_and_pushes_and_lifts_nothing() {
    let mut painting = easel("marker", "impasto");
    painting.apply(load(BLUE)).expect("loaded");
    let film = (FILM_M / QUANTUM_M) as f32;
    for number in 1..=6 {
        stroke(&mut painting, number, CANVAS, &[4.0, 12.0, 22.0], 6.0);
    }
    let (most, once) = lying(&mut painting);
    assert!(most <= film && most > 0.99 * film, "{most} of {film}");
    stroke(&mut painting, 7, CANVAS, &[22.0, 12.0, 4.0], 6.0);
    let (_, again) = lying(&mut painting);
    assert!(again >= once && again < once + once / 10, "{once} {again}");
    // A clean brush neither pushes it nor takes it up.
    painting
        .apply(Clean {
            brush: BrushName::main(),
        })
        .expect("cleaned");
    let before = seen(&mut painting);
    stroke(&mut painting, 8, CANVAS, &[4.0, 12.0, 22.0], 6.0);
    assert!(seen(&mut painting) == before);
    assert_eq!(painting.fullness(maulstick_types::name_hash("main")), 0.0);
    // Of impasto it does both.
    let mut impasto = easel("impasto", "impasto");
    impasto.apply(fill(BLUE, 1e6 * FILM_M)).expect("laid");
    let before = seen(&mut impasto);
    stroke(&mut impasto, 1, CANVAS, &[4.0, 12.0, 22.0], 6.0);
    assert!(seen(&mut impasto) != before, "a fault would pass");
}

#[test]
fn in_the_mode_of_a_marker_it_lays_by_its_flow_up_to_the_same_film() {
    let laid = |flow: Option<f64>| {
        let mut painting = easel("marker", "impasto");
        painting.apply(load(BLUE)).expect("loaded");
        if let Some(flow) = flow {
            let handling = BrushHandling {
                mode: BrushMode::Marker,
                flow,
                ..BrushHandling::normal("main")
            };
            let handle = Handle::try_from(&handling).expect("in range");
            painting.apply(handle).expect("a brush");
        }
        stroke(&mut painting, 1, CANVAS, &[4.0, 12.0, 22.0], 6.0);
        assert_eq!(missing(&mut painting), 0);
        lying(&mut painting)
    };
    let [thin, thick, most] = [Some(1e-4), Some(4e-4), Some(0.1)].map(laid);
    let factor = thick.1 as f64 / thin.1 as f64;
    assert!((3.5..4.5).contains(&factor), "{thin:?} {thick:?}");
    assert!(thick.0 < 0.5 * most.0 && most.0 <= (FILM_M / QUANTUM_M) as f32);
    assert!(laid(None).1 > 2 * thick.1, "a fault would pass");
}

#[test]
fn its_ink_is_matt_and_paint_is_not() {
    for (model, matt) in [("marker", true), ("impasto", false)] {
        let mut painting = easel(model, "impasto");
        painting.apply(fill(BLUE, 1e6 * FILM_M)).expect("laid");
        let banded = maulstick_painting::picture::banded(&mut painting, CANVAS).expect("a canvas");
        let (id, tile) = banded.tiles(0).next().expect("a tile");
        let shown = banded.shown(id, tile, &mut Default::default());
        assert_eq!(
            shown.gloss.iter().all(|gloss| *gloss == 0.0),
            matt,
            "{model}"
        );
    }
}

/// A marker that loses a quantum of a slot at each step that leaves any.
#[derive(Default)]
struct Leaky(Marker);

impl PaintModel for Leaky {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn step(&mut self, step: &mut Step<'_>) -> StepReport {
        let report = self.0.step(step);
        let lost = step.window.planes_mut().find_map(|(_, plane)| {
            let cell = plane.iter_mut().find(|count| **count > 0.0)?;
            *cell -= 1.0;
            Some(())
        });
        lost.map_or(report, |()| report)
    }
}

#[test]
fn a_model_that_loses_a_quantum_is_found() {
    let lost = |leaky: bool| {
        let mut painting = easel("marker", "impasto");
        if leaky {
            painting.set_model(Box::new(Leaky::default()));
        }
        painting.apply(load("Bone Black")).expect("loaded");
        stroke(&mut painting, 1, CANVAS, &[10.0, 11.0], 6.0);
        missing(&mut painting)
    };
    assert_eq!(lost(false), 0);
    assert!(lost(true) > 0);
}

#[test]
fn the_palette_has_a_model_of_its_own() {
    let loaded = |palette_model: &str| {
        let mut painting = easel("marker", palette_model);
        let well = painting.scene().surfaces[1].wells[0]
            .center_m
            .map(|m| m * 1e3);
        let ways = [well[0] - 2.0, well[0], well[0] + 2.0];
        stroke(&mut painting, 1, PALETTE, &ways, well[1]);
        assert_eq!(missing(&mut painting), 0);
        painting.fullness(maulstick_types::name_hash("main"))
    };
    assert!(loaded("impasto") > 0.0, "it takes paint up");
    assert_eq!(loaded("marker"), 0.0);
}
