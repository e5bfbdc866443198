//! The file of an open painting is removed, replaced or linked during painting.

mod easel;
mod studio;

use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use easel::Easel;
use maulstick_document::{Access, Document, DocumentError, DocumentSettings, Relocate, make_room};
use maulstick_types::command::advice::Advice;
use studio::{Painter, print};

fn settings(path: &Path) -> DocumentSettings {
    DocumentSettings::new(path, Access::Paint)
}

fn paint(easel: &mut Easel, painter: &mut Painter) {
    for _ in 0..10 {
        let act = painter.next();
        easel.act(painter, &act);
        easel.checkpoint();
    }
}

/// Waits until the document says something, and returns it.
fn fault(document: &Document) -> (String, Advice) {
    loop {
        if let Some(fault) = document.fault() {
            return fault;
        }
        std::thread::yield_now();
    }
}

/// Checks that a document says that its file is gone.
fn is_vanished(document: &Document, path: &Path) {
    let (what, advice) = fault(document);
    assert!(what.contains(&path.display().to_string()), "{what}");
    assert_eq!(advice, DocumentError::Vanished(String::new()).advice());
}

fn journal(path: &Path) -> PathBuf {
    path.with_extension("maul-wal")
}

/// State of a painting whose program was killed just now.
fn after_a_kill(path: &Path) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let copy = folder.path().join("killed.maul");
    std::fs::copy(path, &copy).expect("copied");
    if journal(path).exists() {
        std::fs::copy(journal(path), journal(&copy)).expect("copied");
    }
    let mut easel = Easel::open(&settings(&copy)).expect("whole");
    print(&mut easel.sequencer)
}

/// Paints, has `harm` done to the file, which is called by its `cause`, paints on, and sees what is found where the
/// painting went.
fn painted_on(harm: impl Fn(&Path), cause: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sea.maul");
    let mut easel = Easel::begin(&settings(&path));
    let mut painter = Painter::new(7);
    paint(&mut easel, &mut painter);
    easel.flush();
    harm(&path);
    // Nothing is painted meanwhile: it is seen all the same.
    let (what, _) = fault(&easel.document);
    easel.document.update_path();
    let kept = folder.path().join("sea-kept.maul");
    assert!(what.contains("sea-kept.maul"), "{what}");
    assert!(what.contains(cause), "{what}");
    assert_eq!(easel.document.path(), kept);
    paint(&mut easel, &mut painter);
    easel.document.flush();
    let seen = print(&mut easel.sequencer);
    assert_eq!(after_a_kill(&kept), seen);
    assert!(easel.document.is_saved());
    // Reported until the painter has given it a name.
    assert!(easel.document.fault().is_some());
    let named = folder.path().join("named.maul");
    let moving = easel.document.relocate(&named, Relocate::Copy, false);
    easel.document.wait_for_relocation(&moving).expect("moved");
    assert_eq!(easel.document.fault(), None);
    easel.close();
    assert_eq!(after_a_kill(&named), seen);
}

/// Cuts a file to this share of its length, in place.
fn cut(path: &Path, [part, whole]: [u64; 2]) {
    let file = std::fs::File::options().write(true).open(path);
    let file = file.expect("it is there");
    let bytes = file.metadata().expect("it is there").len();
    file.set_len(bytes * part / whole).expect("cut");
}

#[test]
fn a_journal_cut_short_in_place_loses_nothing() {
    for share in [[0, 1], [1, 2], [9, 10]] {
        painted_on(|path| cut(&journal(path), share), "short");
    }
}

#[test]
fn a_file_cut_short_in_place_loses_nothing_that_is_in_memory() {
    for share in [[0, 1], [1, 2]] {
        painted_on(|path| cut(path, share), "short");
    }
}

#[test]
fn a_journal_cut_to_nothing_and_written_on_is_noticed() {
    painted_on(
        |path| {
            let file = std::fs::File::options().write(true).open(journal(path));
            let file = file.expect("it is there");
            let bytes = file.metadata().expect("it is there").len();
            file.set_len(0).expect("cut");
            file.set_len(2 * bytes).expect("written on");
        },
        "short",
    );
}

#[test]
fn a_painting_whose_journal_was_cut_can_be_read_after_a_kill() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sea.maul");
    let mut easel = Easel::begin(&settings(&path));
    paint(&mut easel, &mut Painter::new(7));
    easel.flush();
    cut(&journal(&path), [0, 1]);
    // Its program is killed before it can detect this.
    assert!(!after_a_kill(&path).is_empty());
}

