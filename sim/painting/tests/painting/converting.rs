//! Surfaces converted to another paint model: volumes stay, colours come near, undo and replay bring the same back.

use std::collections::BTreeMap;

use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::sheet::sheets;
use maulstick_canvas::tile::TileId;
use maulstick_painting::edits::{Convert, Dry};
use maulstick_painting::picture::picture;
use maulstick_painting::{EditError, Painting, PaintingSetup, Sequencer, SurfaceError};
use maulstick_types::brush::Solve;
use maulstick_types::scene::{CANVAS, PALETTE};
use maulstick_types::values::{ModelName, Share};

use crate::studio::{BRUSH, fill, load, painting, round, solve, state};

const SETUP: [u32; 2] = [100, 70];

fn convert(surface: u32, model: &str) -> Convert {
    Convert {
        model: ModelName::new(model).expect("valid"),
        surface,
    }
}

/// A dry ground coat, a dry and a wet veil: as many counts in any model.
fn filled(model: &str) -> Painting {
    let file = round(6.0, 48);
    let mut painting = painting(&PaintingSetup {
        cells: SETUP,
        model: model.to_owned(),
        ..PaintingSetup::default()
    });
    painting.define_brush(BRUSH, file);
    let dry = |share: f32| Dry {
        share: Share::new(share).expect("in range"),
        ..Dry::whole(CANVAS)
    };
    painting
        .apply(fill("Yellow Ochre=0.5,Titanium White=0.5", 60.0))
        .expect("laid");
    painting.apply(dry(1.0)).expect("wet");
    painting
        .apply(fill("Ultramarine Blue=0.2,Titanium White=0.8", 70.0))
        .expect("laid");
    painting.apply(dry(0.5)).expect("wet");
    painting
}

/// The same with strokes of two colours over it.
fn painted(model: &str) -> Painting {
    let (file, mut painting) = (round(6.0, 48), filled(model));
    for (number, paint, y) in [
        (1, "Pyrrole Red=0.6,Titanium White=0.4", 6.0),
        (2, "Ultramarine Blue=0.4,Hansa Yellow Opaque=0.6", 9.0),
    ] {
        painting.apply(load(paint)).expect("loaded");
        let at = |stroke: u64, x: f64| Solve {
            surface: CANVAS,
            ..solve(&file, stroke, [x, y], 0.6, [0.2, 0.3])
        };
        let solves = [4.0, 9.0, 14.0, 20.0].map(|x| at(number, x));
        let solves = solves.into_iter().chain([at(0, 0.0)]);
        painting.state(BRUSH, 1, &state(solves)).expect("it fits");
    }
    painting
}

/// True if wet paint lies in two sheets somewhere on the canvas.
fn has_sheets(painting: &mut Painting) -> bool {
    painting.commit();
    let store = painting.store(CANVAS).expect("the canvas");
    let mut tiles = store
        .iter()
        .filter_map(|(_, version)| version.tile.as_ref());
    tiles.any(|tile| sheets(&tile.wet()).is_some())
}

#[test]
fn other_models_do_not_keep_what_lies_on_top() {
    for model in ["stokes", "marker"] {
        let mut painting = painted("impasto");
        assert!(has_sheets(&mut painting));
        painting.apply(convert(CANVAS, model)).expect("another");
        assert!(!has_sheets(&mut painting), "{model}");
        painting.apply(convert(CANVAS, "impasto")).expect("another");
        assert!(!has_sheets(&mut painting), "and back");
        assert_eq!(painting.report().quanta_missing, 0);
    }
}

/// Quanta of each layer of each cell of the canvas, the wet ones first.
fn volumes(painting: &mut Painting) -> BTreeMap<TileId, Vec<Vec<u64>>> {
    painting.report();
    let sums = |planes: &Planes| -> Vec<u64> {
        let cell = |cell: usize| planes.iter().map(|(_, plane)| plane[cell] as u64).sum();
        (0..TILE_CELLS).map(cell).collect()
    };
    let store = painting.store(CANVAS).expect("the canvas");
    let tiles = store.iter().filter_map(|(id, version)| {
        let tile = version.tile.as_ref()?;
        let dry = tile.dry().into_iter().flat_map(|stack| stack.layers());
        let dry = dry.map(|layer| sums(&layer.planes.get()));
        Some((id, std::iter::once(sums(&tile.wet())).chain(dry).collect()))
    });
    tiles.collect()
}

fn mean_difference(one: &[u8], other: &[u8]) -> f64 {
    let pairs = one.iter().zip(other);
    let sum: u64 = pairs.map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / one.len() as f64
}

