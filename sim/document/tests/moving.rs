//! A painting continues in another file, and one in memory alone gets a file.

mod crash_vfs;
mod easel;
mod studio;

use maulstick_canvas::quantum::SLOTS;
use maulstick_painting::edits::Undo;
use std::path::Path;
use std::sync::Arc;

use crash_vfs::Refused;
use easel::Easel;
use maulstick_document::{
    Access, Checkpoint, Document, DocumentError, DocumentSettings, Relocate, make_room, unfinished,
};
use studio::{Painter, equip, print, sequencer};

fn settings(path: &Path) -> DocumentSettings {
    DocumentSettings::new(path, Access::Paint)
}

/// Waits until a document is in another file, or stays where it is.
fn moved(
    document: &mut Document,
    to: &Path,
    left: Relocate,
    replace: bool,
) -> Result<(), DocumentError> {
    let moving = document.relocate(to, left, replace);
    loop {
        if let Some(outcome) = document.poll_relocation(&moving) {
            return outcome;
        }
        std::thread::yield_now();
    }
}

fn paint(easel: &mut Easel, painter: &mut Painter, acts: usize) {
    for _ in 0..acts {
        let act = painter.next();
        easel.act(painter, &act);
        easel.checkpoint();
    }
}

fn seen(path: &Path) -> Vec<String> {
    let mut easel = Easel::open(&settings(path)).expect("whole");
    print(&mut easel.sequencer)
}

#[test]
fn a_copy_goes_on_and_the_file_before_stays_as_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let [first, second] = ["a.maul", "b.maul"].map(|name| folder.path().join(name));
    let mut easel = Easel::begin(&settings(&first));
    let mut painter = Painter::new(7);
    paint(&mut easel, &mut painter, 20);
    let before = print(&mut easel.sequencer);
    moved(&mut easel.document, &second, Relocate::Copy, false).expect("moved");
    assert_eq!(easel.document.path(), second);
    paint(&mut easel, &mut painter, 20);
    let after = print(&mut easel.sequencer);
    assert_ne!(before, after, "a fault would pass");
    easel.close();
    assert_eq!(seen(&first), before);
    assert_eq!(seen(&second), after);
    let names = std::fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(names, 2, "nothing is left beside them");
}

#[test]
fn what_was_in_memory_is_in_the_file_with_its_history() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let mut kept = sequencer(Arc::default());
    equip(&mut kept);
    let mut painter = Painter::new(11);
    for _ in 0..25 {
        let act = painter.next();
        painter.act(&mut kept, &act);
    }
    let pager = kept.painting().pager().clone();
    let mut document = Document::begin(&settings(&unfinished(&path)), &pager).expect("begun");
    assert!(!path.exists());
    kept.painting_mut().tell_all_again();
    kept.record();
    let checkpoint = Checkpoint::of(&mut kept, 0);
    let since = checkpoint.painting.kept.versions;
    document.write_checkpoint(checkpoint);
    document.flush();
    document.limit_memory(1 << 16);
    moved(&mut document, &path, Relocate::Rename, false).expect("moved");
    for _ in 0..15 {
        let act = painter.next();
        painter.act(&mut kept, &act);
        document.record(kept.take_records());
    }
    document.write_checkpoint(Checkpoint::of(&mut kept, since));
    let end = print(&mut kept);
    let undo = |kept: &mut maulstick_painting::Sequencer| {
        let mut steps = 0;
        while kept.edit(Undo { brush: None }).is_ok() {
            steps += 1;
        }
        steps
    };
    document.close().expect("closed");
    assert_eq!(seen(&path), end);
    let mut again = Easel::open(&settings(&path)).expect("whole");
    let steps = undo(&mut again.sequencer);
    assert!(steps > 0, "its history is there");
    let store = again.sequencer.painting().store(0).expect("a canvas");
    assert_eq!(store.counts(), [0; SLOTS], "all is undone");
    assert!(!unfinished(&path).exists());
}

#[test]
fn what_may_not_go_is_not_written_over_and_the_painting_goes_on_where_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut easel = Easel::begin(&settings(&at("a.maul")));
    let mut painter = Painter::new(3);
    paint(&mut easel, &mut painter, 10);
    let mut other = Easel::begin(&settings(&at("other.maul")));
    paint(&mut other, &mut Painter::new(4), 10);
    let held = print(&mut other.sequencer);
    std::fs::write(at("list.txt"), "a shopping list, longer than a head").expect("written");
    let to = |easel: &mut Easel, name: &str, replace: bool| {
        moved(&mut easel.document, &at(name), Relocate::Copy, replace)
    };
    let refused = to(&mut easel, "list.txt", true);
    assert!(
        matches!(refused, Err(DocumentError::NoPainting)),
        "{refused:?}"
    );
    let refused = to(&mut easel, "no/folder.maul", false);
    assert!(
        matches!(refused, Err(DocumentError::Other(_))),
        "{refused:?}"
    );
    assert!(make_room(&at("list.txt"), false).is_err());
    other.close();
    let refused = to(&mut easel, "other.maul", false);
    assert!(matches!(refused, Err(DocumentError::Taken)), "{refused:?}");
    assert_eq!(seen(&at("other.maul")), held, "as it was");
    assert_eq!(easel.document.path(), at("a.maul"));
    paint(&mut easel, &mut painter, 10);
    easel.flush();
    to(&mut easel, "other.maul", true).expect("it may go");
    let end = print(&mut easel.sequencer);
    easel.close();
    assert_eq!(seen(&at("other.maul")), end);
    assert_eq!(
        std::fs::read(at("list.txt")).expect("there"),
        b"a shopping list, longer than a head"
    );
}

