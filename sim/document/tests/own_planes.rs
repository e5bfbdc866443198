//! A plane of 8 bits, owned by a toy model: through store, history and document, byte for byte.

mod studio;

use std::sync::Arc;

use maulstick_canvas::own_plane::{OwnPlane, OwnShape, ValueType};
use maulstick_canvas::quantum::{Counts, SLOTS};
use maulstick_canvas::tile::TileId;
use maulstick_document::{Access, Checkpoint, Document, DocumentSettings};
use maulstick_model::footprint::Footprint;
use maulstick_model::interface::{CountOwn, PaintModel, Step, StepReport};
use maulstick_painting::Sequencer;
use maulstick_painting::edits::{Load, Scrape};
use maulstick_types::Pose;
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::BrushName;

const SHAPE: OwnShape = OwnShape {
    kind: 9,
    values: ValueType::U8,
    per_cell: 2,
};

/// Moves a quantum of the first paint from each texel that touches a cell into the second of two bytes there.
#[derive(Default)]
struct Toy {
    footprint: Footprint,
    /// Counts for the ledger.
    count: Option<CountOwn>,
}

impl Toy {
    fn counted() -> Self {
        Self {
            count: Some(count),
            ..Self::default()
        }
    }
}

fn count(own: &[OwnPlane]) -> Counts {
    let mut counts = [0; SLOTS];
    let bytes = own.iter().flat_map(|plane| plane.bytes.iter());
    counts[0] = bytes.map(|byte| u64::from(*byte)).sum();
    counts
}

impl PaintModel for Toy {
    /// It works on the same cells as a marker.
    fn name(&self) -> &'static str {
        "marker"
    }

    fn step(&mut self, step: &mut Step<'_>) -> StepReport {
        let footprint = &mut self.footprint;
        footprint.find(step);
        if footprint.contacts.is_empty() {
            return StepReport::default();
        }
        let plane = step.window.own_mut(SHAPE);
        for contact in &footprint.contacts {
            let (held, texel) = (
                &mut plane[2 * contact.cell as usize + 1],
                contact.texel as usize,
            );
            let carried = step.load.film_of(0).map_or(0, |film| film[texel]);
            if carried > 0 && *held < u8::MAX {
                *held += 1;
                step.load.change_film(0, texel, -1);
            }
        }
        step.load.count_films();
        step.window.touch(footprint.reached());
        footprint.report(step)
    }

    fn count_own(&self) -> Option<CountOwn> {
        self.count
    }
}

fn stroke(sequencer: &mut Sequencer, number: u64, y_mm: f64) {
    let file = studio::brush(48);
    let solve = |stroke: u64, x_mm: f64| Solve {
        event_ns: 0,
        stroke,
        surface: CANVAS,
        flags: 0,
        pose: Pose {
            position_m: [x_mm * 1e-3, y_mm * 1e-3, 0.6 * file.length_m()],
            ..Pose::IDENTITY
        },
        zoom: 1.0,
        angles_rad: vec![[0.2, 0.3]; file.spines.all_joints()],
        contacts: Vec::new(),
    };
    let ways = [3.0, 12.0, 20.0].map(|x| solve(number, x));
    let state = BrushState {
        device: 1,
        device_epoch: 1,
        device_seq: 0,
        solves: ways.into_iter().chain([solve(0, 0.0)]).collect(),
    };
    let painting = sequencer.painting_mut();
    painting.state("main", 1, &state).expect("it fits");
}

/// The toy's planes, by tile.
fn own(sequencer: &mut Sequencer) -> Vec<(TileId, Vec<OwnPlane>)> {
    let painting = sequencer.painting_mut();
    painting.commit();
    let store = painting.store(CANVAS).expect("a canvas");
    let tiles = store.iter().filter_map(|(id, version)| {
        let planes = version.tile.as_ref()?.wet().own().to_vec();
        (!planes.is_empty()).then_some((id, planes))
    });
    tiles.collect()
}

