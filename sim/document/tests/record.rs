//! Replaying the record of a painting from its beginning gives the painting, however it was painted, closed, killed and
//! opened again.

mod easel;
mod studio;

use std::collections::BTreeMap;
use std::path::Path;

use easel::Easel;
use maulstick_document::file::database::Database;
use maulstick_document::pack::{Forget, pack};
use maulstick_document::record::{discard, rewind};
use maulstick_document::tables::schema::{APPLICATION_ID, VERSION};
use maulstick_document::{Access, Document, DocumentSettings, DocumentStats};
use maulstick_painting::edits::{GoTo, Undo, Wells};
use maulstick_painting::history::TilePlace;
use maulstick_painting::sequencer::{Accepted, Record};
use maulstick_painting::{LaidTile, Wetness};
use maulstick_types::paint::{Decision, Entry};
use maulstick_types::scene::{CANVAS, PALETTE};
use proptest::prelude::*;
use studio::{Act, Dice, Painter, tiles};

/// Contents of each tile.
type Tiles = BTreeMap<TilePlace, Vec<u64>>;

fn settings(path: &Path, access: Access) -> DocumentSettings {
    DocumentSettings {
        memory: 400_000,
        ..DocumentSettings::new(path, access)
    }
}

/// All messages of a record, and the tiles from those where `skips` is false.
fn executed_again(path: &Path, mut skips: impl FnMut(&Record) -> bool) -> Option<(usize, Tiles)> {
    let settings = DocumentSettings::new(path, Access::Read);
    let (document, opened) = Document::open(&settings).expect("opened");
    let first = opened.expect("a painting").first().expect("whole");
    let mut sequencer = first?;
    let (mut next, mut count) = (sequencer.serial(), 0);
    while let Some(row) = document.record_row(next).expect("intact") {
        for record in row.records {
            assert_eq!(record.serial, next, "no gap");
            (next, count) = (next + 1, count + 1);
            if !skips(&record) {
                sequencer.replay(record);
            }
        }
    }
    assert_eq!(document.pager().fault(), None);
    Some((count, tiles(&mut sequencer)))
}

/// Tiles of a painting in its file.
fn stored(path: &Path) -> Tiles {
    let settings = DocumentSettings::new(path, Access::Read);
    let (_document, opened) = Document::open(&settings).expect("opened");
    let opened = opened.expect("a painting");
    tiles(&mut opened.sequencer().expect("whole"))
}

/// Paints from a seed in a file that is closed and opened again now and then.
fn paint(path: &Path, seed: u64, acts: usize) -> Painter {
    let settings = settings(path, Access::Paint);
    let (mut painter, mut dice) = (Painter::new(seed), Dice::new(seed ^ 0x7ec0));
    let mut easel = Easel::begin(&settings);
    for _ in 0..acts {
        let act = painter.next();
        easel.act(&mut painter, &act);
        match dice.below(24) {
            0 => {
                easel.close();
                easel = Easel::open(&settings).expect("opened");
            }
            1..6 => easel.checkpoint(),
            6..9 => easel.flush(),
            _ => {}
        }
    }
    easel.close();
    painter
}

proptest! {
    #![proptest_config(studio::cases(6))]

    #[test]
    fn a_record_executed_again_gives_the_painting(seed in any::<u64>(), acts in 20usize..70) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.maul");
        paint(&path, seed, acts);
        let (count, again) = executed_again(&path, |_| false).expect("a record");
        prop_assert!(count > acts / 4, "{} messages", count);
        prop_assert_eq!(again, stored(&path));
    }
}

/// The seeded fault of the comparison.
#[test]
fn a_record_without_some_of_its_messages_gives_another_painting() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    paint(&path, 5, 50);
    let mut strokes = 0;
    let skips = |record: &Record| {
        let is_stroke = matches!(record.what, Accepted::State { .. });
        strokes += usize::from(is_stroke);
        is_stroke && (3..9).contains(&strokes)
    };
    let (_, again) = executed_again(&path, skips).expect("a record");
    assert!(again != stored(&path));
}

/// Paints until the canvas has paint, and `steps` strokes more.
fn strokes(easel: &mut Easel, painter: &mut Painter, steps: usize) {
    let mut painted = 0;
    while painted < steps {
        let act = painter.next();
        if matches!(&act, Act::Paint(_, true, way) if way[0].surface == CANVAS) {
            easel.act(painter, &act);
            painted += 1;
        }
    }
}

