//! A canvas larger than memory beside a small one: the same strokes, taken in turns.

use maulstick_rig::UserError;

use super::fault;
use super::hand::{Easel, Took, resident};
use crate::report::{Report, quantile, sorted};

/// Cells either way.
const VAST: u32 = 16_384;
const SMALL: u32 = 1024;
/// Memory of the vast canvas, bytes.
const MEMORY: usize = 512 << 20;
/// Strokes on each; together they touch about a fiftieth of the vast canvas's tiles.
const STROKES: usize = 420;
/// Strokes between two turns.
const TURN: usize = 10;
const STROKE_M: f64 = 0.04;
const QUOTA: u64 = 2 << 30;

/// Strokes on two canvases in turns.
struct Turns {
    /// Work on the second canvas.
    took: Took,
    /// Steps a second of the second and the first one, by turn.
    pairs: Vec<(f64, f64)>,
    /// Greatest memory after a turn, bytes.
    most: u64,
}

fn in_turns(easels: &mut [Easel; 2]) -> Result<Turns, UserError> {
    let mut took = Took::default();
    let (mut pairs, mut most) = (Vec::new(), 0);
    for _ in 0..STROKES / TURN {
        let mut rates = [0.0; 2];
        for (place, easel) in easels.iter_mut().enumerate() {
            let mut turn = Took::default();
            easel.load()?;
            for _ in 0..TURN {
                easel.stroke(STROKE_M, &mut turn)?;
            }
            rates[place] = turn.steps as f64 / turn.busy.as_secs_f64();
            if place == 1 {
                took.steps += turn.steps;
                took.busy += turn.busy;
                took.paging_ms.extend(turn.paging_ms);
            }
        }
        pairs.push((rates[1], rates[0]));
        most = most.max(resident());
    }
    Ok(Turns { took, pairs, most })
}

pub(super) fn run(report: &mut Report) -> Result<(), UserError> {
    let folder = tempfile::tempdir().map_err(fault)?;
    let small = Easel::new(&folder.path().join("small.maul"), SMALL, MEMORY, QUOTA)?;
    let before = resident();
    let vast = Easel::new(&folder.path().join("vast.maul"), VAST, MEMORY, QUOTA)?;
    let mut easels = [small, vast];
    let turns = in_turns(&mut easels)?;
    let [small, vast] = easels;
    let store = vast
        .sequencer
        .painting()
        .store(maulstick_types::scene::CANVAS);
    let painted = store.map_or(0, |store| {
        store
            .iter()
            .filter(|(_, version)| version.tile.is_some())
            .count()
    });
    report.row("document: tiles painted of 65536", painted as f64, "tiles");
    let name = "document: 16384² canvas, 512M";
    report.paired(name, "steps/s", "1024² canvas", &turns.pairs);
    let paging = sorted(turns.took.paging_ms);
    report.row(
        "document: page-in of a state, p99.9",
        quantile(&paging, 0.999),
        "ms",
    );
    report.row(
        "document: page-ins",
        vast.sequencer.painting().pager().counts().fetched as f64,
        "",
    );
    report.row(
        "document: memory of both canvases",
        turns.most as f64 / f64::from(1 << 20),
        "MiB",
    );
    report.row(
        "document: memory before the vast one",
        before as f64 / f64::from(1 << 20),
        "MiB",
    );
    for mut easel in [small, vast] {
        easel.keep();
        easel.autosave.close(&mut easel.sequencer).map_err(fault)?;
    }
    again(report, &folder.path().join("vast.maul"))
}

/// The vast canvas opened again, with little memory: the tiles painted on come from the file.
fn again(report: &mut Report, path: &std::path::Path) -> Result<(), UserError> {
    let mut easel = Easel::again(path, 64 << 20)?;
    let mut took = Took::default();
    for _ in 0..60 {
        easel.stroke(STROKE_M, &mut took)?;
    }
    let counts = easel.sequencer.painting().pager().counts();
    report.row(
        "document: opened again with 64M",
        took.steps as f64 / took.busy.as_secs_f64(),
        "steps/s",
    );
    report.row(
        "document: opened again with 64M, page-ins",
        counts.fetched as f64,
        "",
    );
    report.row(
        "document: opened again with 64M, page-in of a state, p99.9",
        quantile(&sorted(took.paging_ms), 0.999),
        "ms",
    );
    easel.autosave.close(&mut easel.sequencer).map_err(fault)
}
