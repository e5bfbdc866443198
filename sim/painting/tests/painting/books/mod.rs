//! After any sequence of edits, the tubes gave exactly the paint that is found.

mod acts;

use maulstick_brush::BrushFile;
use maulstick_brush::palette_place::{mirrored, size_m};
use maulstick_canvas::quantum::{CELL_MAX, SLOTS};
use maulstick_num::fork_join::with_threads;
use maulstick_painting::edits::{
    Clean, Convert, Dry, Fill, FillPaint, Handle, LayerRef, Load, Opacity, Piles, Scrape, Size,
    Wells,
};
use maulstick_painting::setup::wells_of;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::Mixture;
use maulstick_types::brush::{BrushState, Solve, solve_flags};
use maulstick_types::scene::{BrushHandling, BrushMode, CANVAS, PALETTE};
use maulstick_types::values::{
    BrushName, FilmThickness, LayerName, ModelName, OpacityFactor, Share, StainThickness,
};
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

use acts::{act, perform, way};

use crate::studio::{self, mixture, round, state};

const BRUSHES: [&str; 2] = ["main", "other"];
const MIXTURES: [&str; 3] = [
    "Titanium White",
    "Ultramarine Blue=0.6,Titanium White=0.4",
    "Yellow Ochre=0.5,Pyrrole Red=0.25,Bone Black=0.25",
];

fn load(brush: &str, mixture: Mixture) -> Load {
    let (beside, brush) = (None, BrushName::new(brush).expect("a name"));
    Load {
        mixture,
        beside,
        brush,
    }
}

fn dry(surface: u32, share: f32, name: &str) -> Dry {
    Dry {
        share: Share::new(share).expect("in range"),
        layer: LayerName::new(name).ok(),
        ..Dry::whole(surface)
    }
}

fn opacity(number: u32, opacity: f32) -> Opacity {
    Opacity {
        layer: LayerRef::Number { number },
        opacity: OpacityFactor::new(opacity).expect("in range"),
    }
}

/// A canvas of 16 mm and a palette with three wells.
fn painting(size_mm: f64) -> Painting {
    let setup = PaintingSetup {
        cells: [64, 64],
        wells: MIXTURES.map(mixture).to_vec(),
        ..PaintingSetup::default()
    };
    let mut painting = studio::painting(&setup);
    for name in BRUSHES {
        painting.define_brush(name, round(size_mm, 48));
    }
    painting
}

/// Place of a brush: ferrule, bend of its joints, rotation.
#[derive(Clone, Copy, Debug)]
struct Place {
    surface: u32,
    /// Place of the ferrule, mm.
    at_mm: [f64; 2],
    /// Height of the ferrule, by the head's length.
    height: f64,
    bend: [f32; 2],
    turn: f64,
}

fn solve(file: &BrushFile, stroke: u64, flags: u32, place: &Place) -> Solve {
    let (sine, cosine) = maulstick_num::sin_cos(0.5 * place.turn);
    let joint = |i: usize| place.bend.map(|angle| angle * (0.7 + 0.1 * (i % 5) as f32));
    let mut solve = studio::solve(file, stroke, place.at_mm, place.height, [0.0; 2]);
    solve.pose.orientation = [0.0, 0.0, sine, cosine];
    Solve {
        surface: place.surface,
        flags,
        angles_rad: (0..file.spines.all_joints()).map(joint).collect(),
        ..solve
    }
}

fn paint(painting: &mut Painting, name: &str, size_mm: f64, stroke: u64, places: &[Place]) {
    let file = round(size_mm, 48);
    let solves = places.iter().map(|place| solve(&file, stroke, 0, place));
    painting.state(name, 1, &state(solves)).expect("it fits");
}

