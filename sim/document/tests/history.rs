//! Any sequence of edits, undo and redo gives the same bytes, in memory and in a document.

mod studio;

use std::sync::Arc;

use maulstick_canvas::quantum::SLOTS;
use maulstick_document::{Access, Checkpoint, Document, DocumentSettings};
use maulstick_painting::Sequencer;
use maulstick_painting::edits::{Redo, Undo};
use maulstick_types::command::Outcome;
use proptest::prelude::*;
use studio::{Painter, equip, print, sequencer};

/// Visible state of a painting: all but the depth of its history.
fn seen(sequencer: &mut Sequencer) -> Vec<String> {
    let mut lines = print(sequencer);
    lines.remove(1);
    lines
}

fn is_done(outcome: &Outcome) -> bool {
    matches!(outcome, Outcome::Done { .. })
}

/// Paints with `quota` bytes of history, and undoes all of it.
fn goes_back(seed: u64, acts: usize, quota: u64) -> Result<(), TestCaseError> {
    let mut painter = Painter::new(seed);
    let mut sequencer = sequencer(Arc::default());
    equip(&mut sequencer);
    sequencer.painting_mut().set_quota(quota);
    for _ in 0..acts {
        let act = painter.next();
        painter.act(&mut sequencer, &act);
        seen(&mut sequencer);
    }
    while is_done(&painter.command(&mut sequencer, Undo { brush: None })) {
        seen(&mut sequencer);
    }
    let store = sequencer.painting().store(0).expect("a canvas");
    prop_assert_eq!(store.counts(), [0; SLOTS], "all is undone");
    let steps = sequencer.painting().history().steps();
    let apart = steps.skip(1).all(|step| step.operations == 1);
    prop_assert!(apart, "only the oldest are merged");
    Ok(())
}

/// One of two simultaneous painters paints between the tiles reached by the other's stroke, where its paint relaxes.
#[test]
fn two_who_paint_at_once_do_not_cover_each_other() {
    goes_back(9_554_720_162_090_198_157, 36, 1).expect("undone");
}

proptest! {
    #![proptest_config(studio::cases(12))]

    #[test]
    fn all_undone_and_redone_is_as_it_was(seed in any::<u64>(), acts in 1usize..40) {
        let mut painter = Painter::new(seed);
        let mut sequencer = sequencer(Arc::default());
        equip(&mut sequencer);
        for _ in 0..acts {
            let act = painter.next();
            painter.act(&mut sequencer, &act);
        }
        // Steps already undone are not tested here.
        while is_done(&painter.command(&mut sequencer, Redo { brush: None })) {}
        let end = seen(&mut sequencer);
        let mut prints = vec![end];
        while is_done(&painter.command(&mut sequencer, Undo { brush: None })) {
            prints.push(seen(&mut sequencer));
        }
        let store = sequencer.painting().store(0).expect("a canvas");
        prop_assert_eq!(store.counts(), [0; SLOTS], "all is undone");
        while let Some(expected) = prints.pop() {
            prop_assert_eq!(seen(&mut sequencer), expected);
            let redone = painter.command(&mut sequencer, Redo { brush: None });
            prop_assert_eq!(is_done(&redone), !prints.is_empty());
        }
    }

    /// With little room the oldest steps of the history are merged: it still goes back to the beginning, and the newest
    /// steps stay separate.
    #[test]
    fn a_short_history_goes_back_as_far(seed in any::<u64>(), acts in 20usize..60, quota in 1u64..2_000_000) {
        goes_back(seed, acts, quota)?;
    }

    /// A painting in a document, with little memory, closed, killed and opened again, compared with one in memory
    /// alone.
    #[test]
    fn a_document_is_the_painting(seed in any::<u64>(), acts in 1usize..60) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a painting.maul");
        let mut settings = DocumentSettings {
            memory: 400_000,
            ..DocumentSettings::new(&path, Access::Paint)
        };
        let mut painter = Painter::new(seed);
        let mut twin = sequencer(Arc::default());
        equip(&mut twin);
        let (document, opened) = Document::open(&settings).expect("begun");
        prop_assert!(opened.is_none());
        let mut document = Some(document);
        let mut kept = sequencer(Arc::clone(document.as_ref().expect("open").pager()));
        let mut since = 0;
        let mut log = Vec::new();
        kept.record();
        let checkpoint = |kept: &mut Sequencer, since: &mut u64| {
            let checkpoint = Checkpoint::of(kept, *since);
            *since = checkpoint.painting.kept.versions;
            checkpoint
        };
        document.as_ref().expect("open").write_checkpoint(checkpoint(&mut kept, &mut since));
        equip(&mut kept);
        for _ in 0..acts {
            let act = painter.next();
            let mut other = painter.clone();
            painter.act(&mut twin, &act);
            other.act(&mut kept, &act);
            let (one, two) = (seen(&mut kept), seen(&mut twin));
            let differ = one.iter().zip(&two).find(|(one, two)| one != two);
            prop_assert!(one == two, "{differ:#?} after {log:?} and {act}");
            log.push(act.to_string());
            let open = document.as_ref().expect("open");
            open.record(kept.take_records());
            if painter.dice.below(3) == 0 && open.is_ready() {
                open.write_checkpoint(checkpoint(&mut kept, &mut since));
            }
            if painter.dice.below(8) == 0 {
                open.flush();
                prop_assert_eq!(open.fault(), None);
                prop_assert_eq!(open.committed(), kept.journal_next());
                // A copy of the file stands for a killed program.
                let killed = settings.path.with_extension("killed.maul");
                for suffix in ["", "-wal"] {
                    let of = |path: &std::path::Path| format!("{}{suffix}", path.display());
                    std::fs::copy(of(&settings.path), of(&killed)).expect("copied");
                }
                settings.path = killed;
                drop(document.take());
                let (again, opened) = Document::open(&settings).expect("opened");
                let opened = opened.expect("a painting");
                since = opened.snapshot().versions;
                kept = opened.sequencer().expect("whole");
                twin.resume();
                log.push("killed".to_owned());
                let (one, two) = (print(&mut kept), print(&mut twin));
                for (one, two) in one.iter().zip(&two) {
                    prop_assert_eq!(one, two);
                }
                prop_assert_eq!(one.len(), two.len());
                document = Some(again);
            }
        }
        prop_assert_eq!(print(&mut kept), print(&mut twin));
        loop {
            let undo = Undo { brush: None };
            let mut other = painter.clone();
            let (one, two) = (painter.command(&mut twin, undo.clone()), other.command(&mut kept, undo));
            prop_assert_eq!(is_done(&one), is_done(&two));
            prop_assert_eq!(seen(&mut kept), seen(&mut twin));
            if !is_done(&one) {
                break;
            }
        }
        prop_assert_eq!(kept.painting().pager().fault(), None);
        document.expect("open").close().expect("closed");
    }
}