#[test]
fn volumes_stay_colours_come_near_and_undo_brings_all_back() {
    // Mean difference of a channel, of 255: dAb's relief is embossed, which conversions do not change.
    const LIMIT: f64 = 15.0;
    for (from, to) in [("dab", "impasto"), ("impasto", "dab")] {
        let mut painting = painted(from);
        let (before, heights) = (picture(&mut painting, CANVAS).rgb, volumes(&mut painting));
        let told = painting.apply(convert(CANVAS, to)).expect("converted");
        assert_eq!(painting.model(CANVAS), Some(to));
        assert_eq!(painting.scene().surfaces[0].model, to);
        assert_eq!(painting.model(PALETTE), Some("impasto"));
        assert!(volumes(&mut painting) == heights, "{from} to {to}");
        assert_eq!(painting.report().quanta_missing, 0);
        let after = picture(&mut painting, CANVAS).rgb;
        let off = mean_difference(&before, &after);
        // The same counts in the other colours.
        let [one, other] = [from, to].map(|model| picture(&mut filled(model), CANVAS).rgb);
        let fault = mean_difference(&one, &other);
        println!("{from} to {to}: {off:.2} of 255, counts as they are {fault:.2}; {told}");
        assert!(off < LIMIT, "{off}");
        assert!(fault > LIMIT, "a fault would pass: {fault}");
        painting.undo(None).expect("undone");
        assert_eq!(painting.model(CANVAS), Some(from));
        assert!(picture(&mut painting, CANVAS).rgb == before);
        assert_eq!(painting.report().quanta_missing, 0);
        painting.redo(None).expect("redone");
        assert_eq!(painting.model(CANVAS), Some(to));
        assert!(picture(&mut painting, CANVAS).rgb == after);
        painting.apply(convert(CANVAS, from)).expect("and back");
        assert!(volumes(&mut painting) == heights);
        let back = picture(&mut painting, CANVAS).rgb;
        let off = mean_difference(&before, &back);
        println!("and back: {off:.2}");
        assert!(off < LIMIT, "{off}");
        assert_eq!(painting.report().quanta_missing, 0);
    }
}

#[test]
fn an_unknown_model_and_the_same_one_are_refused_and_change_nothing() {
    let mut painting = painted("dab");
    let before = (painting.scene().clone(), picture(&mut painting, CANVAS).rgb);
    let unknown = painting.apply(convert(CANVAS, "watercolour"));
    assert!(matches!(unknown, Err(EditError::Model(_))));
    let same = painting.apply(convert(CANVAS, "dab"));
    assert_eq!(same, Err(SurfaceError::SameModel("dab").into()));
    assert_eq!(
        painting.apply(convert(7, "dab")),
        Err(SurfaceError::Unknown(7).into())
    );
    let after = (painting.scene().clone(), picture(&mut painting, CANVAS).rgb);
    assert!(before == after);
}

#[test]
fn models_with_the_same_colours_keep_each_count() {
    let mut painting = painted("impasto");
    let before = painting.report().paints_m3;
    let told = painting
        .apply(convert(CANVAS, "marker"))
        .expect("converted");
    assert_eq!(told.to_string(), "colours as before");
    assert_eq!(painting.report().paints_m3, before);
    assert_eq!(painting.history_depth().1, 0);
    painting.undo(None).expect("a step");
    assert_eq!(painting.model(CANVAS), Some("impasto"));
}

#[test]
fn a_conversion_is_accepted_again_to_the_same_counts() {
    let file = round(6.0, 48);
    let begin = || {
        let mut sequencer = Sequencer::new(painting(&PaintingSetup {
            cells: SETUP,
            model: "dab".to_owned(),
            ..PaintingSetup::default()
        }));
        sequencer.painting_mut().define_brush(BRUSH, file.clone());
        sequencer
    };
    let mut sequencer = begin();
    sequencer.record();
    let films = fill("Ultramarine Blue=0.3,Hansa Yellow Opaque=0.7", 50.0);
    sequencer.edit(films).expect("laid");
    sequencer.edit(convert(CANVAS, "impasto")).expect("done");
    let records = sequencer.take_records();
    let mut again = begin();
    for record in records {
        again.replay(record);
    }
    assert_eq!(again.painting().model(CANVAS), Some("impasto"));
    let [one, other] = [&mut sequencer, &mut again]
        .map(|sequencer| crate::studio::wet_paint(sequencer.painting()));
    assert!(!one.is_empty() && one == other);
    let mut plain = begin();
    let films = fill("Ultramarine Blue=0.3,Hansa Yellow Opaque=0.7", 50.0);
    plain.edit(films).expect("laid");
    let plain = crate::studio::wet_paint(plain.painting());
    assert!(plain != one, "a fault would pass: a conversion left out");
}
