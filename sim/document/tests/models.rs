//! A painting of every paint model in a document: saved, opened again, undone and continued like one in memory.

mod easel;
mod studio;

use std::sync::Arc;

use easel::Easel;
use maulstick_document::{Access, Checkpoint, Document, DocumentSettings};
use maulstick_models::model_names;
use maulstick_painting::edits::{Redo, Undo};
use maulstick_types::scene::CANVAS;
use studio::{Painter, equip, print, sequencer, sequencer_of};

#[test]
fn each_goes_on_in_its_document_as_in_memory() {
    let mut ends = Vec::new();
    for model in model_names() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("painting.maul");
        let settings = DocumentSettings::new(&path, Access::Paint);
        let (document, _) = Document::open(&settings).expect("begun");
        let mut kept = sequencer_of(model, Arc::clone(document.pager()));
        let mut alone = sequencer_of(model, Arc::default());
        let mut painters = [Painter::new(7), Painter::new(7)];
        equip(&mut kept);
        equip(&mut alone);
        let mut act = |both: [&mut maulstick_painting::Sequencer; 2]| {
            for (painter, sequencer) in painters.iter_mut().zip(both) {
                let act = painter.next();
                painter.act(sequencer, &act);
            }
        };
        for _ in 0..25 {
            act([&mut kept, &mut alone]);
        }
        document.write_checkpoint(Checkpoint::of(&mut kept, 0));
        document.flush();
        document.close().expect("closed");
        let Easel {
            sequencer: mut kept,
            document: _open,
            ..
        } = Easel::open(&settings).expect("whole");
        // An opened painting continues with lifted brushes.
        alone.resume();
        assert_eq!(kept.painting().model(CANVAS), Some(model));
        assert_eq!(print(&mut kept), print(&mut alone), "{model} opened again");
        for _ in 0..15 {
            act([&mut kept, &mut alone]);
        }
        assert_eq!(print(&mut kept), print(&mut alone), "{model} painted on");
        for sequencer in [&mut kept, &mut alone] {
            while sequencer.edit(Undo { brush: None }).is_ok() {}
        }
        assert_eq!(print(&mut kept), print(&mut alone), "{model} undone");
        while kept.edit(Redo { brush: None }).is_ok() {}
        assert_eq!(kept.painting_mut().report().quanta_missing, 0, "{model}");
        let end = print(&mut kept);
        assert!(!ends.contains(&end), "a fault would pass: {model}");
        ends.push(end);
    }
}

#[test]
fn a_model_that_the_program_does_not_know_is_told_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("painting.maul");
    let settings = DocumentSettings::new(&path, Access::Paint);
    let (document, _) = Document::open(&settings).expect("begun");
    let mut kept = sequencer(Arc::clone(document.pager()));
    let mut checkpoint = Checkpoint::of(&mut kept, 0);
    checkpoint.painting.kept.scene.surfaces[0].model = "watercolour".to_owned();
    document.write_checkpoint(checkpoint);
    document.flush();
    document.close().expect("closed");
    let error = Easel::open(&settings).err().expect("refused");
    assert!(error.contains("'watercolour'"), "{error}");
}