#[test]
fn what_has_no_room_for_its_journal_stays_where_it_is_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    // A painting that was not closed: a part of it is in its journal.
    let mut other = Easel::begin(&settings(&at("other.maul")));
    paint(&mut other, &mut Painter::new(4), 10);
    other.flush();
    for ending in ["", "-wal"] {
        let [from, to] = ["other.maul", "left.maul"].map(|name| at(&format!("{name}{ending}")));
        std::fs::copy(from, to).expect("copied");
    }
    let held = print(&mut other.sequencer);
    other.close();
    let [own, left] = ["a.maul", "left.maul"].map(|name| crash_vfs::watch_by_default(&at(name)));
    let mut easel = Easel::begin(&settings(&at("a.maul")));
    let mut painter = Painter::new(3);
    paint(&mut easel, &mut painter, 10);
    own.refuse(Refused::Writes);
    let refused = moved(&mut easel.document, &at("b.maul"), Relocate::Copy, false);
    assert!(
        matches!(&refused, Err(DocumentError::Unmerged(path)) if *path == at("a.maul")),
        "{refused:?}"
    );
    assert!(!at("b.maul").exists());
    own.refuse(Refused::Nothing);
    left.refuse(Refused::Writes);
    let refused = moved(&mut easel.document, &at("left.maul"), Relocate::Copy, true);
    assert!(
        matches!(&refused, Err(DocumentError::Unmerged(path)) if *path == at("left.maul")),
        "{refused:?}"
    );
    left.refuse(Refused::Nothing);
    paint(&mut easel, &mut painter, 10);
    let end = print(&mut easel.sequencer);
    easel.close();
    assert_eq!(seen(&at("a.maul")), end);
    assert_eq!(seen(&at("left.maul")), held);
    assert_ne!(end, held, "a fault would pass");
}

#[test]
fn a_painting_that_cannot_be_opened_where_it_went_goes_on_where_it_was() {
    for left in [Relocate::Copy, Relocate::Rename] {
        let folder = tempfile::tempdir().expect("a folder");
        let [first, second] = ["a.maul", "b.maul"].map(|name| folder.path().join(name));
        let log = crash_vfs::watch_by_default(&second);
        log.refuse(Refused::Opening);
        let mut easel = Easel::begin(&settings(&first));
        let mut painter = Painter::new(5);
        paint(&mut easel, &mut painter, 10);
        let refused = moved(&mut easel.document, &second, left, false);
        assert!(
            matches!(refused, Err(DocumentError::ReadOnly(_))),
            "{refused:?}"
        );
        assert_eq!(easel.document.path(), first);
        assert_eq!(second.exists(), left == Relocate::Copy);
        paint(&mut easel, &mut painter, 10);
        let end = print(&mut easel.sequencer);
        easel.close();
        assert_eq!(seen(&first), end);
    }
}

#[test]
fn a_painting_whose_journal_cannot_be_read_is_not_moved_and_goes_on_where_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let [first, second] = ["a.maul", "b.maul"].map(|name| folder.path().join(name));
    let log = crash_vfs::watch_by_default(&first);
    let mut easel = Easel::begin(&settings(&first));
    let mut painter = Painter::new(5);
    paint(&mut easel, &mut painter, 10);
    easel.flush();
    for left in [Relocate::Copy, Relocate::Rename] {
        log.refuse(Refused::Reads);
        let refused = moved(&mut easel.document, &second, left, false);
        log.refuse(Refused::Nothing);
        assert!(refused.is_err(), "{left:?}");
        assert!(!second.exists());
    }
    paint(&mut easel, &mut painter, 10);
    let end = print(&mut easel.sequencer);
    easel.close();
    assert_eq!(seen(&first), end);
}

#[test]
fn a_link_leads_to_the_painting_that_took_the_place_of_another() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("far")).expect("a folder");
    let mut other = Easel::begin(&settings(&at("far/old.maul")));
    paint(&mut other, &mut Painter::new(4), 5);
    other.close();
    std::os::unix::fs::symlink(at("far/old.maul"), at("link.maul")).expect("a link");
    let mut easel = Easel::begin(&settings(&at("a.maul")));
    paint(&mut easel, &mut Painter::new(3), 10);
    moved(&mut easel.document, &at("link.maul"), Relocate::Copy, true).expect("moved");
    let end = print(&mut easel.sequencer);
    easel.close();
    assert!(at("link.maul").is_symlink());
    assert_eq!(seen(&at("far/old.maul")), end);
    let names = std::fs::read_dir(at("far")).expect("a folder").count();
    assert_eq!(names, 1, "nothing is left beside it");
}