fn lay(easel: &mut Easel) {
    let tile = LaidTile {
        id: maulstick_canvas::tile::TileId { x: 0, y: 0 },
        planes: vec![(0, vec![20_000; 4096])],
    };
    let painting = easel.sequencer.painting_mut();
    let laid = painting.underpaint(
        CANVAS,
        &["Yellow Ochre".to_owned()],
        &Wetness::Wet,
        [tile].into_iter(),
    );
    laid.expect("laid");
}

#[test]
fn what_no_message_describes_begins_the_record_anew() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let mut painter = Painter::new(9);
    let mut easel = Easel::begin(&settings(&path, Access::Paint));
    strokes(&mut easel, &mut painter, 6);
    easel.flush();
    easel.checkpoint();
    easel.flush();
    lay(&mut easel);
    strokes(&mut easel, &mut painter, 3);
    easel.checkpoint();
    easel.flush();
    strokes(&mut easel, &mut painter, 2);
    easel.close();
    let (count, again) = executed_again(&path, |_| false).expect("a record");
    assert!((2..8).contains(&count), "{count} messages since");
    assert_eq!(again, stored(&path));

    // An undo of a step before the beginning.
    let mut easel = Easel::open(&settings(&path, Access::Paint)).expect("opened");
    for _ in 0..7 {
        easel.sequencer.edit(Undo { brush: None }).expect("undone");
    }
    easel.close();
    let (count, again) = executed_again(&path, |_| false).expect("a record");
    assert_eq!((count, &again), (0, &stored(&path)));
    let mut easel = Easel::open(&settings(&path, Access::Paint)).expect("opened");
    strokes(&mut easel, &mut painter, 2);
    easel.sequencer.edit(GoTo { step: 0 }).expect("undone");
    easel.close();
    let (_, again) = executed_again(&path, |_| false).expect("a record");
    assert_eq!(again, stored(&path));
}

#[test]
fn wells_after_the_beginning_of_a_record_are_undone_when_it_is_executed_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let mut painter = Painter::new(5);
    let mut easel = Easel::begin(&settings(&path, Access::Paint));
    strokes(&mut easel, &mut painter, 3);
    lay(&mut easel);
    easel.checkpoint();
    easel.flush();
    let surfaces = &easel.sequencer.painting().scene().surfaces;
    let palette = surfaces.iter().find(|surface| surface.id == PALETTE);
    let mut wells = palette.expect("a palette").wells.clone();
    let before = wells.len();
    wells.pop();
    let others = Wells::new(PALETTE, wells).expect("wells");
    easel.sequencer.edit(others).expect("chosen");
    let undo = Undo { brush: None };
    easel.sequencer.edit(undo).expect("undone");
    let surfaces = &easel.sequencer.painting().scene().surfaces;
    let palette = surfaces.iter().find(|surface| surface.id == PALETTE);
    assert_eq!(palette.expect("a palette").wells.len(), before);
    easel.close();
    let settings = DocumentSettings::new(&path, Access::Read);
    let (document, opened) = Document::open(&settings).expect("opened");
    let first = opened.expect("a painting").first().expect("whole");
    let mut sequencer = first.expect("a record");
    while let Some(row) = document.record_row(sequencer.serial()).expect("intact") {
        row.records
            .into_iter()
            .for_each(|record| sequencer.replay(record));
    }
    let mut surfaces = sequencer.painting().scene().surfaces.iter();
    let palette = surfaces.find(|surface| surface.id == PALETTE);
    assert_eq!(palette.expect("a palette").wells.len(), before);
}

