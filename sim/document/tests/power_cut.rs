//! A painting survives a power cut at any moment: all that was reported as written is in its file.

mod crash_vfs;
mod easel;
mod studio;

use std::collections::BTreeMap;

use crash_vfs::{Log, watch};
use easel::Easel;
use maulstick_canvas::quantum::SLOTS;
use maulstick_document::{Access, Document, DocumentSettings};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;
use studio::{Dice, Painter, print};
use tempfile::TempDir;

/// Knowledge about the file at a point of the log.
struct Note {
    point: usize,
    /// Journal entries below this index were committed.
    committed: u64,
}

/// A painting session, with all operations on its file.
struct Session {
    log: Log,
    notes: Vec<Note>,
    /// Fingerprint of the painting by number of accepted messages, and the index of the next journal entry.
    prints: BTreeMap<u64, (u64, Vec<String>)>,
    _folder: TempDir,
}

impl Session {
    /// Paints from a seed, in a file that is closed and opened again occasionally.
    fn paint(seed: u64, acts: usize) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().canonicalize().expect("there").join("a.maul");
        let log = watch(&path);
        let settings = DocumentSettings {
            memory: 400_000,
            vfs: Some("crash".to_owned()),
            ..DocumentSettings::new(&path, Access::Paint)
        };
        let mut painter = Painter::new(seed);
        let mut dice = Dice::new(seed ^ 0x5eed);
        let mut session = Self {
            log,
            notes: Vec::new(),
            prints: BTreeMap::new(),
            _folder: folder,
        };
        let mut easel = Easel::begin(&settings);
        session.print(&mut easel);
        for _ in 0..acts {
            let act = painter.next();
            easel.act(&mut painter, &act);
            session.print(&mut easel);
            if dice.below(3) == 0 {
                easel.checkpoint();
            }
            if dice.below(4) == 0 {
                easel.flush();
                session.note(&easel);
            }
            if dice.below(15) == 0 {
                easel.close();
                easel = Easel::open(&settings).expect("opened");
                session.note(&easel);
            }
        }
        easel.flush();
        session.note(&easel);
        easel.close();
        session
    }

    fn print(&mut self, easel: &mut Easel) {
        let sequencer = &mut easel.sequencer;
        let (serial, index) = (sequencer.serial(), sequencer.journal_next());
        self.prints.insert(serial, (index, print(sequencer)));
    }

    fn note(&mut self, easel: &Easel) {
        self.notes.push(Note {
            point: self.log.point(),
            committed: easel.document.committed(),
        });
    }

    /// The fault of the painting in an image of the files after a power cut at `point`.
    fn check(&self, image: &crash_vfs::Image, point: usize) -> Result<(), String> {
        let folder = tempfile::tempdir().expect("a folder");
        image.write_to(folder.path(), "b.maul");
        let settings = DocumentSettings::new(&folder.path().join("b.maul"), Access::Paint);
        let notes = self.notes.iter().filter(|note| note.point <= point);
        let committed = notes.map(|note| note.committed).max().unwrap_or(0);
        let (document, opened) = Document::open(&settings).map_err(|error| error.to_string())?;
        if opened.is_none() {
            return match committed {
                0 => document.close().map_err(|error| error.to_string()),
                _ => Err(format!(
                    "nothing is there, {committed} entries were committed"
                )),
            };
        }
        document.close().map_err(|error| error.to_string())?;
        let mut easel = Easel::open(&settings)?;
        // The continuation is a separate entry.
        let serial = easel.sequencer.serial() - 1;
        let index = easel.sequencer.journal_next() - 1;
        if index < committed {
            return Err(format!("{index} entries, {committed} were committed"));
        }
        let found = print(&mut easel.sequencer);
        let new = (0, Vec::new());
        let (_, expected) = self.prints.get(&serial).unwrap_or(&new);
        // The painting was not compared before its first brush.
        if serial > 0 && found != *expected {
            let differs = found.iter().zip(expected).find(|(one, other)| one != other);
            return Err(format!(
                "after {serial} things the painting is another: {differs:?}"
            ));
        }
        easel.undo_all();
        let left = easel
            .sequencer
            .painting()
            .store(0)
            .map(|store| store.counts());
        if left != Some([0; SLOTS]) {
            return Err("not all could be undone".to_owned());
        }
        print(&mut easel.sequencer);
        easel.try_close()
    }

    /// Faults after power cuts at random points.
    fn cut(
        &self,
        cuts: usize,
        image: impl Fn(&Log, &mut Pcg32, usize) -> crash_vfs::Image,
    ) -> Vec<(usize, String)> {
        let mut random = Pcg32::new(cuts as u64, 2);
        let mut wrong = Vec::new();
        for _ in 0..cuts {
            let point = random.next_u32() as usize % (self.log.point() + 1);
            let image = image(&self.log, &mut random, point);
            wrong.extend(self.check(&image, point).err().map(|error| (point, error)));
        }
        wrong
    }
}

#[test]
fn a_painting_outlives_power_cuts() {
    let session = Session::paint(7, 60);
    assert!(session.notes.iter().any(|note| note.committed > 20));
    assert_eq!(
        session.cut(40, |log, random, point| log.image(random, point)),
        []
    );
}

#[test]
fn a_painting_outlives_the_first_moments() {
    let session = Session::paint(11, 1);
    let mut random = Pcg32::new(3, 2);
    for point in 0..session.log.point().min(60) {
        let image = session.log.image(&mut random, point);
        assert_eq!(session.check(&image, point), Ok(()), "at {point}");
    }
}

#[test]
#[ignore = "long"]
fn paintings_outlive_two_hundred_power_cuts() {
    for seed in 0..4 {
        let session = Session::paint(seed, 120);
        let wrong = session.cut(50, |log, random, point| log.image(random, point));
        assert_eq!(wrong, [], "seed {seed}");
    }
}

/// A disk that reports a sync without syncing is detected.
#[test]
fn a_disk_that_lies_is_found_out() {
    let session = Session::paint(7, 60);
    let wrong = session.cut(40, |log, random, point| log.image_of_a_liar(random, point));
    assert!(wrong.len() > 10, "{wrong:?}");
    let lost = wrong
        .iter()
        .filter(|(_, error)| error.contains("were committed"));
    assert!(lost.count() > 0, "{wrong:?}");
}
