//! Files that a client may have written beside an open painting.

#![allow(clippy::panic, reason = "a test fails by it")]

use std::os::unix::fs::MetadataExt as _;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Qos, Queue};
use maulstick_types::command::{Command, CommandReply, CommandRequest, ExportOrder, Outcome};
use maulstick_types::command::{FileCommand, TakeCommand};
use maulstick_types::paint::PaintStatus;
use maulstick_types::values::WholePath;

use super::beside_tests::{Rig, kept, save_as};
use super::*;

fn snapshot(path: &Path, ledger: Option<&Path>) -> Command {
    Command::from(TakeCommand::Snapshot {
        path: WholePath::new(path.display().to_string()).expect("valid"),
        ledger: ledger
            .map(|path| path.display().to_string())
            .map(|it| WholePath::new(it).expect("valid")),
    })
}

fn export(path: &Path) -> Command {
    let mut order = ExportOrder::to(path.display().to_string().parse().expect("whole"));
    order.format = "png".to_owned();
    Command::from(FileCommand::Export(order))
}

/// True if this process holds locks of a file, as the kernel lists them.
fn is_locked(path: &Path) -> bool {
    let inode = format!(":{}", std::fs::metadata(path).expect("there").ino());
    let locks = std::fs::read_to_string("/proc/locks").expect("Linux");
    let me = std::process::id().to_string();
    locks.lines().any(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        words.contains(&"POSIX")
            && words.contains(&&*me)
            && words.iter().any(|word| word.ends_with(&inode))
    })
}

#[test]
fn a_refused_output_leaves_the_painting_its_locks() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut rig = Rig::new();
    rig.fill("Yellow Ochre");
    rig.done(save_as(&at("a.maul"), false));
    std::fs::hard_link(at("a.maul"), at("b.maul")).expect("a second name");
    std::os::unix::fs::symlink(at("a.maul"), at("c.maul")).expect("a link");
    assert!(is_locked(&at("a.maul")));
    for name in ["a.maul", "b.maul", "c.maul"] {
        let path = at(name);
        for command in [
            snapshot(&path, None),
            snapshot(&at("picture.png"), Some(&path)),
            export(&path),
        ] {
            rig.refused(command, &[name, "painting"]);
            assert!(is_locked(&at("a.maul")), "{name}");
        }
    }
    rig.refused(save_as(&at("b.maul"), true), &["b.maul", "open here"]);
    assert!(is_locked(&at("a.maul")));
    std::fs::remove_file(at("b.maul")).expect("removed");
    rig.node.close().expect("closed");
    assert_eq!(kept(&at("a.maul")).1, 1);
}

#[test]
fn nothing_is_written_where_the_journal_of_a_painting_is_nor_into_what_is_no_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut rig = Rig::new();
    rig.fill("Yellow Ochre");
    rig.done(save_as(&at("a.maul"), false));
    std::fs::create_dir(at("folder")).expect("made");
    let made = std::process::Command::new("mkfifo")
        .arg(at("pipe"))
        .status();
    assert!(made.expect("run").success());
    let _socket = std::os::unix::net::UnixListener::bind(at("socket")).expect("a socket");
    std::fs::write(at("list.txt"), "a shopping list").expect("written");
    for name in [
        "a.maul-wal",
        "a.maul-shm",
        "a.maul-journal",
        "pipe",
        "socket",
        "folder",
        "list.txt",
    ] {
        rig.refused(snapshot(&at(name), None), &[name]);
        rig.refused(snapshot(&at("picture.png"), Some(&at(name))), &[name]);
        rig.refused(export(&at(name)), &[name]);
    }
    assert!(!at("picture.png").exists(), "the ledger comes first");
    let list = std::fs::read(at("list.txt")).expect("there");
    assert_eq!(list, b"a shopping list");
    rig.done(snapshot(&at("picture.png"), Some(&at("ledger.json"))));
    rig.done(snapshot(&at("picture.png"), Some(&at("ledger.json"))));
}

#[test]
fn a_snapshot_is_of_the_moment_it_was_asked_for_and_answered_when_it_is_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut rig = Rig::new();
    rig.fill("Yellow Ochre");
    rig.done(snapshot(&at("before.png"), None));
    let request = CommandRequest {
        client: 5,
        number: 1,
        after: None,
        command: snapshot(&at("a.png"), None),
    };
    let topic = rig.topics.command("paint");
    let reply: CommandReply = rig.ask(&topic, &request);
    assert_eq!(reply.outcome, Outcome::Waiting);
    rig.fill("Bone Black");
    loop {
        let reply: CommandReply = rig.ask(&topic, &request);
        match reply.outcome {
            Outcome::Waiting => {}
            Outcome::Done { .. } => break,
            other => panic!("{other:?}"),
        }
    }
    let bytes = |name: &str| std::fs::read(at(name)).expect("written");
    assert_eq!(bytes("a.png"), bytes("before.png"));
    rig.done(snapshot(&at("after.png"), None));
    assert_ne!(bytes("a.png"), bytes("after.png"), "a fault would pass");
}

#[test]
fn a_painting_whose_file_is_removed_says_where_it_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut rig = Rig::new();
    let topic = rig.topics.paint_status();
    let queue = Queue::Ring(64);
    let mut statuses: Receiver<PaintStatus> =
        Receiver::new(&rig.client, &topic, Qos::Background, queue, &Wake::new()).expect("one");
    rig.fill("Yellow Ochre");
    rig.done(save_as(&at("a.maul"), false));
    std::fs::remove_file(at("a.maul")).expect("removed");
    let said = loop {
        rig.turn();
        let told = std::iter::from_fn(|| statuses.try_recv()).last();
        if let Some(told) = told.filter(|told| told.message.path.ends_with("/a-kept.maul")) {
            break told.message.fault;
        }
    };
    assert!(
        said.contains("/a.maul") && said.contains("a-kept.maul"),
        "{said}"
    );
    rig.fill("Bone Black");
    rig.node.close().expect("closed");
    assert_eq!(kept(&at("a-kept.maul")).1, 2);
}