#[test]
fn a_painting_is_not_saved_while_its_file_lacks_a_part_of_it() {
    let folder = tempfile::tempdir().expect("a folder");
    // Detected while it is open, or only when it is closed.
    for is_noticed in [true, false] {
        let path = folder.path().join(format!("sea-{is_noticed}.maul"));
        let mut easel = Easel::begin(&settings(&path));
        paint(&mut easel, &mut Painter::new(7));
        easel.flush();
        assert!(easel.document.is_saved());
        cut(&journal(&path), [0, 1]);
        if is_noticed {
            fault(&easel.document);
            assert!(!easel.document.is_saved());
        }
        let closed = easel.document.close();
        assert!(
            matches!(closed, Err(DocumentError::Incomplete(_))),
            "{closed:?}"
        );
    }
}

#[test]
fn a_painting_is_moved_only_when_its_file_has_all_of_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let [path, named] = ["sea.maul", "named.maul"].map(|name| folder.path().join(name));
    let mut easel = Easel::begin(&settings(&path));
    let mut painter = Painter::new(7);
    paint(&mut easel, &mut painter);
    easel.flush();
    cut(&journal(&path), [0, 1]);
    for how in [Relocate::Leave, Relocate::Copy, Relocate::Rename] {
        let moving = easel.document.relocate(&named, how, false);
        let refused = easel.document.wait_for_relocation(&moving);
        assert!(
            matches!(refused, Err(DocumentError::Incomplete(_))),
            "{how:?}: {refused:?}"
        );
        assert!(!named.exists());
        // Records accepted meanwhile do not delay the answer.
        let act = painter.next();
        easel.act(&mut painter, &act);
    }
    assert!(!easel.document.is_saved());
    easel.checkpoint();
    easel.document.flush();
    assert!(easel.document.is_saved());
    let moving = easel.document.relocate(&named, Relocate::Copy, false);
    easel.document.wait_for_relocation(&moving).expect("moved");
    let seen = print(&mut easel.sequencer);
    assert_eq!(after_a_kill(&named), seen);
    easel.close();
    assert_eq!(after_a_kill(&named), seen);
}

#[test]
fn a_painting_that_was_cut_short_and_gets_no_file_beside_it_goes_on_where_it_is_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    // A name has at most 255 bytes: this one fits its journal, but the name of a copy is too long.
    let name = format!("{}.maul", "a".repeat(242));
    let [path, to] = [&*name, "b.maul"].map(|name| folder.path().join(name));
    let mut easel = Easel::begin(&settings(&path));
    let mut painter = Painter::new(7);
    paint(&mut easel, &mut painter);
    easel.flush();
    cut(&journal(&path), [0, 1]);
    is_vanished(&easel.document, &path);
    assert!(!easel.document.is_saved());
    // Another painting is replaced only on request.
    Easel::begin(&settings(&to)).close();
    let moving = easel.document.relocate(&to, Relocate::Copy, false);
    let refused = easel.document.wait_for_relocation(&moving);
    assert!(matches!(refused, Err(DocumentError::Taken)), "{refused:?}");
    let moving = easel.document.relocate(&to, Relocate::Copy, true);
    let refused = easel.document.wait_for_relocation(&moving);
    assert!(
        matches!(refused, Err(DocumentError::Incomplete(_))),
        "{refused:?}"
    );
    easel.document.update_path();
    assert_eq!(easel.document.path(), to);
    paint(&mut easel, &mut painter);
    easel.flush();
    assert!(easel.document.is_saved());
    let seen = print(&mut easel.sequencer);
    easel.close();
    assert_eq!(after_a_kill(&to), seen);
}

#[test]
fn a_removed_journal_loses_nothing() {
    painted_on(
        |path| std::fs::remove_file(journal(path)).expect("removed"),
        "removed",
    );
}

#[test]
fn a_replaced_journal_loses_nothing() {
    painted_on(
        |path| {
            let other = path.with_extension("png");
            std::fs::write(&other, "a picture").expect("written");
            std::fs::rename(&other, journal(path)).expect("renamed");
        },
        "replaced",
    );
}

#[test]
fn a_removed_file_loses_nothing() {
    painted_on(
        |path| std::fs::remove_file(path).expect("removed"),
        "removed",
    );
}

#[test]
fn a_replaced_file_loses_nothing_and_stays_as_it_is() {
    painted_on(
        |path| {
            let other = path.with_extension("txt");
            std::fs::write(&other, "a shopping list").expect("written");
            std::fs::rename(&other, path).expect("renamed");
        },
        "replaced",
    );
}

