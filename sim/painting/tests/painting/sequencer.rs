//! Duties of the sequencer toward clients and brushes.

use maulstick_brush::BrushFile;
use maulstick_painting::edits::Clean;
use maulstick_painting::{Effect, PaintingSetup, Sequencer};
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::command::TakeCommand;
use maulstick_types::command::{After, Command, CommandRequest, Outcome};
use maulstick_types::values::{BrushName, WholePath};
use maulstick_types::{Flags, Header, Pose};

use crate::studio;

const BRUSH: u32 = 3;

fn sequencer() -> Sequencer {
    let mut sequencer = Sequencer::new(studio::painting(&PaintingSetup {
        cells: [256, 192],
        ..PaintingSetup::default()
    }));
    let file = BrushFile::library("round").expect("round");
    sequencer.painting_mut().define_brush("main", file);
    sequencer
}

fn header(epoch: u32, seq: u64) -> Header {
    Header {
        version: 1,
        schema: 0,
        source: BRUSH,
        epoch,
        flags: Flags::NONE,
        length: 0,
        seq,
        event_ns: seq,
        sent_ns: seq,
    }
}

/// A state without joints, which fits no brush file.
fn misfit() -> BrushState {
    let solve = Solve {
        event_ns: 1,
        stroke: 1,
        surface: 0,
        flags: 0,
        pose: Pose::IDENTITY,
        zoom: 1.0,
        angles_rad: Vec::new(),
        contacts: Vec::new(),
    };
    BrushState {
        device: 1,
        device_epoch: 1,
        device_seq: 0,
        solves: vec![solve],
    }
}

fn request(client: u64, number: u64, command: Command) -> CommandRequest {
    CommandRequest {
        client,
        number,
        after: None,
        command,
    }
}

#[test]
fn a_command_that_waits_for_a_refused_state_is_done_with_its_effect() {
    let mut sequencer = sequencer();
    let command = Command::from(TakeCommand::Snapshot {
        path: WholePath::new("/p.png").expect("valid"),
        ledger: None,
    });
    let snapshot = CommandRequest {
        after: Some(After {
            brush: BRUSH,
            epoch: 1,
            sequence: 0,
        }),
        ..request(1, 1, command)
    };
    assert_eq!(sequencer.command(snapshot).outcome, Outcome::Waiting);
    let (replies, painted) = sequencer.state("main", &header(1, 0), &misfit());
    assert!(painted.is_err(), "the state fits no brush file");
    assert!(
        matches!(&replies[..], [one] if matches!(one.effect, Some(Effect::Snapshot { .. }))),
        "{replies:?}"
    );
}

#[test]
fn a_state_beyond_every_surface_is_refused_before_it_is_followed() {
    let mut sequencer = sequencer();
    let file = BrushFile::library("round").expect("round");
    let at = |x: f64| {
        let mut state = misfit();
        state.solves[0].angles_rad = vec![[0.0; 2]; file.spines.all_joints()];
        state.solves[0].pose.position_m = [x, 0.0, 0.0];
        state
    };
    let (_, here) = sequencer.state("main", &header(1, 0), &at(0.01));
    assert_eq!(here, Ok(()));
    let (_, beyond) = sequencer.state("main", &header(1, 1), &at(1e30));
    assert!(beyond.is_err());
}

#[test]
fn a_brush_file_that_comes_again_breaks_no_stroke() {
    let mut sequencer = sequencer();
    let file = BrushFile::library("round").expect("round");
    let mut state = misfit();
    state.solves[0].angles_rad = vec![[0.0; 2]; file.spines.all_joints()];
    for seq in 0..2 {
        state.solves[0].pose.position_m = [0.02 + 0.005 * seq as f64, 0.02, 0.01];
        let (_, painted) = sequencer.state("main", &header(1, seq), &state);
        assert_eq!(painted, Ok(()));
        sequencer.painting_mut().define_brush("main", file.clone());
    }
    assert!(
        sequencer.painting().work().0 > 10,
        "the stroke was broken off"
    );
}

#[test]
fn a_repeated_command_is_done_once_among_many_clients() {
    let mut sequencer = sequencer();
    let mark = |client: u64| request(client, 1, Command::from(TakeCommand::Mark));
    for other in 1000..2000 {
        sequencer.command(mark(other));
    }
    // It has the least number of all clients, which is independent of its age.
    let clean = request(
        1,
        1,
        Clean {
            brush: BrushName::main(),
        }
        .into(),
    );
    let done = sequencer.command(clean.clone()).outcome;
    assert!(matches!(done, Outcome::Done { .. }), "{done:?}");
    for other in 2000..2200 {
        sequencer.command(mark(other));
    }
    assert_eq!(sequencer.command(clean).outcome, done);
    assert_eq!(sequencer.painting().history_depth().0, 1);
}

#[test]
fn a_restarted_brush_paints_strokes_of_its_own() {
    let mut sequencer = sequencer();
    let file = BrushFile::library("round").expect("round");
    let mut state = misfit();
    state.solves[0].angles_rad = vec![[0.0; 2]; file.spines.all_joints()];
    // Both epochs number their first stroke 1.
    for (epoch, strokes) in [(1, 1), (1, 1), (2, 2)] {
        let (_, painted) = sequencer.state("main", &header(epoch, 0), &state);
        assert_eq!(painted, Ok(()));
        assert_eq!(sequencer.painting().history_depth().0, strokes);
    }
}