#[test]
fn a_record_beyond_its_limit_begins_anew_and_none_is_kept_where_the_limit_is_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let mut painter = Painter::new(4);
    let mut easel = Easel::begin(&settings(&path, Access::Paint));
    strokes(&mut easel, &mut painter, 8);
    easel.flush();
    easel.checkpoint();
    easel.flush();
    assert!(easel.document.record_bytes() > 500);
    easel.sequencer.painting_mut().break_record();
    easel.checkpoint();
    easel.flush();
    assert_eq!(easel.document.record_bytes(), 0);
    strokes(&mut easel, &mut painter, 1);
    easel.close();
    assert_eq!(
        executed_again(&path, |_| false).expect("a record").1,
        stored(&path)
    );

    let mut easel = Easel::open(&settings(&path, Access::Paint)).expect("opened");
    easel.sequencer.painting_mut().set_record_quota(0);
    strokes(&mut easel, &mut painter, 1);
    easel.close();
    assert!(executed_again(&path, |_| false).is_none());
    let stats = DocumentStats::read(&path).expect("read");
    assert_eq!(stats.record, None);
    let mut easel = Easel::open(&settings(&path, Access::Paint)).expect("opened");
    assert_eq!(easel.sequencer.painting().record_quota(), 0, "remembered");
    easel.sequencer.painting_mut().set_record_quota(1 << 20);
    strokes(&mut easel, &mut painter, 1);
    easel.close();
    let (count, again) = executed_again(&path, |_| false).expect("a record");
    assert_eq!((count, again), (0, stored(&path)));
}

#[test]
fn opening_reads_no_row_of_the_record() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    paint(&path, 2, 40);
    let before = stored(&path);
    let (database, _) = Database::open(&path, Access::Paint, None).expect("opened");
    let rows: i64 = database
        .connection()
        .query_row("SELECT count(*) FROM record", [], |row| row.get(0))
        .expect("counted");
    assert!(rows > 2, "{rows} rows");
    let spoilt = "UPDATE record SET data = x'00'";
    database.connection().execute(spoilt, []).expect("spoilt");
    database.close().expect("closed");
    // A painting whose record is damaged is whole, and readers of the record find the damage.
    assert_eq!(stored(&path), before);
    let (document, opened) =
        Document::open(&DocumentSettings::new(&path, Access::Read)).expect("opened");
    let opened = opened.expect("a painting");
    assert_eq!(opened.pending(), 0, "nothing is done again");
    let first = opened.first().expect("whole").expect("a record");
    let read = document.record_row(first.serial());
    assert!(read.expect_err("damaged").to_string().contains("checksum"));
    document.close().expect("closed");
    let stats = DocumentStats::read(&path).expect("read");
    let checked = stats.check(&path, &mut |_, _| {});
    assert!(checked.expect_err("damaged").to_string().contains("record"));
}

#[test]
fn packing_keeps_the_record_unless_it_is_to_be_forgotten() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    paint(&path, 8, 40);
    let painting = stored(&path);
    for (forget, is_kept) in [
        (Forget::Nothing, true),
        (Forget::Record, false),
        (Forget::History, false),
    ] {
        let copy = folder.path().join("b.maul");
        std::fs::copy(&path, &copy).expect("copied");
        pack(&copy, forget, &mut |_, _| {}).expect("packed");
        let (count, again) = executed_again(&copy, |_| false).expect("a record");
        assert_eq!(again, painting, "{forget:?}");
        assert_eq!(count > 10, is_kept, "{forget:?}: {count} messages");
    }
}

/// A painting in the previous format.
fn older(path: &Path) {
    let (database, _) = Database::open(path, Access::Paint, None).expect("opened");
    let older = "DROP TABLE beginning; DROP TABLE record; PRAGMA user_version = 4";
    database.connection().execute_batch(older).expect("older");
    database.close().expect("closed");
}

#[test]
fn a_painting_of_the_format_before_is_read_as_it_is_and_gets_a_record_when_it_is_painted_in() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let mut painter = paint(&path, 12, 30);
    let painting = stored(&path);
    older(&path);
    let bytes = std::fs::read(&path).expect("read");
    assert!(executed_again(&path, |_| false).is_none());
    assert_eq!(stored(&path), painting);
    let stats = DocumentStats::read(&path).expect("read");
    assert_eq!((stats.format, stats.record), (4, None));
    stats.check(&path, &mut |_, _| {}).expect("whole");
    assert!(
        std::fs::read(&path).expect("read") == bytes,
        "nothing is written"
    );

    let mut easel = Easel::open(&settings(&path, Access::Paint)).expect("opened");
    strokes(&mut easel, &mut painter, 2);
    easel.checkpoint();
    easel.flush();
    strokes(&mut easel, &mut painter, 2);
    easel.close();
    let (count, again) = executed_again(&path, |_| false).expect("a record");
    assert!(count >= 2, "{count} messages");
    assert_eq!(again, stored(&path));
    let stats = DocumentStats::read(&path).expect("read");
    assert_eq!(stats.format, VERSION);
    let record = stats.record.expect("a record");
    assert!(
        record.bytes > 0 && record.newest_ms >= record.begun_ms,
        "{record:?}"
    );
    assert!(
        record.begun_ms > 1_700_000_000_000,
        "a time of the wall clock"
    );
    let head = std::fs::read(&path).expect("read");
    assert_eq!(head[68..72], APPLICATION_ID.to_be_bytes());
}