/// The books balance, and every cell holds a whole number of quanta that it can hold.
fn check(painting: &mut Painting) -> Result<(), TestCaseError> {
    let report = painting.report();
    prop_assert_eq!(report.quanta_missing, 0);
    for surface in [CANVAS, PALETTE] {
        let store = painting.store(surface).expect("a surface");
        for (id, version) in store.iter() {
            let Some(tile) = &version.tile else { continue };
            for (_, plane) in &*tile.wet() {
                for count in plane.iter() {
                    let fine = (0.0..=CELL_MAX as f32).contains(count) && count.fract() == 0.0;
                    prop_assert!(fine, "{count} quanta in tile {id:?} of surface {surface}");
                }
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn the_books_balance_whatever_is_done(acts in prop::collection::vec(act(), 1..24)) {
        let mut painting = painting(10.0);
        let mut strokes = [1, 1];
        for act in &acts {
            perform(&mut painting, &mut strokes, act);
            check(&mut painting)?;
        }
        let refusal = loop {
            match painting.undo(None) {
                Ok(_) => check(&mut painting)?,
                Err(refusal) => break refusal,
            }
        };
        prop_assert_eq!(refusal.to_string(), "there is nothing to undo");
        let store = painting.store(CANVAS).expect("a canvas");
        prop_assert_eq!(store.counts(), [0; SLOTS], "all that was done is undone");
        prop_assert_eq!(store.dry_counts(), [0; SLOTS]);
        prop_assert!(painting.scene().layers.is_empty());
    }

    /// Strokes that leave the canvas and come back, jump, hover and turn, with full and empty brushes, also wider than
    /// the canvas.
    #[test]
    fn no_stroke_makes_or_loses_paint(
        ways in prop::collection::vec((way(CANVAS, [8.0, 8.0], 14.0), 0..4usize), 1..6),
        wide in any::<bool>(),
    ) {
        let size_mm = if wide { 60.0 } else { 10.0 };
        let mut painting = painting(size_mm);
        for (i, (places, load)) in ways.iter().enumerate() {
            if let Some(text) = MIXTURES.get(*load) {
                painting.apply(Load { mixture: mixture(text), beside: None, brush: BrushName::main() }).expect("known");
            }
            paint(&mut painting, "main", size_mm, i as u64 + 1, places);
            check(&mut painting)?;
        }
    }
}

/// Steps of two brushes and whatever a painter does meanwhile: not a quantum is missing, and a second run gives the same.
fn lose_nothing(steps: u64) {
    let run = || {
        let mut runner = TestRunner::new_with_rng(
            ProptestConfig::default(),
            TestRng::deterministic_rng(RngAlgorithm::ChaCha),
        );
        let mut painting = painting(10.0);
        let mut strokes = [1, 1];
        let mut acts = 0;
        while painting.work().0 < steps {
            let act = act().new_tree(&mut runner).expect("an act").current();
            perform(&mut painting, &mut strokes, &act);
            acts += 1;
            if acts % 50 == 0 {
                check(&mut painting).expect("the books balance");
            }
        }
        let report = painting.report();
        assert_eq!(report.quanta_missing, 0);
        let store = painting.store(CANVAS).expect("a canvas");
        (report.paints_m3, store.counts(), acts)
    };
    assert_eq!(with_threads(2, run), run(), "on two cores and on one");
}

#[test]
fn ten_thousand_steps_lose_nothing() {
    lose_nothing(10_000);
}

#[test]
#[ignore = "long: 100,000 steps"]
fn a_hundred_thousand_steps_lose_nothing() {
    lose_nothing(100_000);
}

const LOW: Place = Place {
    surface: CANVAS,
    at_mm: [4.0, 8.0],
    height: 0.6,
    bend: [0.2, 0.3],
    turn: 0.0,
};

/// A path of 8 mm across the canvas, from `from_mm` to `to_mm`.
fn across(from_mm: f64, to_mm: f64) -> Vec<Place> {
    let at = |x| Place {
        at_mm: [x, 8.0],
        ..LOW
    };
    vec![at(from_mm), at(to_mm)]
}

/// A load in the middle of a stroke ends its undo step: the rest of the stroke is one of its own.
#[test]
fn what_is_painted_after_a_command_within_a_stroke_is_undone_too() {
    let commands: [fn(&mut Painting); 4] = [
        |painting| {
            painting
                .apply(load("main", mixture(MIXTURES[0])))
                .map(drop)
                .expect("known")
        },
        |painting| {
            painting
                .apply(Clean {
                    brush: BrushName::new("other").expect("valid"),
                })
                .map(drop)
                .expect("known")
        },
        |painting| drop(painting.undo(None).expect("a stroke")),
        |painting| {
            painting.undo(None).expect("a stroke");
            painting.redo(None).expect("the stroke");
        },
    ];
    for command in commands {
        let mut painting = painting(10.0);
        painting
            .apply(load("main", mixture(MIXTURES[1])))
            .expect("known");
        paint(&mut painting, "main", 10.0, 1, &across(4.0, 8.0));
        command(&mut painting);
        paint(&mut painting, "main", 10.0, 1, &across(8.0, 12.0));
        painting.commit();
        let painted = painting.store(CANVAS).expect("a canvas").counts();
        assert!(painted[0] > 0, "{painted:?}");
        let (steps, _) = painting.history_depth();
        for _ in 0..steps {
            painting.undo(None).expect("a step");
            assert_eq!(painting.report().quanta_missing, 0);
        }
        assert_eq!(
            painting.store(CANVAS).expect("a canvas").counts(),
            [0; SLOTS]
        );
        while painting.redo(None).is_ok() {
            assert_eq!(painting.report().quanta_missing, 0);
        }
        assert_eq!(painting.store(CANVAS).expect("a canvas").counts(), painted);
    }
}

/// A load from before a change of the strips is moved to the present ones.
#[test]
fn a_load_from_before_a_brush_had_other_strips_comes_back() {
    for strips in [31, 60] {
        let mut painting = painting(10.0);
        painting
            .apply(load("main", mixture(MIXTURES[0])))
            .expect("known");
        painting
            .apply(load("main", mixture(MIXTURES[1])))
            .expect("known");
        painting.define_brush("main", round(10.0, strips));
        painting.undo(None).expect("the second load");
        assert_eq!(painting.report().quanta_missing, 0);
        paint(&mut painting, "main", 10.0, 1, &across(4.0, 12.0));
        assert_eq!(painting.report().quanta_missing, 0);
    }
}

#[test]
fn a_head_in_the_air_and_a_clean_one_leave_nothing() {
    let mut painting = painting(10.0);
    paint(&mut painting, "main", 10.0, 1, &across(4.0, 12.0));
    painting
        .apply(load("main", mixture(MIXTURES[0])))
        .expect("known");
    let high = |place: Place| Place {
        height: 1.3,
        bend: [0.0; 2],
        ..place
    };
    let hover: Vec<Place> = across(4.0, 12.0).into_iter().map(high).collect();
    paint(&mut painting, "main", 10.0, 2, &hover);
    assert_eq!(painting.report().quanta_missing, 0);
    assert_eq!(
        painting.store(CANVAS).expect("a canvas").counts(),
        [0; SLOTS]
    );
}

/// Nothing is painted between two poses where the solver restarted.
#[test]
fn a_restart_paints_nothing_on_its_way() {
    let mut painting = painting(10.0);
    painting
        .apply(load("main", mixture(MIXTURES[0])))
        .expect("known");
    let file = round(10.0, 48);
    for place in across(4.0, 12.0) {
        let state = BrushState {
            device: 1,
            device_epoch: 1,
            device_seq: 0,
            solves: vec![solve(&file, 1, solve_flags::RESTARTED, &place)],
        };
        painting.state("main", 1, &state).expect("it fits");
    }
    painting.commit();
    assert_eq!(
        painting.store(CANVAS).expect("a canvas").counts(),
        [0; SLOTS]
    );
}

/// A dried stroke keeps its height, is booked as dry, and catches the next one.
#[test]
fn what_has_dried_stays_and_catches_paint() {
    let mut painting = painting(10.0);
    painting
        .apply(load("main", mixture(MIXTURES[0])))
        .expect("known");
    paint(&mut painting, "main", 10.0, 1, &across(4.0, 12.0));
    painting.commit();
    let wet = painting.store(CANVAS).expect("a canvas").counts();
    assert_eq!(
        painting
            .apply(dry(CANVAS, 1.0, "underpainting"))
            .map(|done| done.to_string())
            .as_deref(),
        Ok("underpainting")
    );
    let store = painting.store(CANVAS).expect("a canvas");
    assert_eq!((store.counts(), store.dry_counts()), ([0; SLOTS], wet));
    let report = painting.report();
    assert_eq!(report.quanta_missing, 0);
    assert!(report.accounts_m3["dry"] > 0.0 && report.accounts_m3["canvas"] == 0.0);
    assert!(
        painting.apply(dry(CANVAS, 1.0, "")).is_err(),
        "nothing is wet"
    );
    // A brush so high that it only touched the first stroke's relief.
    let deposited = |painting: &mut Painting, stroke: u64| {
        painting
            .apply(load("main", mixture(MIXTURES[0])))
            .expect("known");
        let before = painting.store(CANVAS).expect("a canvas").counts()[0];
        paint(painting, "main", 10.0, stroke, &across(4.0, 12.0));
        painting.commit();
        painting.store(CANVAS).expect("a canvas").counts()[0] - before
    };
    let over_dry = deposited(&mut painting, 2);
    assert!(over_dry > 0);
    assert_eq!(painting.report().quanta_missing, 0);
    assert!(
        painting
            .apply(Opacity {
                layer: LayerRef::Number { number: 9 },
                opacity: OpacityFactor::new(0.5).expect("in range")
            })
            .is_err()
    );
    painting.apply(opacity(1, 0.5)).expect("the layer");
    assert_eq!(painting.scene().layers[0].opacity, 0.5);
    painting.undo(None).expect("the opacity");
    assert_eq!(painting.scene().layers[0].opacity, 1.0);
}

/// A texel of a brush of 60 mm holds more quanta than an `f32` counts.
#[test]
fn a_wide_brush_loses_no_quantum_of_its_broad_strips() {
    let place = |bend| Place {
        surface: CANVAS,
        at_mm: [8.0, 8.0],
        height: 0.25,
        bend,
        turn: 0.0,
    };
    let mut painting = painting(60.0);
    painting
        .apply(load("main", mixture(MIXTURES[0])))
        .expect("known");
    let places = [place([-0.075_547_72, 0.0]), place([0.0, 0.311_891_85])];
    paint(&mut painting, "main", 60.0, 1, &places);
    let report = painting.report();
    assert!(report.covered_cells > 0);
    assert_eq!(report.quanta_missing, 0);
}