#[test]
fn a_renamed_file_is_whole_by_its_new_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let [path, other] = ["a.maul", "b.maul"].map(|name| folder.path().join(name));
    let mut easel = Easel::begin(&settings(&path));
    paint(&mut easel, &mut Painter::new(3));
    easel.flush();
    let seen = print(&mut easel.sequencer);
    std::fs::rename(&path, &other).expect("renamed");
    fault(&easel.document);
    assert!(
        !journal(&path).exists(),
        "nobody could begin a painting beside it"
    );
    assert_eq!(after_a_kill(&other), seen);
}

#[test]
fn a_painting_whose_folder_is_gone_is_told_of_and_can_be_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).expect("made");
    let mut easel = Easel::begin(&settings(&inner.join("a.maul")));
    let mut painter = Painter::new(9);
    paint(&mut easel, &mut painter);
    easel.flush();
    std::fs::remove_dir_all(&inner).expect("removed");
    is_vanished(&easel.document, &inner.join("a.maul"));
    paint(&mut easel, &mut painter);
    assert!(!easel.document.is_saved());
    let to = folder.path().join("b.maul");
    let moving = easel.document.relocate(&to, Relocate::Copy, false);
    easel.document.wait_for_relocation(&moving).expect("moved");
    paint(&mut easel, &mut painter);
    easel.flush();
    let seen = print(&mut easel.sequencer);
    easel.close();
    assert_eq!(after_a_kill(&to), seen);
}

#[test]
fn a_painting_that_nobody_saved_elsewhere_says_so_at_its_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).expect("made");
    let easel = Easel::begin(&settings(&inner.join("a.maul")));
    easel.flush();
    std::fs::remove_dir_all(&inner).expect("removed");
    let closed = easel.document.close();
    assert!(
        matches!(closed, Err(DocumentError::Unwritten(_))),
        "{closed:?}"
    );
}

#[test]
fn a_second_name_is_told_of_for_as_long_as_it_is_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let [path, link] = ["a.maul", "b.maul"].map(|name| folder.path().join(name));
    let easel = Easel::begin(&settings(&path));
    easel.flush();
    std::fs::hard_link(&path, &link).expect("a second name");
    let (what, advice) = fault(&easel.document);
    assert!(what.contains(&path.display().to_string()), "{what}");
    assert_ne!(advice, DocumentError::Vanished(String::new()).advice());
    assert!(easel.document.is_saved(), "all is written");
    std::fs::remove_file(&link).expect("removed");
    while easel.document.fault().is_some() {
        std::thread::yield_now();
    }
}

/// True if this process holds locks of a file, from the kernel's list.
fn is_locked(path: &Path) -> bool {
    let inode = format!(":{}", std::fs::metadata(path).expect("there").ino());
    let locks = std::fs::read_to_string("/proc/locks").expect("Linux");
    let me = std::process::id().to_string();
    locks.lines().any(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        words.contains(&"POSIX")
            && words.contains(&&*me)
            && words.iter().any(|w| w.ends_with(&inode))
    })
}

#[test]
fn a_look_at_a_painting_by_another_name_leaves_its_locks() {
    let folder = tempfile::tempdir().expect("a folder");
    let [path, link] = ["a.maul", "b.maul"].map(|name| folder.path().join(name));
    let easel = Easel::begin(&settings(&path));
    easel.flush();
    std::fs::hard_link(&path, &link).expect("a second name");
    for name in [&path, &link] {
        let room = make_room(name, true);
        assert!(matches!(room, Err(DocumentError::OpenHere)), "{room:?}");
        let opened = Document::open(&settings(name)).err();
        assert!(
            matches!(opened, Some(DocumentError::OpenHere)),
            "{opened:?}"
        );
        assert!(is_locked(&path));
    }
    drop(easel);
    assert!(!is_locked(&path), "a fault would pass");
    std::fs::remove_file(&link).expect("removed");
    assert!(Document::open(&settings(&path)).is_ok());
}

#[test]
fn no_painting_begins_where_the_journal_of_another_is() {
    let folder = tempfile::tempdir().expect("a folder");
    for ending in ["wal", "shm", "journal"] {
        let path = folder.path().join(format!("a.maul-{ending}"));
        let refused =
            |error: Option<DocumentError>| matches!(error, Some(DocumentError::Companion));
        assert!(refused(Document::open(&settings(&path)).err()));
        assert!(refused(make_room(&path, true).err()));
        assert!(!path.exists());
    }
}