/// A written row survives the killing of the program: a copy of the file is opened.
#[test]
fn a_killed_program_leaves_its_record() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let mut painter = Painter::new(21);
    let mut easel = Easel::begin(&settings(&path, Access::Paint));
    strokes(&mut easel, &mut painter, 5);
    easel.checkpoint();
    easel.flush();
    strokes(&mut easel, &mut painter, 4);
    easel.flush();
    let killed = folder.path().join("b.maul");
    for suffix in ["", "-wal"] {
        let name = |path: &Path| format!("{}{suffix}", path.display());
        std::fs::copy(name(&path), name(&killed)).expect("copied");
    }
    easel.close();
    let (count, again) = executed_again(&killed, |_| false).expect("a record");
    assert!(count >= 9, "{count} messages");
    assert_eq!(again, stored(&killed));
    assert_eq!(again, stored(&path));
    // It continues there.
    let mut easel = Easel::open(&settings(&killed, Access::Paint)).expect("opened");
    strokes(&mut easel, &mut painter, 2);
    easel.close();
    let is_resumed = |record: &Record| {
        let Accepted::Entry(Entry::Decision { what }) = &record.what else {
            return false;
        };
        *what == Decision::Resumed
    };
    let mut resumed = 0;
    let (_, again) = executed_again(&killed, |record| {
        resumed += usize::from(is_resumed(record));
        false
    })
    .expect("a record");
    assert_eq!((resumed, again), (1, stored(&killed)));
}

/// Tiles from a record in a copy that was rewound to the beginning of the record, and saved there.
fn rewound(path: &Path, copy: &Path, skips: u64) -> Tiles {
    std::fs::copy(path, copy).expect("copied");
    assert!(rewind(copy).expect("taken back"));
    let stats = DocumentStats::read(copy).expect("read");
    assert_eq!(stats.record, None);
    stats.check(copy, &mut |_, _| {}).expect("intact");
    let (copied, opened) = Document::open(&settings(copy, Access::Paint)).expect("opened");
    let opened = opened.expect("a painting");
    opened.check().expect("all rows are there");
    let mut sequencer = opened.in_its_midst().expect("whole");
    let (document, _) = Document::open(&settings(path, Access::Read)).expect("opened");
    let mut next = sequencer.serial();
    let first = next;
    while let Some(row) = document.record_row(next).expect("intact") {
        for record in row.records {
            next = record.serial + 1;
            if record.serial >= first + skips {
                sequencer.replay(record);
            }
        }
    }
    assert_eq!(copied.pager().fault(), None);
    tiles(&mut sequencer)
}

#[test]
fn a_copy_taken_back_to_where_its_record_begins_becomes_the_same_painting_by_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut differs = false;
    for seed in 1..5 {
        let path = at(&format!("{seed}.maul"));
        paint(&path, seed, 40);
        let before = std::fs::read(&path).expect("read");
        let same = rewound(&path, &at(&format!("{seed} again.maul")), 0);
        assert_eq!(same, stored(&path), "{seed}");
        assert!(std::fs::read(&path).expect("read") == before, "{seed}");
        let other = rewound(&path, &at(&format!("{seed} less.maul")), 5);
        differs |= other != same;
    }
    assert!(differs, "records that are left out are missed");
}

#[test]
fn a_painting_without_a_record_is_not_taken_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sea.maul");
    paint(&path, 7, 10);
    discard(&path).expect("discarded");
    let before = stored(&path);
    assert!(!rewind(&path).expect("read"));
    assert_eq!(stored(&path), before);
}
