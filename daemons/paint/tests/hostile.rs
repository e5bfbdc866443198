//! What a client or a device sends by mistake or on purpose ends no node.

mod support;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Faults, MemoryNet, Qos, Queue, Wake};
use maulstick_types::command::{Command, Outcome};
use maulstick_types::paint::JournalEntry;
use maulstick_types::{Message as _, Mixture};
use support::{Live, START_NS};

fn live() -> Live {
    Live::new(MemoryNet::new(1, START_NS, Faults::default()))
}

#[test]
fn a_text_too_long_to_be_answered_is_refused_in_short() {
    let mut live = live();
    let long = "x".repeat(70_000);
    let (path, brush) = (long.clone(), long.clone());
    let hostile = [
        Command::Clean { brush },
        Command::Snapshot { path, ledger: None },
        Command::Load {
            brush: "main".into(),
            mixture: Mixture::pure(&long),
        },
    ];
    for (number, command) in hostile.into_iter().enumerate() {
        let outcome = live.ask("paint", number as u64 + 1, command);
        assert!(
            matches!(&outcome, Outcome::Refused { what, .. } if what.contains("70000 bytes")),
            "{outcome:?}"
        );
    }
    live.command(9, Command::Mark);
}

#[test]
fn the_largest_command_fits_into_the_journal() {
    let mut live = live();
    let (topic, wake) = (live.topics.journal(), Wake::new());
    let bus = live.net.bus();
    let mut journal =
        Receiver::<JournalEntry>::new(&bus, &topic, Qos::Data, Queue::Ring(64), &wake)
            .expect("subscribed");
    // A load is 34 bytes and the length of its name; the rest of the command is 49.
    let load = Mixture::pure("Bone Black");
    let limit = maulstick_types::command::CommandRequest::MAX_BYTES;
    let loads = vec![load; (limit - 49) / 34];
    let command = Command::Take {
        brush: "main".into(),
        device: 1,
        device_epoch: 1,
        loads,
        again: false,
    };
    live.command(1, command);
    live.net.advance(1_000_000);
    let entries: Vec<JournalEntry> =
        std::iter::from_fn(|| journal.try_recv().map(|entry| entry.message)).collect();
    assert!(!entries.is_empty() && journal.refused() == 0);
}
