//! A desk on which one paints in a document.

use std::path::Path;

use maulstick_brush::BrushFile;
use maulstick_document::{Access, Document, DocumentSettings};
use maulstick_optics::PaintLibrary;
use maulstick_painting::{Painting, PaintingSetup, Sequencer};
use maulstick_session::{Autosave, Offline};

/// Brush and paint with a document that is brought up to date as one asks for it.
pub(crate) struct Desk {
    pub(crate) offline: Offline,
    pub(crate) autosave: Autosave,
    pub(crate) now_ns: u64,
}

impl Desk {
    /// A painting of 160×120 cells, begun or opened, with a brush of the library.
    pub(crate) fn with(path: &Path, brush: &str) -> Self {
        let settings = DocumentSettings::new(path, Access::Paint);
        let (document, opened) = Document::open(&settings).expect("opened");
        let (mut sequencer, since) = match opened {
            Some(opened) => {
                let since = opened.snapshot().versions;
                (opened.sequencer().expect("whole"), since)
            }
            None => {
                let setup = PaintingSetup {
                    cells: [160, 120],
                    ..PaintingSetup::default()
                };
                let library = PaintLibrary::measured().expect("whole");
                let pager = document.pager().clone();
                let painting = Painting::paged(&setup, library, pager).expect("a painting");
                (Sequencer::new(painting), 0)
            }
        };
        let autosave = Autosave::new(document, &mut sequencer, since);
        let file = BrushFile::library(brush).expect("of the library");
        let offline = Offline::resume(sequencer, "main", file, 0.5, Vec::new());
        Self {
            offline: offline.expect("begun"),
            autosave,
            now_ns: 0,
        }
    }
}
