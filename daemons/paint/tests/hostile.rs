//! Hostile and mistaken messages of clients and devices, which end no node.

mod support;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Faults, MemoryNet, Qos, Queue, Wake};
use maulstick_painting::edits::{Dry, Load, Place};
use maulstick_types::command::{Command, Outcome, RigCommand, TakeCommand};
use maulstick_types::paint::JournalEntry;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{BrushName, WholePath};
use maulstick_types::{Message as _, Mixture, Pose, Region};
use support::{Live, START_NS};

fn live() -> Live {
    Live::new(MemoryNet::new(1, START_NS, Faults::default()))
}

#[test]
fn what_is_out_of_range_is_answered_in_short_with_the_reason() {
    let mut live = live();
    let pose = Pose {
        position_m: [1e30, 0.0, 0.0],
        ..Pose::IDENTITY
    };
    let place = Place::new(CANVAS, Pose::IDENTITY, 1.0).expect("in reach");
    let empty = Region {
        corner_m: [0.0; 2],
        size_m: [0.0, 1.0],
    };
    let hostile = [
        (
            Command::from(Load {
                mixture: Mixture::pure(&"x".repeat(70_000)),
                beside: None,
                brush: BrushName::main(),
            }),
            "70000",
        ),
        (Place { pose, ..place }.into(), "desk's origin"),
        (
            Dry {
                region: Some(empty),
                ..Dry::whole(CANVAS)
            }
            .into(),
            "X,Y,WxH",
        ),
    ];
    for (number, (command, word)) in hostile.into_iter().enumerate() {
        let outcome = live.ask("paint", number as u64 + 1, command);
        assert!(
            matches!(&outcome, Outcome::Refused { what, .. } if what.contains(word) && what.len() < 300),
            "{outcome:?}"
        );
    }
    live.command(9, Command::from(TakeCommand::Mark));
}

#[test]
fn a_command_for_another_node_is_refused_by_name() {
    let mut live = live();
    for node in ["paint", "main"] {
        let open = RigCommand::Open {
            path: WholePath::new("/a.maul").expect("whole"),
            forget: false,
        };
        let outcome = live.ask(node, 1, open.into());
        let Outcome::Refused { advice, .. } = outcome else {
            panic!("{outcome:?}");
        };
        assert!(advice.to_string().contains("'rig'"), "{advice}");
    }
    let outcome = live.ask("main", 2, Dry::whole(CANVAS).into());
    assert!(matches!(outcome, Outcome::Refused { .. }), "{outcome:?}");
}

#[test]
fn the_largest_command_fits_into_the_journal() {
    let mut live = live();
    let (topic, wake) = (live.topics.journal(), Wake::new());
    let bus = live.net.bus();
    let mut journal =
        Receiver::<JournalEntry>::new(&bus, &topic, Qos::Data, Queue::Ring(64), &wake)
            .expect("subscribed");
    // A load is 34 bytes and the length of its name; the rest of the command is 53.
    let load = Mixture::pure("Bone Black");
    let limit = maulstick_types::command::CommandRequest::MAX_BYTES;
    let loads = vec![load; (limit - 53) / 34];
    let command = Command::from(TakeCommand::Begin {
        brush: BrushName::main(),
        device: 1,
        device_epoch: 1,
        loads,
        again: false,
    });
    live.command(1, command);
    live.net.advance(1_000_000);
    let entries: Vec<JournalEntry> =
        std::iter::from_fn(|| journal.try_recv().map(|entry| entry.message)).collect();
    assert!(!entries.is_empty() && journal.refused() == 0);
}
