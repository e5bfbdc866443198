//! The disk of an open painting fails for a while: painting continues, the failure is reported, and all is written once
//! the disk is back.

mod crash_vfs;
mod easel;
mod studio;

use std::path::Path;

use crash_vfs::{Log, Refused, watch};
use easel::Easel;
use maulstick_canvas::page::Page;
use maulstick_canvas::planes::Planes;
use maulstick_document::{Access, DocumentError, DocumentSettings, Relocate};
use studio::{Act, Painter, print};
use tempfile::TempDir;

struct Session {
    easel: Easel,
    painter: Painter,
    log: Log,
    settings: DocumentSettings,
    folder: TempDir,
}

impl Session {
    fn begin() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().canonicalize().expect("there").join("a.maul");
        let log = watch(&path);
        let settings = DocumentSettings {
            vfs: Some("crash".to_owned()),
            ..DocumentSettings::new(&path, Access::Paint)
        };
        let mut session = Self {
            easel: Easel::begin(&settings),
            painter: Painter::new(7),
            log,
            settings,
            folder,
        };
        session.paint(20);
        while session.pages().is_empty() {
            session.paint(1);
        }
        session.easel.flush();
        session
    }

    /// Pages of all tiles, wet and dry.
    fn pages(&self) -> Vec<Page<Planes>> {
        let painting = self.easel.sequencer.painting();
        let stores = [0, 1].map(|surface| painting.store(surface).expect("a surface"));
        let tiles = stores.into_iter().flat_map(|store| store.iter());
        tiles
            .filter_map(|(_, version)| version.tile.as_deref())
            .flat_map(|tile| {
                let dry = tile.dry().into_iter().flat_map(|stack| stack.layers());
                let dry = dry.map(|layer| layer.planes.clone());
                tile.wet_page().cloned().into_iter().chain(dry)
            })
            .collect()
    }

    fn paint(&mut self, acts: usize) {
        for _ in 0..acts {
            let act = self.painter.next();
            self.easel.act(&mut self.painter, &act);
            self.easel.checkpoint();
        }
    }

    /// Strokes alone: an undo may need rows that are in the file alone.
    fn paint_strokes(&mut self, strokes: usize) {
        let mut left = strokes;
        while left > 0 {
            let act = self.painter.next();
            if matches!(act, Act::Paint(..)) {
                self.easel.act(&mut self.painter, &act);
                self.easel.checkpoint();
                left -= 1;
            }
        }
    }

    /// Waits until the document says that its disk fails, or that it does not.
    fn wait_until(&self, fails: bool) {
        while self.easel.document.fault().is_some() != fails {
            std::thread::yield_now();
        }
    }

    /// Content of the file after closing.
    fn closed(mut self) -> (Vec<String>, Vec<String>) {
        let seen = print(&mut self.easel.sequencer);
        self.easel.close();
        let mut again = Easel::open(&self.settings).expect("whole");
        (seen, print(&mut again.sequencer))
    }
}

#[test]
fn a_disk_that_fails_is_painted_on_and_written_when_it_is_back() {
    let mut session = Session::begin();
    session.log.refuse(Refused::Everything);
    session.paint(10);
    session.wait_until(true);
    let (_, advice) = session.easel.document.fault().expect("told");
    let disk = DocumentError::Disk(String::new());
    assert_eq!(advice, disk.advice());
    // It is painted on for as long as it lasts.
    session.paint(30);
    assert_eq!(session.easel.document.pager().fault(), None);
    session.log.refuse(Refused::Nothing);
    session.wait_until(false);
    let (seen, found) = session.closed();
    assert_eq!(found, seen);
}

#[test]
fn a_painting_that_was_opened_again_is_painted_on_though_its_disk_fails() {
    let mut session = Session::begin();
    session.easel.close();
    session.easel = Easel::open(&session.settings).expect("whole");
    // Pages without a waiting reader are read after all others.
    let pager = session.easel.document.pager().clone();
    let pages = session.pages();
    while pages.iter().any(|page| page.peek().is_none()) {
        std::thread::yield_now();
    }
    session.log.refuse(Refused::Everything);
    session.paint_strokes(10);
    session.wait_until(true);
    session.paint_strokes(10);
    assert_eq!(pager.fault(), None);
    session.log.refuse(Refused::Nothing);
    session.wait_until(false);
    let (seen, found) = session.closed();
    assert_eq!(found, seen);
}

#[test]
fn a_painting_is_not_moved_while_its_disk_fails_and_goes_on_where_it_is() {
    let mut session = Session::begin();
    session.log.refuse(Refused::Everything);
    session.paint(3);
    session.wait_until(true);
    let to = session.folder.path().join("b.maul");
    for how in [Relocate::Copy, Relocate::Rename] {
        let document = &mut session.easel.document;
        let moving = document.relocate(&to, how, false);
        let refused = document.wait_for_relocation(&moving);
        assert!(refused.is_err(), "{how:?}");
        assert!(!to.exists());
    }
    session.paint(3);
    session.log.refuse(Refused::Nothing);
    session.wait_until(false);
    let (seen, found) = session.closed();
    assert_eq!(found, seen);
}

#[test]
fn a_new_painting_is_in_its_file_at_once_without_its_journal() {
    let session = Session::begin();
    let copy = session.folder.path().join("copy.maul");
    std::fs::copy(&session.settings.path, &copy).expect("copied");
    let settings = DocumentSettings::new(Path::new(&copy), Access::Read);
    assert!(Easel::open(&settings).is_ok());
}
