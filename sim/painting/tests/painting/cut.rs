//! An undo ahead of the paint: the waiting part of the stroke is dropped, and the painting is as if it had never been.

use maulstick_brush::BrushFile;
use maulstick_painting::edits::{Clean, Redo, Undo};
use maulstick_painting::{PaintingSetup, Sequencer};
use maulstick_types::brush::BrushState;
use maulstick_types::command::{After, CommandRequest, Outcome};
use maulstick_types::paint::{Entry, JournalEntry};
use maulstick_types::values::BrushName;
use maulstick_types::{Header, name_hash};

use crate::studio::{BRUSH, WetPlane, header, load, painting, round, solve, state, wet_paint};

/// States of a stroke, with one in the air at its end.
const STATES: u64 = 20;

type Queue = Vec<(Header, BrushState)>;

fn studio(file: &BrushFile) -> Sequencer {
    let mut sequencer = Sequencer::new(painting(&PaintingSetup {
        cells: [128; 2],
        ..PaintingSetup::default()
    }));
    sequencer.record();
    sequencer
        .define_brush(BRUSH, file.clone())
        .expect("a brush");
    sequencer.edit(load("Bone Black")).expect("loaded");
    sequencer
}

/// Strokes, one above the other, with `ms` from state to state.
fn strokes(file: &BrushFile, count: u64, ms: u64) -> Queue {
    let at = |seq: u64| {
        let (stroke, at) = (seq / STATES, seq % STATES);
        let in_air = at + 1 == STATES;
        let place = [6.0 + at as f64, 6.0 + 8.0 * stroke as f64];
        let height = if in_air { 2.5 } else { 0.45 };
        let number = if in_air { 0 } else { stroke + 1 };
        let solve = solve(file, number, place, height, [0.3, 0.2]);
        (header(seq, 1_000_000 * ms * (seq + 1)), state([solve]))
    };
    (0..count * STATES).map(at).collect()
}

fn paint(sequencer: &mut Sequencer, states: &[(Header, BrushState)]) -> Vec<Outcome> {
    let mut outcomes = Vec::new();
    for (header, state) in states {
        let (replies, painted) = sequencer.state(BRUSH, header, state);
        painted.expect("painted");
        outcomes.extend(replies.into_iter().map(|replied| replied.outcome));
    }
    outcomes
}

/// The place behind all of a queue.
fn behind(queue: &[(Header, BrushState)]) -> After {
    let (header, _) = queue.last().expect("a queue");
    After {
        brush: name_hash(BRUSH),
        epoch: header.epoch,
        sequence: header.seq,
    }
}

/// An undo behind all of a queue, of which these states wait.
fn undo(sequencer: &mut Sequencer, number: u64, waiting: &[(Header, BrushState)]) -> Outcome {
    let request = CommandRequest {
        client: 7,
        number,
        after: Some(behind(waiting)),
        command: Undo { brush: None }.into(),
    };
    let queued = waiting.iter().map(|(header, state)| (header, state));
    sequencer.command_behind(request, queued).outcome
}

fn is_done(outcome: &Outcome) -> bool {
    matches!(outcome, Outcome::Done { .. })
}

fn result(sequencer: &mut Sequencer) -> Vec<WetPlane> {
    let painting = sequencer.painting_mut();
    painting.commit();
    assert_eq!(painting.report().quanta_missing, 0);
    wet_paint(painting)
}

#[test]
fn undos_take_back_strokes_that_wait_and_the_one_that_is_being_painted() {
    let file = round(5.0, 48);
    let queue = strokes(&file, 3, 50);
    let mut one = studio(&file);
    paint(&mut one, &queue[..STATES as usize]);
    let expected = result(&mut one);
    assert!(!expected.is_empty());

    let mut sequencer = studio(&file);
    let begun = STATES as usize + 8;
    paint(&mut sequencer, &queue[..begun]);
    let waiting = &queue[begun..];
    let third = undo(&mut sequencer, 1, waiting);
    assert!(is_done(&third), "nothing of it was painted: {third:?}");
    assert_eq!(undo(&mut sequencer, 1, waiting), third, "asked again");
    assert_eq!(undo(&mut sequencer, 2, waiting), Outcome::Waiting);
    let before = sequencer.painting().work();
    let outcomes = paint(&mut sequencer, waiting);
    assert!(outcomes.iter().all(is_done), "{outcomes:?}");
    assert_eq!(outcomes.len(), 1);
    let steps = sequencer.painting().work().0 - before.0;
    assert!(steps <= 1, "{steps} steps of what was dropped were painted");
    assert!(result(&mut sequencer) == expected);

    let cuts: Vec<[u64; 2]> = sequencer
        .drain_journal()
        .into_iter()
        .filter_map(|entry| match entry.entry {
            Entry::Cut { from, to, .. } => Some([from, to]),
            _ => None,
        })
        .collect();
    let last = STATES - 2;
    assert_eq!(
        cuts,
        [[2 * STATES, 2 * STATES + last], [STATES + 8, STATES + last]]
    );
}

