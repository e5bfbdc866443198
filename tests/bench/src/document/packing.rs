//! A packed painting beside an OpenEXR file of the same paint: float32, ZIP.

use maulstick_document::pack::{Forget, pack};
use maulstick_exchange::write_open_exr;
use maulstick_painting::Painting;
use maulstick_painting::edits::Dry;
use maulstick_rig::UserError;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{LayerName, Share};

use super::fault;
use super::hand::{Easel, Took};
use crate::report::Report;

const CELLS: u32 = 2048;
const STROKES: usize = 400;
const STROKE_M: f64 = 0.06;

pub(super) fn run(report: &mut Report) -> Result<(), UserError> {
    let folder = tempfile::tempdir().map_err(fault)?;
    let path = folder.path().join("pack.maul");
    let mut easel = Easel::new(&path, CELLS, 512 << 20, 2 << 30)?;
    let mut took = Took::default();
    for stroke in 0..STROKES {
        if stroke % 10 == 0 {
            easel.load()?;
        }
        if stroke == STROKES / 2 {
            dry(easel.sequencer.painting_mut())?;
        }
        easel.stroke(STROKE_M, &mut took)?;
    }
    let exr = folder.path().join("pack.exr");
    let file = std::fs::File::create(&exr).map_err(fault)?;
    let painting = easel.sequencer.painting_mut();
    write_open_exr(painting, CANVAS, file, &mut |_, _| {}).map_err(fault)?;
    easel.autosave.close(&mut easel.sequencer).map_err(fault)?;
    let [before, after] = pack(&path, Forget::History, &mut |_, _| {}).map_err(fault)?;
    let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    let exr = mib(std::fs::metadata(&exr).map_err(fault)?.len());
    report.row("document: 2048² with its history", mib(before), "MiB");
    let peer = ("OpenEXR float32 ZIP", exr);
    report.beside("document: packed, without history", mib(after), "MiB", peer);
    Ok(())
}

fn dry(painting: &mut Painting) -> Result<(), UserError> {
    painting
        .apply(Dry {
            share: Share::new(1.0).expect("in range"),
            layer: LayerName::new("first").ok(),
            ..Dry::whole(CANVAS)
        })
        .map_err(fault)?;
    Ok(())
}