fn opened(settings: &DocumentSettings) -> (Document, Sequencer, u64) {
    let (document, opened) = Document::open(settings).expect("whole");
    let opened = opened.expect("a painting");
    let since = opened.snapshot().versions;
    let mut sequencer = opened.sequencer().expect("it fits");
    sequencer.painting_mut().set_model(Box::new(Toy::counted()));
    (document, sequencer, since)
}

fn closed(document: Document, mut sequencer: Sequencer, since: u64) {
    document.write_checkpoint(Checkpoint::of(&mut sequencer, since));
    document.flush();
    assert_eq!(document.fault(), None);
    document.close().expect("closed");
}

/// A new painting with a loaded brush.
fn begun(settings: &DocumentSettings) -> (Document, Sequencer) {
    let (document, _) = Document::open(settings).expect("begun");
    let mut sequencer = studio::sequencer_of("marker", Arc::clone(document.pager()));
    sequencer
        .define_brush("main", studio::brush(48))
        .expect("a brush");
    let painting = sequencer.painting_mut();
    painting.set_model(Box::new(Toy::counted()));
    let load = Load {
        mixture: studio::mixture("Bone Black"),
        beside: None,
        brush: BrushName::main(),
    };
    painting.apply(load).expect("loaded");
    (document, sequencer)
}

#[test]
fn they_are_undone_redone_saved_and_reopened_byte_for_byte() {
    let folder = tempfile::tempdir().expect("a folder");
    let settings = DocumentSettings::new(&folder.path().join("toy.maul"), Access::Paint);
    let (document, mut sequencer) = begun(&settings);
    stroke(&mut sequencer, 1, 7.0);
    let once = own(&mut sequencer);
    stroke(&mut sequencer, 2, 9.0);
    let twice = own(&mut sequencer);
    assert!(once.len() > 1 && twice != once, "{} tiles", once.len());
    let painting = sequencer.painting_mut();
    painting.undo(None).expect("done");
    assert!(own(&mut sequencer) == once, "undone");
    sequencer.painting_mut().undo(None).expect("done");
    assert!(own(&mut sequencer).is_empty(), "all undone");
    for _ in 0..2 {
        sequencer.painting_mut().redo(None).expect("undone");
    }
    assert!(own(&mut sequencer) == twice, "redone");
    let painting = sequencer.painting_mut();
    assert_eq!(painting.report().quanta_missing, 0);
    painting.set_model(Box::new(Toy::default()));
    assert!(painting.report().quanta_missing > 0, "a fault would pass");
    closed(document, sequencer, 0);

    let (document, mut sequencer, since) = opened(&settings);
    assert!(own(&mut sequencer) == twice, "opened again");
    // A later state is stored as its difference.
    stroke(&mut sequencer, 3, 11.0);
    let thrice = own(&mut sequencer);
    assert!(thrice != twice);
    closed(document, sequencer, since);

    let (document, mut sequencer, _) = opened(&settings);
    assert!(own(&mut sequencer) == thrice, "opened a third time");
    assert_eq!(sequencer.painting_mut().report().quanta_missing, 0);
    for before in [&twice, &once] {
        sequencer.painting_mut().undo(None).expect("done");
        assert!(own(&mut sequencer) == *before, "undone from the document");
    }
    let scrape = Scrape {
        region: None,
        surface: CANVAS,
    };
    sequencer.painting_mut().apply(scrape).expect("wet");
    assert!(own(&mut sequencer).is_empty(), "scraped off");
    assert_eq!(sequencer.painting_mut().report().quanta_missing, 0);
    sequencer.painting_mut().undo(None).expect("done");
    assert!(own(&mut sequencer) == once, "undone");
    assert_eq!(sequencer.painting_mut().report().quanta_missing, 0);
    let mut faulty = once.clone();
    let plane = &mut faulty[0].1[0];
    let mut bytes = plane.bytes.to_vec();
    bytes[4097] ^= 1;
    plane.bytes = bytes.into();
    assert!(own(&mut sequencer) != faulty, "a wrong bit would be seen");
    document.close().expect("closed");
}
