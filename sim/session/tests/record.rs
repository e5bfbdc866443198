//! Replaying the record of a painting that was painted in its document, closed and continued gives the same paint, and
//! its log lists the actions.

mod desk;

use std::path::Path;

use desk::Desk;
use maulstick_document::{Access, Document, DocumentError, DocumentSettings, Opened};
use maulstick_painting::edits::{Dry, Load, Redo, Undo};
use maulstick_painting::sequencer::Accepted;
use maulstick_session::{
    LoggedWhat, Reexecution, TilePrints, WorkClock, painting_log, tile_prints,
};
use maulstick_types::paint::Decision;
use maulstick_types::scene::CANVAS;
use maulstick_types::stylus::{StylusPose, StylusSample, axes};
use maulstick_types::values::{BrushName, LayerName, Share, Ticks};

const MS: u64 = 1_000_000;

fn settings(path: &Path, access: Access) -> DocumentSettings {
    DocumentSettings::new(path, access)
}

fn read(path: &Path) -> (Document, Opened) {
    let (document, opened) = Document::open(&settings(path, Access::Read)).expect("opened");
    (document, opened.expect("a painting"))
}

impl Desk {
    fn edit(&mut self, edit: impl Into<maulstick_types::Edit>) {
        self.offline.edit(edit).expect("done");
        self.autosave_now();
    }

    fn load(&mut self, mixture: &str) {
        self.edit(Load {
            mixture: mixture.parse().expect("a mixture"),
            beside: None,
            brush: BrushName::new("main").expect("valid"),
        });
    }

    /// A stroke of 200 ms across the canvas, at a height on it.
    fn stroke(&mut self, y_m: f64) {
        for step in 0..=21u32 {
            let sample = StylusSample {
                senses: axes::POSITION | axes::PRESSURE,
                in_range: true,
                pose: StylusPose::Contact {
                    point_m: [1e-3 * f64::from(step) - 0.01, y_m, 0.0],
                    tilt_rad: [0.4, 0.0],
                    twist_rad: 0.0,
                    pressure: if step == 21 { 0.0 } else { 0.5 },
                },
                ..StylusSample::away()
            };
            self.now_ns += 10 * MS;
            self.offline.sample(self.now_ns, &sample).expect("painted");
        }
        self.now_ns += 5000 * MS;
        self.autosave_now();
    }

    fn autosave_now(&mut self) {
        self.now_ns += 1000 * MS;
        self.autosave
            .turn(self.offline.sequencer_mut(), self.now_ns);
        self.autosave.document().flush();
    }

    fn close(mut self) {
        self.autosave
            .close(self.offline.sequencer_mut())
            .expect("closed");
    }
}

/// A painting with strokes, loads, layers, drying, undo and redo, closed and continued.
fn paint(path: &Path) {
    let mut desk = Desk::with(path, "flat");
    desk.load("Cobalt Blue=0.7,Titanium White=0.3");
    desk.stroke(2e-3);
    desk.stroke(-2e-3);
    desk.edit(Undo { brush: None });
    desk.edit(Dry {
        share: Share::new(1.0).expect("in range"),
        layer: LayerName::new("sky").ok(),
        ..Dry::whole(CANVAS)
    });
    desk.load("Yellow Ochre");
    desk.stroke(1e-3);
    desk.edit(Dry {
        over: Some(Ticks::new(40).expect("in range")),
        ..Dry::whole(CANVAS)
    });
    desk.offline.wait(60, |_| {});
    desk.autosave_now();
    desk.close();
    let mut desk = Desk::with(path, "flat");
    desk.load("Pyrrole Red");
    desk.stroke(0.0);
    desk.edit(Undo { brush: None });
    desk.edit(Redo { brush: None });
    desk.close();
}

