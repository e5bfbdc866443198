//! A painting continues after a take without an end.

mod studio;

use std::sync::Arc;

use maulstick_document::{Access, Checkpoint, Document, DocumentSettings};
use maulstick_painting::Sequencer;
use maulstick_painting::edits::Load;
use maulstick_types::command::Command;
use maulstick_types::command::TakeCommand;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::BrushName;
use studio::{Act, BRUSHES, Painter, equip, mixture, sequencer};

fn take(again: bool, loads: &[&str]) -> Command {
    Command::from(TakeCommand::Begin {
        brush: BrushName::new(BRUSHES[0]).expect("valid"),
        device: 9,
        device_epoch: 1,
        loads: loads.iter().map(|load| mixture(load)).collect(),
        again,
    })
}

/// A live stroke of the first brush on the canvas.
fn stroke(painter: &mut Painter, sequencer: &mut Sequencer) {
    loop {
        let act = painter.next();
        if matches!(&act, Act::Paint(0, true, way) if way[0].surface == CANVAS) {
            painter.act(sequencer, &act);
            return;
        }
    }
}

#[test]
fn a_live_brush_paints_in_a_document_of_a_take() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let settings = DocumentSettings::new(&path, Access::Paint);
    let (document, _) = Document::open(&settings).expect("begun");
    let mut kept = sequencer(Arc::clone(document.pager()));
    equip(&mut kept);
    let mut painter = Painter::new(3);
    painter.command(&mut kept, take(false, &["Titanium White"]));
    stroke(&mut painter, &mut kept);
    assert_eq!(kept.ignored(), 1, "the take has the brush");
    document.write_checkpoint(Checkpoint::of(&mut kept, 0));
    document.close().expect("closed");

    let (_document, opened) = Document::open(&settings).expect("opened");
    let mut again = opened.expect("a painting").sequencer().expect("whole");
    let load = Load {
        mixture: mixture("Ultramarine Blue"),
        beside: None,
        brush: BrushName::new(BRUSHES[0]).expect("valid"),
    };
    painter.command(&mut again, load);
    for _ in 0..6 {
        stroke(&mut painter, &mut again);
    }
    assert_eq!(again.ignored(), 0);
    let tubes = again.painting_mut().report().paints_m3;
    assert!(
        tubes
            .get("Titanium White")
            .is_none_or(|white| white["brush"] == 0.0),
        "no live stroke takes up the load of the take: {tubes:?}"
    );
}

#[test]
fn a_take_that_begins_again_takes_back_its_own_strokes_alone() {
    let mut sequencer = sequencer(Arc::default());
    equip(&mut sequencer);
    // Merged as far as may be.
    sequencer.painting_mut().set_quota(1);
    let mut painter = Painter::new(4);
    for _ in 0..24 {
        stroke(&mut painter, &mut sequencer);
    }
    let load = Load {
        mixture: mixture("Ultramarine Blue"),
        beside: None,
        brush: BrushName::new(BRUSHES[0]).expect("valid"),
    };
    painter.command(&mut sequencer, load);
    painter.command(&mut sequencer, take(false, &[]));
    let before = studio::tiles(&mut sequencer);
    sequencer.player_gone(9);
    for _ in 0..24 {
        stroke(&mut painter, &mut sequencer);
    }
    assert!(studio::tiles(&mut sequencer) != before);
    let steps = sequencer.painting().history().steps().count();
    assert!(steps < 48, "{steps}: none was merged");
    painter.command(&mut sequencer, take(true, &[]));
    assert!(studio::tiles(&mut sequencer) == before);
}
