//! The document's thread step by step: reports of unreadable pages and of a lost file, and the pages kept in memory.

use std::path::{Path, PathBuf};
use std::sync::{Arc, mpsc};
use std::time::Instant;

use maulstick_canvas::page::backing::Backing as _;

use super::DocumentThread;
use super::failures::Part;
use super::queues::{DocumentBacking, EndGuard, Fetch};
use crate::error::DocumentError;
use crate::file::database::{Access, Database};

/// The thread of a new painting, run by hand.
fn thread_at(path: &Path) -> DocumentThread {
    let (database, _) = Database::open(path, Access::Paint, None).expect("begun");
    DocumentThread::new(Arc::default(), (database, path), true, 0)
}

fn journal(path: &Path) -> PathBuf {
    path.with_extension("maul-wal")
}

/// True if pages that are in the file may leave memory.
fn may_leave(thread: &DocumentThread) -> bool {
    DocumentBacking(Arc::clone(&thread.shared)).is_at_hand()
}

#[test]
fn a_fault_lasts_as_long_as_a_page_waits_that_could_not_be_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut thread = thread_at(&folder.path().join("sea.maul"));
    let (answer, _reader) = mpsc::channel();
    let failed = (Fetch::Planes(7, answer), Instant::now());
    thread.shared.lock().failed_fetches.push(failed);
    let error = DocumentError::Disk("it does not answer".to_owned());
    thread.note_failure(Part::Reading, &error);
    // Another page is read meanwhile.
    let (answer, _reader) = mpsc::channel();
    let fetch = Fetch::Shown([0; 3], answer);
    thread.shared.lock().fetches.push(fetch);
    thread.read_pages();
    assert!(thread.shared.lock().fault.is_some());
    assert!(!may_leave(&thread));
    thread.shared.lock().failed_fetches.clear();
    thread.read_pages();
    assert_eq!(thread.shared.lock().fault, None);
    assert!(may_leave(&thread));
}

#[test]
fn a_page_is_tried_again_whatever_keeps_it_from_being_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut thread = thread_at(&folder.path().join("sea.maul"));
    // SQLite reports a separate error, neither of the disk nor of damage.
    let away = thread.database.connection.execute_batch("DROP TABLE page");
    away.expect("dropped");
    let (answer, reader) = mpsc::channel();
    let fetch = Fetch::Planes(7, answer);
    thread.shared.lock().fetches.push(fetch);
    thread.read_pages();
    assert!(reader.try_recv().is_err(), "nothing is answered yet");
    assert_eq!(thread.shared.lock().failed_fetches.len(), 1);
    assert_eq!(thread.shared.lock().broken, None);
    assert!(thread.shared.lock().fault.is_some());
    assert!(!may_leave(&thread));
}

#[test]
fn a_painting_that_is_known_to_be_broken_is_not_read_through_for_each_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sea.maul");
    let mut thread = thread_at(&path);
    // A folder in its place makes reading the journal fail.
    std::fs::remove_file(journal(&path)).expect("removed");
    std::fs::create_dir(journal(&path)).expect("made");
    let (answer, reader) = mpsc::channel();
    let missing = Fetch::Planes(7, answer);
    thread.shared.lock().fetches.push(missing);
    thread.read_pages();
    assert!(reader.try_recv().is_err(), "the disk may be at fault");
    let (answer, reader) = mpsc::channel();
    let missing = Fetch::Planes(8, answer);
    {
        let mut queues = thread.shared.lock();
        queues.broken = Some("page 3 is missing".to_owned());
        queues.fetches.push(missing);
    }
    thread.read_pages();
    assert!(matches!(reader.try_recv(), Ok(Err(_))), "it is answered");
    assert!(!may_leave(&thread));
}

#[test]
fn no_page_leaves_memory_while_the_file_lacks_a_part_of_the_painting() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sea.maul");
    let mut thread = thread_at(&path);
    assert!(may_leave(&thread), "a fault would pass");
    let cut = std::fs::File::options().write(true).open(journal(&path));
    cut.expect("it is there").set_len(0).expect("cut");
    thread.check_files(false);
    assert!(thread.shared.lock().wants_all);
    assert!(!may_leave(&thread));
    // Other successes do not make it whole.
    thread.note_written(Part::Reading);
    assert!(!may_leave(&thread));
    thread.shared.lock().wants_all = false;
    thread.note_written(Part::Checkpoint);
    assert!(may_leave(&thread));
}

#[test]
fn no_page_leaves_memory_while_there_is_no_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).expect("made");
    let mut thread = thread_at(&inner.join("sea.maul"));
    std::fs::remove_dir_all(&inner).expect("removed");
    thread.check_files(false);
    assert!(thread.shared.lock().fault.is_some());
    assert!(!may_leave(&thread));
}

#[test]
fn no_page_leaves_memory_once_the_thread_has_ended() {
    let folder = tempfile::tempdir().expect("a folder");
    let thread = thread_at(&folder.path().join("sea.maul"));
    assert!(may_leave(&thread), "a fault would pass");
    drop(EndGuard(Arc::clone(&thread.shared)));
    assert!(!may_leave(&thread));
}