/// Tiles of a record that is executed again without one of its states, if `without` says which.
fn again(path: &Path, without: Option<usize>) -> TilePrints {
    let (document, opened) = read(path);
    let first = Reexecution::new(document, opened).expect("whole");
    let mut again = first.expect("a record");
    let mut states = 0;
    let mut lost = false;
    let done = again.run(|sequencer, record| {
        states += usize::from(matches!(record.what, Accepted::State { .. }));
        if without == Some(states) && !lost {
            lost = true;
            sequencer.painting_mut().lift_brushes();
        }
        Ok::<(), DocumentError>(())
    });
    done.expect("intact");
    tile_prints(again.sequencer_mut().painting_mut())
}

fn stored(path: &Path) -> TilePrints {
    let (_document, opened) = read(path);
    tile_prints(opened.sequencer().expect("whole").painting_mut())
}

#[test]
fn a_record_gives_the_painting_again_and_a_fault_in_it_another() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    paint(&path);
    let painting = stored(&path);
    assert!(painting.len() > 2, "{}", painting.len());
    assert_eq!(again(&path, None), painting);
    // A brush that is lifted in the midst of a stroke.
    assert!(again(&path, Some(12)) != painting);
}

#[test]
fn working_time_is_that_of_strokes_and_edits() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    paint(&path);
    let (document, opened) = read(&path);
    let first = Reexecution::new(document, opened).expect("whole");
    let (mut clock, mut work_ns) = (WorkClock::default(), 0);
    let looked = first
        .expect("a record")
        .look_ahead(|record| work_ns = clock.pass(record));
    looked
        .map_err(|error: DocumentError| error)
        .expect("intact");
    // Four strokes of about 200 ms, eight edits of 250 ms; the pauses of 5 s do not count.
    let seconds = work_ns as f64 * 1e-9;
    assert!((2.5..3.0).contains(&seconds), "{seconds} s");
}

#[test]
fn the_log_says_what_was_done() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    paint(&path);
    let (document, opened) = read(&path);
    let log = painting_log(&document, &opened).expect("intact");
    let strokes: Vec<_> = log
        .iter()
        .filter_map(|line| match &line.what {
            LoggedWhat::Stroke(stroke) => Some(stroke),
            _ => None,
        })
        .collect();
    assert_eq!(strokes.len(), 4);
    for stroke in strokes {
        assert_eq!(stroke.brush, "main");
        assert!(stroke.is_replayed && stroke.surface == CANVAS, "{stroke:?}");
        assert!((0.15..0.25).contains(&stroke.seconds), "{stroke:?}");
        assert!((0.015..0.03).contains(&stroke.length_m), "{stroke:?}");
    }
    let edits = log.iter().filter(|line| {
        let LoggedWhat::Command { command, .. } = &line.what else {
            return false;
        };
        matches!(command, maulstick_types::command::Command::Edit(_))
    });
    assert_eq!(edits.count(), 8);
    let goes_on = LoggedWhat::Decision(Decision::Resumed);
    assert_eq!(log.iter().filter(|line| line.what == goes_on).count(), 1);
    let times: Vec<u64> = log.iter().filter_map(|line| line.time_ms).collect();
    assert_eq!(times.len(), log.len(), "all are in the record");
    assert!(times.is_sorted() && times[0] > 1_700_000_000_000);
}

#[test]
fn a_record_keeps_to_its_limit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let mut desk = Desk::with(&path, "flat");
    let limit = 30_000;
    desk.offline.painting_mut().set_record_quota(limit);
    let mut largest = 0;
    for stroke in 0..12 {
        desk.load("Cobalt Blue");
        desk.stroke(1e-3 * f64::from(stroke % 5));
        largest = largest.max(desk.autosave.document().record_bytes());
    }
    desk.close();
    assert!(largest > limit, "{largest}: nothing was beyond it");
    assert!(largest < 4 * limit, "{largest}");
    let (_document, opened) = read(&path);
    let serial = opened.beginning().expect("a record").sequencer.serial;
    assert!(serial > 20, "{serial}: it began anew");
    assert_eq!(opened.snapshot().quotas.record_quota, limit, "remembered");
    drop((_document, opened));
    assert_eq!(again(&path, None), stored(&path));
}