#[test]
fn the_next_stroke_is_painted_after_a_cut() {
    let file = round(5.0, 48);
    let queue = strokes(&file, 2, 50);
    let mut sequencer = studio(&file);
    let (first, second) = queue.split_at(STATES as usize);
    assert!(is_done(&undo(&mut sequencer, 1, first)));
    paint(&mut sequencer, first);
    assert!(result(&mut sequencer).is_empty());
    paint(&mut sequencer, second);
    assert!(!result(&mut sequencer).is_empty());
}

#[test]
fn an_undo_a_little_ahead_waits_and_can_be_redone() {
    let file = round(5.0, 48);
    let queue = strokes(&file, 1, 20);
    let mut sequencer = studio(&file);
    assert_eq!(undo(&mut sequencer, 1, &queue), Outcome::Waiting);
    paint(&mut sequencer, &queue);
    assert!(result(&mut sequencer).is_empty(), "undone");
    sequencer.edit(Redo { brush: None }).expect("a step");
    assert!(!result(&mut sequencer).is_empty(), "and redone whole");
}

/// The rest of the stroke would be painted after all.
#[test]
fn a_stroke_whose_end_is_still_on_its_way_is_not_cut() {
    let file = round(5.0, 48);
    let queue = strokes(&file, 1, 50);
    let mut sequencer = studio(&file);
    let (arrived, late) = queue.split_at(15);
    let request = CommandRequest {
        client: 7,
        number: 1,
        after: Some(behind(&queue)),
        command: Undo { brush: None }.into(),
    };
    let queued = arrived.iter().map(|(header, state)| (header, state));
    let outcome = sequencer.command_behind(request, queued).outcome;
    assert_eq!(outcome, Outcome::Waiting);
    paint(&mut sequencer, arrived);
    paint(&mut sequencer, late);
    assert!(result(&mut sequencer).is_empty());
}

/// An undo reverts the last action, so a stroke in progress must not lose its end.
#[test]
fn a_begun_stroke_that_something_was_done_after_stays_whole() {
    let file = round(5.0, 48);
    let queue = strokes(&file, 1, 50);
    let mut sequencer = studio(&file);
    paint(&mut sequencer, &queue[..8]);
    sequencer.edit(load("Bone Black")).expect("loaded");
    assert_eq!(undo(&mut sequencer, 1, &queue[8..]), Outcome::Waiting);
    paint(&mut sequencer, &queue[8..]);
    let journal = sequencer.drain_journal();
    let is_cut = |entry: &JournalEntry| matches!(entry.entry, Entry::Cut { .. });
    assert!(!journal.iter().any(is_cut), "{journal:?}");
    assert!(!result(&mut sequencer).is_empty());
}

#[test]
fn what_waits_behind_the_stroke_is_undone_before_it() {
    let file = round(5.0, 48);
    let queue = strokes(&file, 1, 50);
    let mut sequencer = studio(&file);
    let clean = CommandRequest {
        client: 7,
        number: 1,
        after: Some(behind(&queue)),
        command: Clean {
            brush: BrushName::main(),
        }
        .into(),
    };
    assert_eq!(sequencer.command(clean).outcome, Outcome::Waiting);
    assert_eq!(undo(&mut sequencer, 2, &queue), Outcome::Waiting);
    paint(&mut sequencer, &queue);
    assert!(!result(&mut sequencer).is_empty(), "the stroke stays");
}

#[test]
fn saved_records_and_snapshots_know_what_was_dropped() {
    let file = round(5.0, 48);
    let queue = strokes(&file, 2, 50);
    let mut sequencer = studio(&file);
    let done = undo(&mut sequencer, 1, &queue);
    assert!(is_done(&done));
    let kept = sequencer.kept();
    let records = sequencer.take_records();
    paint(&mut sequencer, &queue);
    let expected = result(&mut sequencer);
    assert!(!expected.is_empty());

    let mut replayed = Sequencer::new(painting(&PaintingSetup {
        cells: [128; 2],
        ..PaintingSetup::default()
    }));
    records
        .into_iter()
        .for_each(|record| replayed.replay(record));
    assert_eq!(replayed.kept().cut, kept.cut);
    let again = undo(&mut replayed, 1, &queue);
    assert!(is_done(&again), "asked again it undoes no other: {again:?}");
    paint(&mut replayed, &queue);
    assert!(result(&mut replayed) == expected);

    let mut restored = Sequencer::restored(studio(&file).into_painting(), kept);
    paint(&mut restored, &queue);
    assert!(result(&mut restored) == expected);
}
